// The stages of the narrow phase over one tile:
//
//     block -> linear, cubic certificates -> [screened] -> cubic, quadratic certificates -> [candidates] -> sign-change intervals,
//                     |                                     on both halves                        Householder steps, leaf,
//                     v                                           |                               inclusion
//                   apart                                         v                                |             |
//                                                               apart                      contact or apart      [slow]
//                                                                                                                |
//                  may touch, or undecided  <- here and above -  more steps, tighter bounds <--------------------+
//                     |              |                             |
//                     v              v                             v
//      leaf as the search       certified search             contact or apart
//      sees it: contact,             ^
//      apart or undecided -----------+
//
// [slow] also takes the roots after a pair's first, if that is no contact or if roots are counted. Before a pair is left undecided by
// the search for its roots, all certificates are tried on quarters of the step. Pairs that touch at a side or an end, or next to the end
// of a leaf, are noted with that leaf, those that have no clear root, as within one plane, without one; they are decided after the tile, from
// their coordinates (touching_pairs.hpp).
//
// The first stages run in single precision where that makes lanes of it, twice as many as of double: differences of coordinates are taken
// in double, then rounded. They only prove pairs apart, by bounds for that precision (ErrorBounds::screening_in_single), and what they
// prove the certified search proves too; so whether lanes do so, and for which pairs, changes no result. Pairs too large or too small for it
// are screened in double. All that finds a time is in double.
//
// Queues pack what a stage leaves, so that the next one runs on full batches. Where few pairs are left, the queue says where
// their coordinates are; where most are, whole registers are compressed, and [screened] is left out.
//
// What lanes conclude is what the certified search (scalar/certified_search.hpp) would conclude:
// - "apart" is concluded only with margins under which the search certifies every leaf: certificates and
//   sign tests cover [0, 1] by intervals that overlap by at least one leaf, or by its halves or quarters, which no leaf straddles
//   (see error_bound.hpp); where the whole step is one leaf, the search halves it there (scalar/leaf_search.hpp);
// - "contact in leaf j" is concluded only from a proof (a strict sign change of the cubic over the leaf and
//   strict inclusion throughout it), so that no certificate of absence can hold there, together with
//   "apart" for everything before it;
// - of a pair that may touch in leaf j nothing is concluded but "apart" for everything before that leaf, and of one that may touch anywhere
//   nothing at all: what the search says of them is asked by its own text, bounds and all.
// Everything else is left undecided. So the bits do not depend on the instruction set or the batch.
#pragma once

#include <part_certificates.hpp>
#include <root_stages.hpp>
#include <screened_parts.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Source: how the tile's pairs are read, PackedPairs, StridedPairs or IndexedPairs.
template <PairKind kind, class L, class Source>
class Pipeline {
public:
    static void run_tile(const TileRequest& request, TileScratch& scratch)
    {
        Pipeline pipeline{request, scratch};
        clear_results<L>(scratch, request.count);
        scratch.screened.size = 0;
        for (std::size_t i = 0; i < pipeline.source_.size(); i += group_pairs) {
            const std::size_t left = pipeline.source_.size() - i, count = left < group_pairs ? left : group_pairs;
            if (scratch.dense) {
                pipeline.screen_dense_group(i, count);
            } else {
                pipeline.screen_sparse_group(i, count, request.preferences);
                pipeline.compare_screened(false);
            }
        }
        pipeline.compare_screened(true);
        pipeline.root_stages_.finish();
        mark_reported<L>(scratch, request.count);
    }

private:
    static constexpr unsigned width = Lane<L>::width;

    const SearchParameters& parameters_;
    const ScreeningBounds in_double_, in_single_;
    const double cutoff_;
    TileScratch& scratch_;
    Source source_;
    RootStages<kind, L> root_stages_;

    FASTCCD_INLINE Pipeline(const TileRequest& request, TileScratch& scratch)
        : parameters_{*request.parameters}, in_double_{parameters_.bounds.screening()}, in_single_{parameters_.bounds.screening_in_single()},
          cutoff_{request.cutoff}, scratch_{scratch}, source_{request, scratch}, root_stages_{parameters_, scratch}
    {
    }

    template <class S>
    [[nodiscard]] FASTCCD_INLINE const ScreeningBounds& bounds_of() const
    {
        if constexpr (Lane<S>::is_single)
            return in_single_;
        else
            return in_double_;
    }

    /// What the linear and cubic certificates say of a batch.
    struct Screening {
        unsigned kept;    ///< Lanes to look into.
        unsigned beyond;  ///< Lanes whose coordinates lanes of this precision do not decide.
    };

