// The stages of a minimum separation over one tile:
//
//     block -> certificates -> [candidates] -> certificates -> first look -> [advancing] -> guess, once -> look -> step -> contact
//                   |                           in double          |             ^                                  |    or farther
//                   v                               |              v             +----------------------------------+
//                farther                            +-------->  farther
//
// Certificates are those of farther_certificates.hpp. As in pipeline.hpp they run in single precision first where that makes lanes of it, by bounds
// by which nothing is farther there that is not in double. In double they define the result, and tell on which half a pair is farther.
//
// Lanes take the steps of separation_steps.hpp, in the same operations as the scalar search; they leave to it pairs out
// of range, and those that take too many steps. Pairs that need another step stay in [advancing], closed up, and wait there for others
// until there are enough for another round.
#pragma once

#include <contact_guess.hpp>
#include <farther_certificates.hpp>
#include <screened_parts.hpp>
#include <separation_steps.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class Record, class Visit>
FASTCCD_INLINE void for_each_field(const AdvancingQueue&, Record& record, Visit visit)
{
    for_each_common_field(record, visit);
    visit(record.extents.x), visit(record.extents.y), visit(record.extents.z);
    visit(record.time), visit(record.window_low), visit(record.window_high);
    visit(record.looks), visit(record.purpose), visit(record.at);
    visit(record.n.x), visit(record.n.y), visit(record.n.z), visit(record.high), visit(record.interval);
    visit(record.last_time), visit(record.last_gap);
}

/// What is done with [candidates], however they were read.
template <PairKind kind, class L>
class SeparationStages {
public:
    FASTCCD_INLINE SeparationStages(const TileRequest& request, TileScratch& scratch)
        : parameters_{*request.parameters}, bounds_{SeparationBounds{parameters_.bounds.rho}.certificates(parameters_.separation)},
          limit_{time_limit(request.cutoff)}, scratch_{scratch}
    {
        scratch.candidates.size = scratch.advancing.size = 0;
    }

    FASTCCD_INLINE void look_first_if_many()
    {
        if (scratch_.candidates.size >= PairQueue::drain_at) look_first(width);
    }

