// Batches of pairs as screening reads them, and what it leaves of them as the stages after it read it from [candidates]: in double, and where
// lanes of screening are of single precision, two batches of those at a time.
#pragma once

#include <lane_results.hpp>
#include <records.hpp>
#include <relative_motion.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Where pairs lie of which the lanes of an S hold so many batches of L.
template <class S, class L, class Source>
struct Parts {
    static constexpr unsigned count = Lane<S>::width / Lane<L>::width;
    typename Source::Place at[count];
};

/// Of pairs that screening reads next, from `i` on of the `count` of the group that starts at `first`. What lies past the end is the first part again.
template <class S, class L, class Source>
FASTCCD_INLINE Parts<S, L, Source> next_parts(Source& source, std::size_t first, std::size_t i, std::size_t count)
{
    Parts<S, L, Source> parts;
    for (unsigned k = 0; k < Parts<S, L, Source>::count; ++k) {
        const std::size_t j = i + k * Lane<L>::width < count ? i + k * Lane<L>::width : i;
        if (j % block_pairs == 0) source.begin_block(first + j);
        parts.at[k] = source.place(first + j);
    }
    return parts;
}

/// Calls `use` with the coordinates of all parts, in an array.
template <class S, class L, class Source, class Use>
FASTCCD_INLINE auto with_coordinates(const Parts<S, L, Source>& parts, Use use)
{
    using Coordinates = decltype(Source::coordinates(parts.at[0]));
    if constexpr (Parts<S, L, Source>::count == 2) {
        const Coordinates of_both[] = {Source::coordinates(parts.at[0]), Source::coordinates(parts.at[1])};
        return use(of_both);
    } else {
        const Coordinates of_all[] = {Source::coordinates(parts.at[0])};
        return use(of_all);
    }
}
/// Of floats, in single precision throughout, unless the end moves: the difference of two floats rounded to double and then to single is the one
/// rounded to single at once, since 53 bits are at least 2 * 24 + 2 (Figueroa, "When is double rounding innocuous?", 1995).
template <class S, class L, class Source>
FASTCCD_INLINE RelativeMotion<S> motion_of_parts(const Parts<S, L, Source>& parts, double t_max)
{
    if constexpr (Lane<S>::is_single && Source::holds_floats)
        if (t_max == 1.0) return relative_motion_of<S>(Source::template coordinates_in_single<S>(parts.at), 1.0);
    return with_coordinates(parts, [&](const auto& at) FASTCCD_INLINE_LAMBDA { return relative_motion_in<S, L>(at, t_max); });
}

/// Asks for memory ahead, for every part that is read: of two, for one before the batch is screened and for one after. Both before, after, or in
/// the midst of it was slower, from memory or from the second-level cache (bench/LIMITS_MEMORY.md).
template <class S, class L, class Source>
FASTCCD_INLINE void ask_ahead_before(Source& source, const Parts<S, L, Source>& parts)
{
    if constexpr (Source::asks_ahead && Parts<S, L, Source>::count == 2) source.ask_ahead(parts.at[0]);
}
/// Behind a barrier, and behind what screening found where that is given: g++ otherwise moves the call up between arithmetic that does not depend
/// on it.
template <class S, class L, class Source>
FASTCCD_INLINE void ask_ahead_after(Source& source, const Parts<S, L, Source>& parts, unsigned found = 0)
{
    if constexpr (Source::asks_ahead) {
        asm volatile("" : : "r"(found));
        source.ask_ahead(parts.at[Parts<S, L, Source>::count - 1]);
    }
}

/// Appends lanes of part k of what was screened. Its motion is computed again: kept, it would be through memory as well.
template <unsigned k, class S, class L, class Source>
FASTCCD_INLINE void queue_part(PairQueue& candidates, const Source& source, const Parts<S, L, Source>& parts, std::size_t first, S mark,
                               unsigned lanes, double t_max)
{
    PairRecord<L> record;
    record.r = relative_motion_of<L>(Source::coordinates(parts.at[k]), t_max);
    record.pair = source.numbers(first + k * Lane<L>::width) + Lane<L>::template widened<k>(mark);
    push(candidates, lanes >> k * Lane<L>::width & lanes_in_use<L>(Lane<L>::width), record);
}

/// Appends the `lanes` of parts that begin with pair `first`, in double, with `mark` added to their numbers: both parts at once if that
/// makes a batch at most, since a store for each field and batch is most of what queueing takes (bench/LIMITS.md).
template <class S, class L, class Source>
FASTCCD_INLINE void queue_parts(PairQueue& candidates, const Source& source, const Parts<S, L, Source>& parts, std::size_t first, S mark,
                                unsigned lanes, double t_max)
{
    static_assert(Lane<S>::width <= PairQueue::most_added && Lane<L>::width <= most_lanes);
    if constexpr (Parts<S, L, Source>::count == 2) {
        if constexpr (Lane<L>::can_join) {
            const auto count = static_cast<unsigned>(__builtin_popcount(lanes));
            if (count <= Lane<L>::width) [[likely]] {
                const typename Lane<L>::template Joiner<> joiner{lanes};
                Appender<PairQueue, L> append{candidates, count};
                const auto append_joined = [&](L low, L high) FASTCCD_INLINE_LAMBDA { return append(joiner(low, high)); };
                with_coordinates(parts, [&](const auto& at) FASTCCD_INLINE_LAMBDA { combined_motion<L>(at, t_max, append_joined); });
                append_joined(source.numbers(first) + Lane<L>::template widened<0>(mark),
                              source.numbers(first + Lane<L>::width) + Lane<L>::template widened<1>(mark));
                return;
            }
        }
        queue_part<0>(candidates, source, parts, first, mark, lanes, t_max);
        queue_part<1>(candidates, source, parts, first, mark, lanes, t_max);
    } else {
        queue_part<0>(candidates, source, parts, first, mark, lanes, t_max);
    }
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