    /// Linear and cubic certificates on the whole interval. Fills in scale and cubic of the record.
    template <class S>
    FASTCCD_INLINE Screening screen(PairRecord<S>& record)
    {
        const ScreeningBounds& bounds = bounds_of<S>();
        Extents<S> extents;
        const LaneMask<S> separated = linear_certificate<kind>(record.r, bounds.whole, extents);
        record.scale = scales(extents);
        record.cubic = coplanarity_cubic(record.r, cross_product(record.r, 0, 1));
        const unsigned in_range = Lane<S>::bits(in_lane_range(record.cubic, extents, bounds));
        const unsigned apart = Lane<S>::bits(separated | cubic_certificate(record.cubic, record.scale.volume, bounds.whole));
        return {in_range & ~apart, lanes_in_use<S>(Lane<S>::width) & ~in_range};
    }

    void screen_sparse_group(std::size_t first, std::size_t count, const Preferences& preferences)
    {
        if constexpr (Lane<L>::screens_scenes_in_either && !Source::holds_floats)
            if (preferences.scenes_in_double) return screen_group<L>(first, count);
        screen_group<typename Lane<L>::Screening>(first, count);
    }

    /// For scenes, where most pairs end here: screens a group without looking at any result, which no branch predictor could
    /// foresee, then lists what is left in [screened]. Processors overlap one batch with the next only as far as a few hundred
    /// instructions reach: there is nothing in the loop that could be done before or after it.
    template <class S>
    void screen_group(std::size_t first, std::size_t count)
    {
        source_.begin_group(first);
        std::uint64_t kept = 0, beyond = 0;
        for (std::size_t i = 0; i < count; i += Lane<S>::width) {
            const auto parts = next_parts<S, L>(source_, first, i, count);
            PairRecord<S> record;
            record.r = motion_of_parts(parts, parameters_.t_max);
            ask_ahead_before(source_, parts);
            const Screening found = screen(record);
            ask_ahead_after(source_, parts, found.kept);
            kept |= std::uint64_t{found.kept} << i;
            beyond |= std::uint64_t{found.beyond} << i;
        }
        const std::uint64_t in_use = count < group_pairs ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
        kept &= in_use;
        beyond &= in_use;
        if constexpr (Lane<S>::is_single)
            if (beyond != 0) screen_again(first, kept, beyond);
        for (; beyond != 0; beyond &= beyond - 1)
            set_bit(scratch_.is_undecided, source_.number(first + static_cast<unsigned>(__builtin_ctzll(beyond))));
        scratch_.dense = 2 * static_cast<std::size_t>(__builtin_popcountll(kept)) >= count;

        // Eight at a time, the last of them perhaps in vain: processors foresee the number of eights better than that of pairs.
        ScreenedQueue& queue = scratch_.screened;
        const auto more = static_cast<unsigned>(__builtin_popcountll(kept));
        const std::uint64_t last = std::uint64_t{1} << (count - 1);
        for (unsigned k = 0; k < more; k += 8) {
#pragma GCC unroll 8
            for (unsigned j = 0; j < 8; ++j) {
                const auto i = static_cast<std::size_t>(__builtin_ctzll(kept | last));
                kept &= kept - 1;
                source_.keep_place(queue, queue.size + k + j, first + i);
                queue.numbers[queue.size + k + j] = static_cast<double>(source_.number(first + i));
            }
        }
        queue.size += more;
    }

    /// The pairs of a group that are beyond the range of single precision, in double. Those that stay beyond are left in `beyond`.
    __attribute__((noinline)) void screen_again(std::size_t first, std::uint64_t& kept, std::uint64_t& beyond)
    {
        std::uint64_t still_beyond = 0;
        for (std::size_t i = 0; i < group_pairs; i += width) {
            const std::uint64_t lanes = beyond >> i & lanes_in_use<L>(width);
            if (lanes == 0) continue;
            PairRecord<L> record;
            const Screening found = screen_again(source_.place(first + i), record);
            kept |= (found.kept & lanes) << i;
            still_beyond |= (found.beyond & lanes) << i;
        }
        beyond = still_beyond;
    }
    FASTCCD_INLINE Screening screen_again(typename Source::Place place, PairRecord<L>& record)
    {
        record.r = relative_motion_of<L>(Source::coordinates(place), parameters_.t_max);
        return screen(record);
    }

