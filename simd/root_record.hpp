// One candidate root of one pair, as it waits in a queue between stages.
#pragma once

#include <certificates.hpp>
#include <kernel_table.hpp>
#include <sign_change.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class L>
struct RootRecord {
    RelativeMotion<L> r;
    PowerCubic<L> f;
    L threshold;   ///< See MonotonePieces.
    L low, high;   ///< The monotone piece that holds the root.
    L guess;       ///< Where the next stage starts.
    Scales<L> scale;
    L pair;        ///< Index in the tile, as a double.

    /// Calls visit(field) for each of the RootQueue::fields members, always in the same order.
    template <class Visit>
    FASTCCD_INLINE void for_each_field(Visit visit)
    {
        for (int i = 0; i < 3; ++i) {
            visit(r.start[i].x), visit(r.start[i].y), visit(r.start[i].z);
            visit(r.end[i].x), visit(r.end[i].y), visit(r.end[i].z);
        }
        visit(f.c0), visit(f.c1), visit(f.c2), visit(f.c3);
        visit(threshold);
        visit(low), visit(high), visit(guess);
        visit(scale.yz), visit(scale.zx), visit(scale.xy), visit(scale.volume);
        visit(pair);
    }
};

/// Appends the lanes of `record` whose bit is set.
template <class L>
FASTCCD_INLINE void push(RootQueue& queue, unsigned bits, RootRecord<L> record)
{
    unsigned k = 0;
    record.for_each_field([&](L& field) { Lane<L>::compress_store(&queue.data[k++][queue.size], bits, field); });
    queue.size += static_cast<unsigned>(__builtin_popcount(bits));
}

/// Lanes first, first + 1, ... of the queue; whatever lies past its end in the last ones.
template <class L>
FASTCCD_INLINE RootRecord<L> read(const RootQueue& queue, unsigned first)
{
    RootRecord<L> record;
    unsigned k = 0;
    record.for_each_field([&](L& field) { field = Lane<L>::load(&queue.data[k++][first]); });
    return record;
}

/// Moves what lies from `first` on to the front.
FASTCCD_INLINE void drop_front(RootQueue& queue, unsigned first)
{
    for (unsigned k = 0; k < RootQueue::fields; ++k)
        for (unsigned i = first; i < queue.size; ++i) queue.data[k][i - first] = queue.data[k][i];
    queue.size -= first;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