    void finish()
    {
        look_first(1);
        while (scratch_.advancing.size > 0) advance();
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters_;
    const FartherBounds bounds_;
    const double limit_;
    TileScratch& scratch_;
    unsigned first_new_ = 0;  ///< Pairs from here on in [advancing] have had their first look alone.

    /// The certificates in double and the first look, of batches from the end, until fewer than `least` pairs are left.
    void look_first(unsigned least)
    {
        PairQueue& candidates = scratch_.candidates;
        SeparationRecord<L> record;
        while (candidates.size >= least) {
            const unsigned taken = candidates.size < width ? candidates.size : width;
            candidates.size -= taken;
            read(candidates, candidates.size, record);
            unsigned lanes = lanes_in_use<L>(taken);
            const ApartOnHalves<L> farther = farther_on_halves<kind>(record.r, bounds_, record.extents);
            lanes &= ~Lane<L>::bits(farther.first & farther.second);
            if (lanes == 0) continue;
            lanes &= ~Lane<L>::bits(first_look<kind>(record, farther, parameters_));
            if (lanes == 0) continue;
            push(scratch_.advancing, lanes, record);
            while (scratch_.advancing.size >= AdvancingQueue::drain_at) advance();
        }
    }

    /// Guesses of the pairs from `first` on. Every step is done for all of them before the next one, as for roots (root_stages.hpp).
    void guess_contacts(unsigned first)
    {
        ContactGuesses& guesses = scratch_.guesses;
        const unsigned begin = first / width * width, end = scratch_.advancing.size;
        for (unsigned i = begin; i < end; i += width) {
            SeparationRecord<L> record;
            read(scratch_.advancing, i, record);
            const ClosingPlanes<L> planes = closing_planes<kind>(record, parameters_);
            store(guesses.f, i, planes.f);
            store(guesses.n, 0, i, planes.n0);
            store(guesses.n, 3, i, planes.n1);
            store(guesses.n, 6, i, planes.n2);
            Lane<L>::store(&guesses.aim[i], planes.aim);
            Lane<L>::store(&guesses.time[i], planes.begin);
        }
        for (int k = 0; k < guess_steps; ++k)
            for (unsigned i = begin; i < end; i += width) {
                const ClosingPlanes<L> planes{load<PowerCubic, L>(guesses.f, i), load<L>(guesses.n, 0, i), load<L>(guesses.n, 3, i),
                                              load<L>(guesses.n, 6, i), Lane<L>::load(&guesses.aim[i]), {}};
                Lane<L>::store(&guesses.time[i], next_guess(planes, Lane<L>::load(&guesses.time[i])));
            }
    }

    /// Pairs i, i + 1, ... on their way; of new ones, the next look is at the guess.
    FASTCCD_INLINE SeparationRecord<L> record_at(unsigned i) const
    {
        SeparationRecord<L> record;
        read(scratch_.advancing, i, record);
        look_at_guess(record, Lane<L>::load(&scratch_.guesses.time[i]));
        return record;
    }

    /// A step of all pairs on their way; those that go on move to the front. First all looks, then what follows from them: a look is one
    /// chain of operations, with three divisions and a root in it, and a processor overlaps it with the next as far as it sees that
    /// (bench/LIMITS_SEARCH.md). So features are not asked for in between.
    void advance()
    {
        AdvancingQueue& queue = scratch_.advancing;
        const unsigned size = queue.size;
        if (first_new_ < size) guess_contacts(first_new_);
        unsigned open = 0;
        for (unsigned i = 0; i < size; i += width) look_again(i, open);
        for (unsigned k = 0; k < open; ++k) ask_for_features(scratch_.looks.open[k]);
        queue.size = 0;
        for (unsigned i = 0; i < size; i += width) step_on(i, lanes_in_use<L>(size - i));
        first_new_ = queue.size;
    }

    FASTCCD_INLINE Separation<L> seen_at(unsigned i) const
    {
        const Looks& looks = scratch_.looks;
        return {load<L>(looks.n, 0, i), Lane<L>::load(&looks.gap[i]), Lane<L>::load(&looks.square_to_side[i])};
    }

    /// The looks at pairs i, i + 1, ..., but for features: lists them in place `open` if those are to be asked for.
    FASTCCD_INLINE void look_again(unsigned i, unsigned& open)
    {
        const SeparationRecord<L> record = record_at(i);
        const Separation<L> seen = quick_look<kind>(record);
        Looks& looks = scratch_.looks;
        store(looks.n, 0, i, seen.n);
        Lane<L>::store(&looks.gap[i], seen.gap);
        Lane<L>::store(&looks.square_to_side[i], seen.square_to_side);
        looks.open[open] = i;
        open += Lane<L>::bits(asks_features(record, seen, parameters_)) != 0 ? 1 : 0;
    }

    /// For pairs i, i + 1, ... as look_again() has left them.
    __attribute__((noinline)) void ask_for_features(unsigned i)
    {
        const Separation<L> best = by_features<kind>(record_at(i), seen_at(i), parameters_);
        store(scratch_.looks.n, 0, i, best.n);
        Lane<L>::store(&scratch_.looks.gap[i], best.gap);
    }

    FASTCCD_INLINE void step_on(unsigned i, unsigned lanes)
    {
        SeparationRecord<L> record = record_at(i);
        const StepOutcome<L> outcome = step<kind>(record, seen_at(i), parameters_, limit_);
        const unsigned contact = lanes & Lane<L>::bits(outcome.contact);
        if (contact != 0) record_contacts(record, contact, Lane<L>::bits(outcome.proven));
        const unsigned left = lanes & Lane<L>::bits(outcome.left);
        if (left != 0) leave_undecided(scratch_, record.pair, left);
        push(scratch_.advancing, lanes & ~(contact | left | Lane<L>::bits(outcome.farther)), record);
    }

    FASTCCD_INLINE void record_contacts(const SeparationRecord<L>& record, unsigned contact, unsigned proven)
    {
        alignas(64) double times[width];
        Lane<L>::store(times, record.time);
        for_each_pair(record.pair, contact, [&](unsigned i, int lane) FASTCCD_INLINE_LAMBDA {
            scratch_.time[i] = times[lane];
            if (times[lane] < scratch_.earliest) scratch_.earliest = times[lane];
            set_bit(scratch_.reported, i);
            if ((proven >> lane & 1) == 0) set_bit(scratch_.is_unproven, i);
        });
    }
};

/// Source: how the tile's pairs are read, PackedPairs, StridedPairs or IndexedPairs.
template <PairKind kind, class L, class Source>
class SeparationPipeline {
public:
    static void run_tile(const TileRequest& request, TileScratch& scratch)
    {
        SeparationPipeline pipeline{request, scratch};
        clear_results<L>(scratch, request.count);
        const std::size_t size = pipeline.source_.size();
        for (std::size_t first = 0; first < size; first += group_pairs) {
            pipeline.source_.begin_group(first);
            const std::size_t count = size - first < group_pairs ? size - first : group_pairs;
            for (std::size_t i = 0; i < count; i += Lane<Screening>::width) {
                const auto parts = next_parts<Screening, L>(pipeline.source_, first, i, count);
                ask_ahead_before(pipeline.source_, parts);
                pipeline.screen(parts, first + i, lanes_in_use<Screening>(count - i));
                ask_ahead_after(pipeline.source_, parts);
            }
        }
        pipeline.stages_.finish();
    }

private:
    using Screening = typename Lane<L>::Screening;
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters_;
    const FartherBounds bounds_;
    TileScratch& scratch_;
    Source source_;
    SeparationStages<kind, L> stages_;