    /// Where most pairs go on: straight to the certificates on both halves, without a queue. To queue what is left of a batch waits for all
    /// its comparisons; so the next batch is read before that, the last one twice, as a branch there would cost most of what is gained. Not
    /// with lanes of 512 bits, which gain nothing by it from memory (bench/LIMITS.md).
    void screen_dense_group(std::size_t first, std::size_t count)
    {
        using S = typename Lane<L>::Screening;
        constexpr bool reads_ahead = Lane<L>::width < most_lanes;
        source_.begin_group(first);
        Parts<S, L, Source> parts;
        PairRecord<S> record;
        const auto read_batch = [&](std::size_t i) FASTCCD_INLINE_LAMBDA {
            parts = next_parts<S, L>(source_, first, i, count);
            if constexpr (!reads_ahead) ask_ahead_before(source_, parts);
            record.r = motion_of_parts(parts, parameters_.t_max);
        };

        std::size_t kept = 0;
        if constexpr (reads_ahead) read_batch(0);
        for (std::size_t i = 0; i < count; i += Lane<S>::width) {
            if constexpr (reads_ahead)
                ask_ahead_before(source_, parts);
            else
                read_batch(i);
            const Screening found = screen(record);
            const unsigned in_use = lanes_in_use<S>(count - i);
            if ((in_use & found.beyond) != 0) kept += examine_again(parts, first + i, in_use & found.beyond);
            unsigned lanes = in_use & found.kept;
            kept += static_cast<unsigned>(__builtin_popcount(lanes));
            const S mark = compare(record, lanes);
            const Parts<S, L, Source> examined = parts;
            ask_ahead_after(source_, parts, lanes);
            if constexpr (reads_ahead) read_batch(i + Lane<S>::width < count ? i + Lane<S>::width : i);
            if (cutoff_ < 1.0 && lanes == 0) continue;
            queue_parts(scratch_.candidates, source_, examined, first + i, mark, lanes, parameters_.t_max);
            root_stages_.find_roots_if_many();
        }
        // Less than what leads here, so that shares around one half do not go to and fro.
        scratch_.dense = 3 * kept >= count;
    }

    /// Pairs beyond the range in which they were examined, in double. Returns how many screening leaves.
    template <class S>
    __attribute__((noinline)) std::size_t examine_again(const Parts<S, L, Source>& parts, std::size_t first, unsigned beyond)
    {
        std::size_t kept = 0;
        for (unsigned k = 0; k < Parts<S, L, Source>::count; ++k) {
            const unsigned lanes = beyond >> k * width & lanes_in_use<L>(width);
            if (lanes == 0) continue;
            PairRecord<L> record;
            const Screening found = screen_again(parts.at[k], record);
            record.pair = source_.numbers(first + k * width);
            leave_undecided(scratch_, record.pair, lanes & found.beyond);
            kept += static_cast<unsigned>(__builtin_popcount(lanes & found.kept));
            examine(record, lanes & found.kept);
        }
        return kept;
    }

    /// Certificates that need more than screening has computed, for some lanes, of which those are left that have none. Returns their
    /// window_mark. Those on both halves include the quadratic one on the whole.
    template <class S>
    FASTCCD_INLINE S compare(const PairRecord<S>& record, unsigned& lanes)
    {
        if (cutoff_ < 1.0) {
            lanes &= ~Lane<S>::bits(apart_until_cutoff(record));
            if (lanes == 0) return broadcast<S>(0.0);  // as for most batches, once a contact is known
        }
        const auto apart = visit_edge_functions<kind>(
            record.r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
                return halves_certificate<kind>(record.cubic, p, q, t, s, record.scale, bounds_of<S>().halves);
            });
        lanes &= ~Lane<S>::bits(apart.first & apart.second);
        return window_mark(apart);
    }

    FASTCCD_INLINE void examine(PairRecord<L>& record, unsigned lanes)
    {
        const L mark = compare(record, lanes);
        if (cutoff_ < 1.0 && lanes == 0) return;
        // Otherwise even if no lane goes on, as in a third of the batches of four random pairs: no processor foresees which.
        record.pair = record.pair + mark;
        push(scratch_.candidates, lanes, record);
        root_stages_.find_roots_if_many();
    }

    /// Takes full batches from the end of [screened], so that what stays need not move; and the rest too if `all`.
    void compare_screened(bool all)
    {
        ScreenedQueue& queue = scratch_.screened;
        while (queue.size >= width || (all && queue.size > 0)) {
            const unsigned count = queue.size < width ? queue.size : width;
            queue.size -= count;
            source_.meanwhile();
            PairRecord<L> record;
            record.r = relative_motion_of<L>(source_.collected(queue, count), parameters_.t_max);
            compute_pair_again(record);
            record.pair = Lane<L>::load(&queue.numbers[queue.size]);
            examine(record, lanes_in_use<L>(count));
        }
        source_.end_group(queue);
    }

    /// Certificates on [0, cutoff] and two leaves more, the rest of the one that the cutoff lies in and room for the rounding of this
    /// sum, rounded up to what single precision can hold: the certified search finds every leaf there apart, so toi is greater
    /// than the cutoff. Only the end of the motion moves.
    template <class S>
    FASTCCD_INLINE LaneMask<S> apart_until_cutoff(const PairRecord<S>& record)
    {
        const double until = (cutoff_ + 2 * parameters_.leaf_width) * (1.0 + 0x1p-22);
        const S end = broadcast<S>(until < 1.0 ? until : 1.0);
        const RelativeMotion<S> r{{record.r.start[0], record.r.start[1], record.r.start[2]},
                                  {position(record.r, 0, end), position(record.r, 1, end), position(record.r, 2, end)}};
        return part_certificate<kind>(r, record.scale, bounds_of<S>().part);
    }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
