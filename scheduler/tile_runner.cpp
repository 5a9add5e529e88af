#include <tile_runner.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <exact_contact.hpp>
#include <fastccd/isa.hpp>
#include <index_check.hpp>
#include <load_pair.hpp>
#include <separation_search.hpp>
#include <touching_blocks.hpp>

namespace fastccd {

namespace {

/// Both times are lower bounds of the first contact.
void settle(const Job& job, const double* coordinates, scalar::SearchResult& found)
{
    const scalar::ExactContact exact = scalar::exact_contact(job.kind, coordinates, job.parameters);
    if (exact.contact) {
        found.toi = std::max(found.toi, job.parameters.time(exact.lower_bound));
        found.proof = scalar::Proof::leaf;
    } else {
        found = {.toi = std::numeric_limits<double>::infinity(), .intervals = found.intervals};
    }
}

/// Returns the time.
double search_pair(const Job& job, std::size_t first, std::size_t i, double cutoff, TileScratch& scratch)
{
    double coordinates[pair_coordinates];
    load_pair(job.kind, job.source, first + i, coordinates);
    const scalar::SearchResult found = answer_pair(job, coordinates, cutoff);
    scratch.time[i] = found.toi;
    scratch.roots[i] = found.roots;
    if (found.toi == std::numeric_limits<double>::infinity())
        clear_bit(scratch.reported, i);
    else
        set_bit(scratch.reported, i);
    if (std::isfinite(found.toi) && found.proof == scalar::Proof::none) set_bit(scratch.is_unproven, i);
    return found.toi;
}

/// Ties go to the smaller index: a worker may see tiles in any order.
void keep_earlier(Contact& best, const Contact& other)
{
    if (other.toi < best.toi || (other.toi == best.toi && other.pair < best.pair)) best = other;
}

bool has_data(const PairView& pairs)
{
    const bool strided = pairs.layout() == PairView::Layout::strided;
    const std::size_t number = pairs.scalar() == PairView::Scalar::float64 ? sizeof(double) : sizeof(float);
    if (strided ? exceeds_memory(pairs.size(), pairs.stride(), number) : exceeds_memory(pairs.size(), pair_coordinates * number)) return false;
    const std::size_t arrays = strided ? pair_coordinates : 1;
    for (std::size_t c = 0; c < arrays; ++c)
        if (pairs.data(c) == nullptr) return false;
    return true;
}

/// Isa::automatic honours FASTCCD_ISA; then the choice must be available.
Status choose_kernels(Isa wanted, const KernelTable*& kernels)
{
    Error refusal = Error::isa_unavailable;
    if (wanted == Isa::automatic) {
        if (const char* forced = std::getenv("FASTCCD_ISA"); forced != nullptr && *forced != '\0') {
            refusal = Error::bad_isa_environment;
            const auto named = isa_from_name(forced);
            if (!named) return {refusal};
            wanted = *named;
        }
    }
    if (wanted == Isa::automatic) wanted = best_isa();
    if (!isa_available(wanted)) return {refusal};
    kernels = kernel_table(wanted);
    return {};
}

}  // namespace

Status prepare(PairKind kind, const PairSource& source, const Options& options, bool count_roots, Job& job)
{
    if (kind != PairKind::vertex_face && kind != PairKind::edge_edge) return {Error::bad_kind};
    if (!(options.tolerance > 0.0) || std::isinf(options.tolerance)) return {Error::bad_tolerance};
    if (!(options.t_max > 0.0 && options.t_max <= 1.0)) return {Error::bad_t_max};
    if (source.view != nullptr && source.size > 0 && !has_data(*source.view)) return {Error::wrong_size};
    if (!(options.minimum_separation >= 0.0) || std::isinf(options.minimum_separation)) return {Error::bad_minimum_separation};
    if (!(options.distance_tolerance >= 0.0) || std::isinf(options.distance_tolerance)) return {Error::bad_distance_tolerance};
    if (options.exact && options.minimum_separation > 0.0) return {Error::exact_separation};
    if (options.exact && !scalar::exact_contact_available()) return {Error::exact_unavailable};
    const KernelTable* kernels = nullptr;
    if (const Status status = choose_kernels(options.isa, kernels); !status.ok()) return status;
    if (options.reference) kernels = nullptr;
    job = {kind, source, SearchParameters{options.tolerance, options.t_max, count_roots,
                                            SeparationParameters{options.minimum_separation, options.distance_tolerance}},
           kernels, options.exact};
    return {};
}

scalar::SearchResult answer_pair(const Job& job, const double* coordinates, double cutoff)
{
    if (job.parameters.separation.distance > 0.0)
        return scalar::separation_search(job.kind, coordinates, job.parameters, time_limit(cutoff));
    const IntervalKernel* const lanes = job.kernels == nullptr ? nullptr : &job.kernels->intervals;
    scalar::SearchResult found = scalar::certified_search(job.kind, coordinates, job.parameters, lanes);
    // What is proven in a leaf is located within the tolerance already. Its cubic has a certain sign at the leaf's start, so even in
    // the first leaf toi is not 0.
    if (job.exact && std::isfinite(found.toi) && found.proof != scalar::Proof::leaf) settle(job, coordinates, found);
    return found;
}

void run_tile(const Job& job, std::size_t first, std::size_t count, double cutoff, TileScratch& scratch, Summary& totals)
{
    const SearchParameters& parameters = job.parameters;
    for (std::uint64_t& word : scratch.is_unproven) word = 0;
    double earliest = std::numeric_limits<double>::infinity();  // no time of the tile is before this
    std::size_t invalid = 0;
    const auto search = [&](std::size_t i) {
        const double toi = search_pair(job, first, i, cutoff, scratch);
        earliest = std::min(earliest, toi);
        ++(std::isnan(toi) ? invalid : totals.scalar_pairs);
    };
    if (job.kernels != nullptr) {
        job.kernels->run_tile({job.kind, &job.source, first, count, &parameters, cutoff, preferences()}, scratch);
        decide_touching(job, first, count, scratch);
        earliest = parameters.time(scratch.earliest);
        if (parameters.t_max != 1.0)
            for_each_bit(scratch.reported, count, [&](std::size_t i) { scratch.time[i] = parameters.time(scratch.time[i]); });
        for_each_bit(scratch.is_undecided, count, search);
    } else {
        for (std::uint64_t& word : scratch.reported) word = 0;
        for (std::size_t i = 0; i < count; ++i) search(i);
    }

    // Word by word, and contacts one by one only where that is needed: of random edge-edge pairs one in five is one. Of scenes most words report
    // nothing, and hardly any contact is unproven; without an instruction for it, which plain x86-64 lacks, counting bits is a call.
    std::size_t reported = 0, unproven = 0;  // with the invalid ones, which the search alone reports, as proven
    for (std::size_t w = 0; w < (count + 63) / 64; ++w) {
        const std::uint64_t bits = scratch.reported[w];
        if (bits == 0) continue;
        reported += static_cast<std::size_t>(std::popcount(bits));
        if (const std::uint64_t open = bits & scratch.is_unproven[w]; open != 0) unproven += static_cast<std::size_t>(std::popcount(open));
    }
    totals.invalid += invalid;
    totals.contacts += reported - invalid;
    totals.proven += reported - unproven - invalid;
    if (parameters.separation.distance > 0.0)
        for_each_bit(scratch.reported, count, [&](std::size_t i) { totals.at_start += contact_of(job, scratch, first, i).at_start ? 1 : 0; });
    if (parameters.count_roots)
        for_each_bit(scratch.reported, count, [&](std::size_t i) {
            if (scratch.roots[i] != 0) ++(scratch.roots[i] % 2 == 1 ? totals.odd : totals.even);
        });
    if (reported != 0 && earliest <= totals.earliest.toi)
        for_each_bit(scratch.reported, count, [&](std::size_t i) { keep_earlier(totals.earliest, contact_of(job, scratch, first, i)); });
}

}  // namespace fastccd