    FASTCCD_INLINE SeparationPipeline(const TileRequest& request, TileScratch& scratch)
        : parameters_{*request.parameters}, bounds_{screening_bounds(SeparationBounds{parameters_.bounds.rho}, parameters_.separation)},
          scratch_{scratch}, source_{request, scratch}, stages_{request, scratch}
    {
    }

    static FASTCCD_INLINE FartherBounds screening_bounds(const SeparationBounds& bounds, const SeparationParameters& separation)
    {
        return Lane<Screening>::is_single ? bounds.certificates_in_single(separation) : bounds.certificates(separation);
    }

    FASTCCD_INLINE void screen(const Parts<Screening, L, Source>& parts, std::size_t first, unsigned lanes)
    {
        using S = Screening;
        const RelativeMotion<S> r = motion_of_parts(parts, parameters_.t_max);
        Extents<S> extents;
        const LaneMask<S> along_axis = linear_certificate<kind>(r, bounds_, extents);
        const Scales<S> scale = scales(extents);
        const CoplanarityCubic<S> f = coplanarity_cubic(r, cross_product(r, 0, 1));
        const unsigned in_range = Lane<S>::bits(in_range_of_screening(r, f, extents));
        if (const unsigned beyond = lanes & ~in_range; beyond != 0) take_beyond(parts, first, beyond);
        lanes &= in_range & ~Lane<S>::bits(along_axis | farther_by_volume<kind>(f, scale, bounds_));
        if (lanes == 0) return;
        const ApartOnHalves<S> farther =
            visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
                return farther_on_halves<kind>(f, p, q, t, s, extents, scale, bounds_);
            });
        lanes &= ~Lane<S>::bits(farther.first & farther.second);
        if (lanes == 0) return;
        queue_parts(scratch_.candidates, source_, parts, first, broadcast<S>(0.0), lanes, parameters_.t_max);
        stages_.look_first_if_many();
    }

    template <class S>
    FASTCCD_INLINE LaneMask<S> in_range_of_screening(const RelativeMotion<S>& r, const CoplanarityCubic<S>& f, const Extents<S>& extents) const
    {
        if constexpr (Lane<S>::is_single)
            return in_lane_range(f, extents, bounds_);
        else
            return in_separation_range(r, extents);
    }

    /// Pairs beyond the range in which they were screened: to the scalar search, or on in double. Rare, so out of the way.
    __attribute__((noinline)) void take_beyond(const Parts<Screening, L, Source>& parts, std::size_t first, unsigned beyond)
    {
        for (unsigned k = 0; k < Parts<Screening, L, Source>::count; ++k) {
            const unsigned lanes = beyond >> k * width & lanes_in_use<L>(width);
            if (lanes == 0) continue;
            PairRecord<L> record;
            record.r = relative_motion_of<L>(Source::coordinates(parts.at[k]), parameters_.t_max);
            record.pair = source_.numbers(first + k * width);
            const unsigned decidable = lanes & Lane<L>::bits(in_separation_range(record.r, extents(record.r)));
            leave_undecided(scratch_, record.pair, lanes & ~decidable);
            push(scratch_.candidates, decidable, record);
        }
        stages_.look_first_if_many();
    }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
