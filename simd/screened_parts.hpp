// Batches of pairs as screening reads them, and what it leaves of them as the stages after it read it from [candidates]: in double, and where
// lanes of screening are of single precision, two batches of those at a time.
#pragma once

#include <block_source.hpp>
#include <lane_results.hpp>
#include <records.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Where pairs lie of which the lanes of an S hold so many batches of L.
template <class S, class L>
struct Parts {
    static constexpr unsigned count = Lane<S>::width / Lane<L>::width;
    const double* at[count];
};

FASTCCD_INLINE const double* in_blocks(const double* blocks, std::size_t i)
{
    return blocks + i / block_pairs * block_coordinates + i % block_pairs;
}

/// Of pairs that screening reads next, from `i` on of the `count` in a group's blocks. What lies past the end is the first part again.
template <class S, PairKind kind, class L>
FASTCCD_INLINE Parts<S, L> next_parts(BlockSource<kind, L>& source, const double* blocks, std::size_t i, std::size_t count)
{
    Parts<S, L> parts;
    for (unsigned k = 0; k < Parts<S, L>::count; ++k) {
        const std::size_t j = i + k * Lane<L>::width < count ? i + k * Lane<L>::width : i;
        if (j % block_pairs == 0) source.at_block();
        parts.at[k] = in_blocks(blocks, j);
    }
    return parts;
}

/// Once for every part that is read: asks for memory ahead of those from `first` on.
template <class S, PairKind kind, class L>
FASTCCD_INLINE void ask_ahead(BlockSource<kind, L>& source, const Parts<S, L>& parts, unsigned first = 0)
{
    for (unsigned k = first; k < Parts<S, L>::count; ++k) source.at_batch(parts.at[k]);
}

/// Appends lanes of part k of what was screened. Its motion is computed again: kept, it would be through memory as well.
template <unsigned k, PairKind kind, class S, class L>
FASTCCD_INLINE void queue_part(PairQueue& candidates, const BlockSource<kind, L>& source, const Parts<S, L>& parts, std::size_t first, S mark,
                               unsigned lanes, double t_max)
{
    PairRecord<L> record;
    record.r = relative_motion<L>(parts.at[k], block_pairs, t_max);
    record.pair = source.numbers(first + k * Lane<L>::width) + Lane<L>::template widened<k>(mark);
    push(candidates, lanes >> k * Lane<L>::width & lanes_in_use<L>(Lane<L>::width), record);
}

/// Appends the `lanes` of parts that begin with pair `first`, in double, with `mark` added to their numbers: both parts at once if that
/// makes a batch at most, since a store for each field and batch is most of what queueing takes (bench/LIMITS.md).
template <PairKind kind, class S, class L>
FASTCCD_INLINE void queue_parts(PairQueue& candidates, const BlockSource<kind, L>& source, const Parts<S, L>& parts, std::size_t first, S mark,
                                unsigned lanes, double t_max)
{
    static_assert(Lane<S>::width <= PairQueue::most_added && Lane<L>::width <= most_lanes);
    if constexpr (Parts<S, L>::count == 2) {
        if constexpr (Lane<L>::can_join) {
            const auto count = static_cast<unsigned>(__builtin_popcount(lanes));
            if (count <= Lane<L>::width) [[likely]] {
                const typename Lane<L>::template Joiner<> joiner{lanes};
                Appender<PairQueue, L> append{candidates, count};
                const auto append_joined = [&](L low, L high) FASTCCD_INLINE_LAMBDA { return append(joiner(low, high)); };
                combined_motion<L>(parts.at, block_pairs, t_max, append_joined);
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
