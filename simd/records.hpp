// A pair, or one candidate root of a pair, as it waits in a queue between stages.
#pragma once

#include <halves_certificate.hpp>
#include <kernel_table.hpp>
#include <sign_change.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// What is known of a pair, lane by lane. One structure for all stages, filled in as they go: compilers copy
/// structures of wide registers through memory, in pieces that stall the loads that follow.
template <class L>
struct PairRecord {
    RelativeMotion<L> r;
    Scales<L> scale;
    L pair;  ///< Index in the tile, as a double, plus a fraction: see window_mark.
    // From the screening on, for the pair:
    CoplanarityCubic<L> cubic;
    // From the search for roots on, for one monotone piece in which the cubic changes sign:
    PowerCubic<L> f;
    L threshold;  ///< See sign_threshold.
    L low, high;  ///< The piece.
    L guess;      ///< Where the root is, as far as is known.
};

/// The part of [0, 1] in which a pair may be in contact.
template <class L>
struct Window {
    L low, high;
};

inline constexpr double first_half_apart = 0.25, second_half_apart = 0.375;

/// On which half a pair is apart, for one at most, as a fraction below one half that is added to its number: a field less to queue.
template <class L>
FASTCCD_INLINE L window_mark(const ApartOnHalves<L>& apart)
{
    const L zero = broadcast<L>(0.0);
    return select<L>(apart.first, broadcast<L>(first_half_apart), select<L>(apart.second, broadcast<L>(second_half_apart), zero));
}

template <class L>
FASTCCD_INLINE Window<L> window_of(L pair)
{
    // To the nearest integer, by adding and subtracting 2^52.
    const L fraction = pair - ((pair + broadcast<L>(0x1p52)) - broadcast<L>(0x1p52));
    const L between = broadcast<L>(0.5 * (first_half_apart + second_half_apart)), half = broadcast<L>(0.5);
    const LaneMask<L> first = less(broadcast<L>(0.0), fraction) & less(fraction, between);
    return {select<L>(first, half, broadcast<L>(0.0)), select<L>(less(between, fraction), half, broadcast<L>(1.0))};
}

// Call visit(field) for each field that a queue holds, always in the same order. Of a PairQueue, `pair` is the last: see read_pair.

template <class Record, class Visit>
FASTCCD_INLINE void for_each_common_field(Record& record, Visit& visit)
{
    const auto vector = [&](auto& v) FASTCCD_INLINE_LAMBDA { visit(v.x), visit(v.y), visit(v.z); };
    vector(record.r.start[0]), vector(record.r.start[1]), vector(record.r.start[2]);
    vector(record.r.end[0]), vector(record.r.end[1]), vector(record.r.end[2]);
    visit(record.pair);
}

// Scale and cubic are computed again after a queue: where one lane in five goes on, moving them takes longer (bench/LIMITS.md).

template <class Record, class Visit>
FASTCCD_INLINE void for_each_field(const PairQueue&, Record& record, Visit visit)
{
    for_each_common_field(record, visit);
}

template <class Record, class Visit>
FASTCCD_INLINE void for_each_field(const RootQueue&, Record& record, Visit visit)
{
    for_each_common_field(record, visit);
    visit(record.low), visit(record.high);
}

/// What the queues leave out, for the pair.
template <class L>
FASTCCD_INLINE void compute_pair_again(PairRecord<L>& record)
{
    record.scale = scales(extents(record.r));
    record.cubic = coplanarity_cubic(record.r, cross_product(record.r, 0, 1));
}

/// And for a root. Returns the cubic.
template <class L>
FASTCCD_INLINE Cubic<L> compute_again(PairRecord<L>& root, const SearchParameters& parameters)
{
    compute_pair_again(root);
    const Cubic<L> f = bernstein(root.cubic);
    root.f = power_basis(f);
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

/// Appends the first `count` lanes of fields that come one after the other, in the order of for_each_field: of a whole record, many would
/// leave the registers before they are stored.
template <class Queue, class L>
class Appender {
public:
    FASTCCD_INLINE Appender(Queue& queue, unsigned count) : next_{&queue.data[0][queue.size]} { queue.size += count; }
    FASTCCD_INLINE L operator()(L field)
    {
        Lane<L>::store(next_, field);
        next_ += Queue::capacity;
        return field;
    }

private:
    double* next_;
};

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

/// Of those lanes, `pair` alone.
template <class L>
FASTCCD_INLINE L read_pair(const PairQueue& queue, unsigned first)
{
    return Lane<L>::load(&queue.data[PairQueue::fields - 1][first]);
}

template <std::size_t size, class L>
FASTCCD_INLINE void store_four(double (&rows)[4][size], unsigned i, L a, L b, L c, L d)
{
    Lane<L>::store(&rows[0][i], a);
    Lane<L>::store(&rows[1][i], b);
    Lane<L>::store(&rows[2][i], c);
    Lane<L>::store(&rows[3][i], d);
}
template <std::size_t size, class L>
FASTCCD_INLINE void store(double (&rows)[4][size], unsigned i, const PowerCubic<L>& f)
{
    store_four(rows, i, f.c0, f.c1, f.c2, f.c3);
}
template <std::size_t size, class L>
FASTCCD_INLINE void store(double (&rows)[4][size], unsigned i, const Scales<L>& scale)
{
    store_four(rows, i, scale.yz, scale.zx, scale.xy, scale.volume);
}

/// A PowerCubic or Scales, in the order in which they were stored.
template <template <class> class Record, class L, std::size_t size>
FASTCCD_INLINE Record<L> load(const double (&rows)[4][size], unsigned i)
{
    return {Lane<L>::load(&rows[0][i]), Lane<L>::load(&rows[1][i]), Lane<L>::load(&rows[2][i]), Lane<L>::load(&rows[3][i])};
}

/// A vector, in rows from `row` on.
template <std::size_t rows_, std::size_t size, class L>
FASTCCD_INLINE void store(double (&rows)[rows_][size], unsigned row, unsigned i, const Vector3<L>& v)
{
    Lane<L>::store(&rows[row][i], v.x);
    Lane<L>::store(&rows[row + 1][i], v.y);
    Lane<L>::store(&rows[row + 2][i], v.z);
}
template <class L, std::size_t rows_, std::size_t size>
FASTCCD_INLINE Vector3<L> load(const double (&rows)[rows_][size], unsigned row, unsigned i)
{
    return {Lane<L>::load(&rows[row][i]), Lane<L>::load(&rows[row + 1][i]), Lane<L>::load(&rows[row + 2][i])};
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
