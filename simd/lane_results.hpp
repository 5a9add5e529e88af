// From lanes to the results of a tile: what both pipelines share.
#pragma once

#include <kernel_table.hpp>
#include <lane.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Bits of a batch of which `left` lanes are in use.
template <class L>
FASTCCD_INLINE unsigned lanes_in_use(std::size_t left)
{
    return left >= Lane<L>::width ? (1u << Lane<L>::width) - 1 : (1u << left) - 1;
}

/// Calls visit(i, lane) for the pairs of the lanes whose bit is set; a fraction of their numbers (window_mark) is cut off.
template <class L, class Visit>
FASTCCD_INLINE void for_each_pair(L pair, unsigned lanes, Visit visit)
{
    alignas(64) double pairs[Lane<L>::width];
    Lane<L>::store(pairs, pair);
    for (; lanes != 0; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        visit(static_cast<unsigned>(pairs[lane]), lane);
    }
}

/// Leaves the pairs of these lanes to the certified search.
template <class L>
FASTCCD_INLINE void leave_undecided(TileScratch& scratch, L pair, unsigned lanes)
{
    for_each_pair(pair, lanes, [&](unsigned i, int) FASTCCD_INLINE_LAMBDA { set_bit(scratch.is_undecided, i); });
}

/// Notes that pairs of these lanes may touch in the leaves that start at `left`.
template <class L>
FASTCCD_INLINE void note_touches(TileScratch& scratch, L pair, L left, unsigned lanes)
{
    alignas(64) double lefts[Lane<L>::width];
    Lane<L>::store(lefts, left);
    for_each_pair(pair, lanes, [&](unsigned i, int lane) FASTCCD_INLINE_LAMBDA {
        const bool is_first = !is_set(scratch.may_touch, i) || lefts[lane] < scratch.touch_time[i];
        if (is_first) scratch.touch_time[i] = lefts[lane];
        set_bit(scratch.may_touch, i);
    });
}

/// Nothing reported, nothing undecided, all times +infinity. In scenes most words of 64 pairs report nothing, and their times are not
/// touched, here and in mark_reported(): all of them would be most of the first-level cache, in which pairs to come are already.
template <class L>
FASTCCD_INLINE void clear_results(TileScratch& scratch, std::size_t count)
{
    const auto clear = [&](std::size_t i, std::size_t end) FASTCCD_INLINE_LAMBDA {
        for (; i < end; i += Lane<L>::width) Lane<L>::store(&scratch.time[i], broadcast<L>(__builtin_inf()));
    };
    for (std::size_t i = 0; i < scratch.cleared; i += 64)
        if (scratch.reported[i / 64] != 0) clear(i, i + 64);
    if (scratch.cleared < count) {
        clear(scratch.cleared, (count + 63) / 64 * 64);
        scratch.cleared = (count + 63) / 64 * 64;
    }
    scratch.earliest = __builtin_inf();
    __builtin_memset(scratch.roots, 0, (count + 63) / 64 * 64);
    __builtin_memset(scratch.reported, 0, sizeof scratch.reported);
    __builtin_memset(scratch.is_undecided, 0, sizeof scratch.is_undecided);
    __builtin_memset(scratch.may_touch, 0, sizeof scratch.may_touch);
}

/// 64 bytes.
FASTCCD_INLINE bool are_zero(const std::uint8_t* bytes)
{
    std::uint64_t words[8], any = 0;
    __builtin_memcpy(words, bytes, sizeof words);
    for (const std::uint64_t word : words) any |= word;
    return any == 0;
}

/// Fills in `reported` and `earliest` from the times, where there are roots.
template <class L>
FASTCCD_INLINE void mark_reported(TileScratch& scratch, std::size_t count)
{
    const L infinity = broadcast<L>(__builtin_inf());
    L smallest = infinity;
    for (std::size_t i = 0; i < count; i += 64) {
        if (are_zero(&scratch.roots[i])) continue;  // as clear_results() left it
        std::uint64_t word = 0;
        for (unsigned k = 0; k < 64; k += Lane<L>::width) {
            const L time = Lane<L>::load(&scratch.time[i + k]);
            word |= std::uint64_t{Lane<L>::bits(less(time, infinity))} << k;
            smallest = min(time, smallest);
        }
        scratch.reported[i / 64] = word;  // past the last pair times are +infinity, as clear_results() left them
    }
    alignas(64) double lanes[Lane<L>::width];
    Lane<L>::store(lanes, smallest);
    scratch.earliest = lanes[0];
    for (unsigned lane = 1; lane < Lane<L>::width; ++lane)
        if (lanes[lane] < scratch.earliest) scratch.earliest = lanes[lane];
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
