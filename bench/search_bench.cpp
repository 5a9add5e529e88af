// The certified search per instruction set, which gives it lanes for intervals: `search/vertex_face/avx2/undecided/cloth-ball`, over
// the pairs that the pipeline leaves to it, `contacts`, over pairs in contact, which it has to follow down to the tolerance,
// `sample`, over pairs from all over the data set, and `resting`, over pairs of bricks that lie on one another, without any gap.
#include "search_bench.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <certified_search.hpp>
#include <fastccd/fastccd.hpp>
#include <fastccd/isa.hpp>
#include <kernel_table.hpp>
#include <touching_blocks.hpp>

#include "bench_main.hpp"
#include "bench_table.hpp"
#include "datasets.hpp"

namespace fastccd::bench {

namespace {

constexpr std::size_t most_searched = 1000;  // of sample and contacts

/// Pairs of one sort, and how long the pipeline took for the whole data set.
struct SearchedPairs {
    std::string name;
    std::vector<double> coordinates;  ///< 24 per pair.
    double pipeline_seconds = 0.0;
};

void append_pair(const PairView& pairs, std::size_t i, std::vector<double>& coordinates)
{
    const double* const block = static_cast<const double*>(pairs.data()) + i / block_pairs * block_coordinates + i % block_pairs;
    for (std::size_t c = 0; c < pair_coordinates; ++c) coordinates.push_back(block[c * block_pairs]);
}

/// Runs the lanes' stages alone, without the searches; visit(i) for each pair that they leave undecided.
template <class Visit>
void run_pipeline(PairKind kind, Isa isa, const PairView& view, const SearchParameters& parameters, TileScratch& scratch, Visit visit)
{
    PairSource source{};
    source.view = &view;
    source.size = view.size();
    const Job job{kind, source, parameters, kernel_table(isa), false};
    for (std::size_t first = 0; first < view.size(); first += tile_pairs) {
        const std::size_t count = std::min(tile_pairs, view.size() - first);
        job.kernels->run_tile({kind, &source, first, count, &parameters, 1.0, preferences()}, scratch);
        decide_touching(job, first, count, scratch);
        for (std::size_t i = 0; i < count; ++i)
            if (is_set(scratch.is_undecided, i)) visit(first + i);
    }
}

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

SearchedPairs undecided_pairs(PairKind kind, Isa isa, const PairView& view, const SearchParameters& parameters)
{
    SearchedPairs found;
    const auto scratch = std::make_unique<TileScratch>();
    std::vector<double> seconds;
    for (int pass = 0; pass < 5; ++pass) {
        found.coordinates.clear();
        const auto start = std::chrono::steady_clock::now();
        run_pipeline(kind, isa, view, parameters, *scratch, [&](std::size_t i) { append_pair(view, i, found.coordinates); });
        seconds.push_back(seconds_since(start));
    }
    std::nth_element(seconds.begin(), seconds.begin() + 2, seconds.end());
    found.pipeline_seconds = seconds[2];
    return found;
}

/// A corner of a brick on a face of another, or their edges across one another: all are carried along, the first one slides as well.
/// Multiples of 2^-10 do not round.
SearchedPairs resting_pairs(PairKind kind)
{
    std::mt19937_64 random{1};
    const auto below = [&](std::uint64_t end) { return static_cast<double>(random() % end) * 0x1p-10; };
    using Points = std::array<std::array<double, 2>, 4>;  // in the plane
    SearchedPairs made;
    for (std::size_t i = 0; i < most_searched; ++i) {
        const double a = below(512), b = below(512), c = below(1024), d = below(1024);
        const Points points = kind == PairKind::vertex_face ? Points{{{a, b}, {0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}}
                                                            : Points{{{0.0, c}, {1.0, d}, {a, 0.0}, {b, 1.0}}};
        const std::size_t first_of_other = kind == PairKind::vertex_face ? 1 : 2;
        const double height = below(1024), along = below(64), slide = below(64);
        for (const double t : {0.0, 1.0})
            for (std::size_t k = 0; k < points.size(); ++k) {
                const double moved = t * (k < first_of_other ? along + slide : along);
                made.coordinates.insert(made.coordinates.end(), {points[k][0] + moved, points[k][1] + moved, height + t * along});
            }
    }
    return made;
}

SearchedPairs pairs_to_search(const std::string& sort, PairKind kind, Isa isa, const PairView& view, const SearchParameters& parameters)
{
    if (sort == "undecided") return undecided_pairs(kind, isa, view, parameters);
    SearchedPairs found;
    std::vector<std::size_t> numbers;
    if (sort == "sample") {
        for (std::size_t i = 0; i < view.size(); ++i) numbers.push_back(i);
    } else {
        std::vector<Contact> contacts;
        if (const Status status = find_contacts(kind, view, {}, contacts); !status.ok()) throw std::runtime_error(message(status.error));
        for (const Contact& contact : contacts) numbers.push_back(contact.pair);
    }
    const std::size_t step = std::max<std::size_t>(numbers.size() / most_searched, 1);
    for (std::size_t i = 0; i < numbers.size(); i += step) append_pair(view, numbers[i], found.coordinates);
    return found;
}

void run_search(benchmark::State& state, const std::string& sort, PairKind kind, Isa isa, const std::string& data)
{
    const SearchParameters parameters{Options{}.tolerance, 1.0, false};
    // Repetitions follow each other and share the pairs.
    static SearchedPairs pairs;
    const std::string wanted = sort + name(kind) + fastccd::name(isa) + data;
    if (pairs.name != wanted) {
        pairs = sort == "resting" ? resting_pairs(kind) : pairs_to_search(sort, kind, isa, dataset(data, kind).packed.view(), parameters);
        pairs.name = wanted;
    }
    const std::size_t count = pairs.coordinates.size() / pair_coordinates;
    if (count == 0 && sort != "undecided") return fail(state, "no pair of the data set is of this sort");

    std::size_t intervals = 0, found = 0, rounds = 0;
    const auto start = std::chrono::steady_clock::now();
    for ([[maybe_unused]] auto _ : state) {
        intervals = found = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const scalar::SearchResult result = scalar::certified_search(kind, &pairs.coordinates[i * pair_coordinates], parameters,
                                                                         &kernel_table(isa)->intervals);
            found += result.toi <= 1.0;
            intervals += result.intervals;
        }
        benchmark::DoNotOptimize(found);
        ++rounds;
    }
    const double seconds = seconds_since(start) / static_cast<double>(rounds);
    const auto per_pair = [&](auto number) { return count == 0 ? 0.0 : static_cast<double>(number) / static_cast<double>(count); };
    state.counters["s/pair"] = per_pair(seconds);
    state.counters["intervals"] = per_pair(intervals);
    state.counters["kept"] = per_pair(found);
    if (pairs.pipeline_seconds == 0.0) return;
    state.counters["of_pairs"] = static_cast<double>(count) / static_cast<double>(dataset(data, kind).packed.size());
    state.counters["of_time"] = seconds / (seconds + pairs.pipeline_seconds);
}

}  // namespace

void register_search_benchmarks()
{
    const auto add = [](PairKind kind, const std::string& sort, const std::string& data) {
        for (const Isa isa : available_isas()) {
            const std::string full_name = std::string("search/").append(name(kind)) + "/" + fastccd::name(isa) + "/" + sort + "/" + data;
            benchmark::RegisterBenchmark(full_name.c_str(), [=](benchmark::State& state) { run_search(state, sort, kind, isa, data); })
                ->Unit(benchmark::kMicrosecond);
        }
    };
    for (const PairKind kind : {PairKind::vertex_face, PairKind::edge_edge}) {
        for (const std::string& data : available_datasets())
            for (const char* sort : {"sample", "contacts", "undecided"})
                if (sort == std::string("undecided") || data == "random" || data == "generated") add(kind, sort, data);
        add(kind, "resting", "bricks");
    }
}

}  // namespace fastccd::bench
