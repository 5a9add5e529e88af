// A pair, or one candidate root of a pair, as it waits in a queue between stages.
#pragma once

#include <certificates.hpp>
#include <kernel_table.hpp>
#include <sign_change.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// What is known of a pair, lane by lane. One structure for all stages, filled in as they go: compilers copy
/// structures of wide registers through memory, in pieces that stall the loads that follow.
template <class L>
struct PairRecord {
    RelativeMotion<L> r;
    Scales<L> scale;
    L pair;  ///< Index in the tile, as a double.
    // From the screening on, for the pair:
    CoplanarityCubic<L> cubic;
    // From the search for roots on, for one monotone piece in which the cubic changes sign:
    PowerCubic<L> f;
    L threshold;  ///< See sign_threshold.
    L low, high;  ///< The piece.
    L guess;      ///< Where the next stage starts.
};

// Call visit(field) for each field that a queue holds, always in the same order.

template <class Record, class Visit>
FASTCCD_INLINE void for_each_common_field(Record& record, Visit& visit)
{
    const auto vector = [&](auto& v) FASTCCD_INLINE_LAMBDA { visit(v.x), visit(v.y), visit(v.z); };
    vector(record.r.start[0]), vector(record.r.start[1]), vector(record.r.start[2]);
    vector(record.r.end[0]), vector(record.r.end[1]), vector(record.r.end[2]);
    visit(record.pair);
}

template <class Record, class Visit>
FASTCCD_INLINE void for_each_field(const PairQueue&, Record& record, Visit visit)
{
    for_each_common_field(record, visit);
    visit(record.scale.yz), visit(record.scale.zx), visit(record.scale.xy), visit(record.scale.volume);
    visit(record.cubic.start), visit(record.cubic.thrice_second), visit(record.cubic.thrice_third), visit(record.cubic.end);
}

/// Scale and cubic are computed again: few roots get here, but a batch that leaves one pays for every field.
template <class Record, class Visit>
FASTCCD_INLINE void for_each_field(const RootQueue&, Record& record, Visit visit)
{
    for_each_common_field(record, visit);
    visit(record.low), visit(record.high), visit(record.guess);
}

/// What RootQueue leaves out. Returns the cubic.
template <class L>
FASTCCD_INLINE Cubic<L> compute_again(PairRecord<L>& root, const SearchParameters& parameters)
{
    const Cubic<L> f = bernstein(coplanarity_cubic(root.r, cross_product(root.r, 0, 1)));
    root.f = power_basis(f);
    root.scale = scales(extents(root.r));
    root.threshold = sign_threshold(f, root.scale.volume, parameters.bounds, parameters.leaf_width);
    return f;
}

/// Appends the lanes of `record` whose bit is set.
template <class Queue, template <class> class Record, class L>
FASTCCD_INLINE void push(Queue& queue, unsigned bits, const Record<L>& record)
{
    double* const end = &queue.data[0][queue.size];
    queue.size += static_cast<unsigned>(__builtin_popcount(bits));
    unsigned row = 0;
    for_each_field(queue, record, [&](const L& field) FASTCCD_INLINE_LAMBDA {
        Lane<L>::compress_store(end + Queue::capacity * row++, bits, field);
    });
}

/// Lanes first, first + 1, ... of the queue; whatever lies past its end in the last ones.
template <class Queue, template <class> class Record, class L>
FASTCCD_INLINE void read(const Queue& queue, unsigned first, Record<L>& record)
{
    const double* const begin = &queue.data[0][first];
    unsigned row = 0;
    for_each_field(queue, record, [&](L& field) FASTCCD_INLINE_LAMBDA {
        field = Lane<L>::load(begin + Queue::capacity * row++);
    });
}

template <std::size_t size, class L>
FASTCCD_INLINE void store(double (&rows)[4][size], unsigned i, const PowerCubic<L>& f)
{
    Lane<L>::store(&rows[0][i], f.c0);
    Lane<L>::store(&rows[1][i], f.c1);
    Lane<L>::store(&rows[2][i], f.c2);
    Lane<L>::store(&rows[3][i], f.c3);
}

template <class L, std::size_t size>
FASTCCD_INLINE PowerCubic<L> load_cubic(const double (&rows)[4][size], unsigned i)
{
    return {Lane<L>::load(&rows[0][i]), Lane<L>::load(&rows[1][i]), Lane<L>::load(&rows[2][i]), Lane<L>::load(&rows[3][i])};
}

/// Moves what lies from `first` on to the front.
template <class Queue>
FASTCCD_INLINE void drop_front(Queue& queue, unsigned first)
{
    if (first > queue.size) first = queue.size;
    for (unsigned k = 0; k < Queue::fields; ++k)
        for (unsigned i = first; i < queue.size; ++i) queue.data[k][i - first] = queue.data[k][i];
    queue.size -= first;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
