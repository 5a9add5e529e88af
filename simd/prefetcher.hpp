// Ask for packed pairs before they are read: Prefetcher for those that lie one after the other, StridedPrefetcher for the others.
#pragma once

#include <cstddef>
#include <cstdint>

#include <fastccd/pair_view.hpp>
#include <kernel_table.hpp>
#include <lane.hpp>
#include <pair_source.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Asks for memory from one address to another, line by line, and returns where it stopped (a function without a result would be
/// taken for one without effect). Not inlined, and its loops not unrolled: lines that one and the same instruction asks for, in their
/// order, come faster, probably because the hardware's own prefetchers take them up. With two instructions in turn half as many
/// lines are under way (bench/LIMITS_MEMORY.md). Static, so that g++ sees which registers it leaves alone: all vectors.
[[maybe_unused]] __attribute__((noinline)) static std::uintptr_t ask_for(std::uintptr_t next, std::uintptr_t end, CacheLevel into)
{
    constexpr std::uintptr_t line = 64;
    if (into == CacheLevel::second) {
#pragma GCC unroll 1
        for (; next < end; next += line) __builtin_prefetch(reinterpret_cast<const void*>(next), 0, 2);
    } else {
#pragma GCC unroll 1
        for (; next < end; next += line) __builtin_prefetch(reinterpret_cast<const void*>(next), 0, 3);
    }
    return next;
}

inline constexpr std::uintptr_t block_bytes = block_coordinates * sizeof(double);
/// How far ahead of the block being read pairs are asked for, at most: 16 blocks of doubles, at least half of it. With more, lines
/// leave the first-level cache again before they are read. In the second-level one there is room: 16 to 32 blocks, of which up
/// to 64 are as good, and 8 take up to a tenth longer (bench/LIMITS_MEMORY.md).
inline constexpr std::uintptr_t first_level_ahead = 16 * block_bytes;

FASTCCD_INLINE std::size_t bytes_of_a_number(const PairView& pairs)
{
    return pairs.scalar() == PairView::Scalar::float64 ? sizeof(double) : sizeof(float);
}

/// Asks for pairs in blocks or interleaved before they are read.
class Prefetcher {
public:
    FASTCCD_INLINE Prefetcher(const PairSource& source, std::size_t first, CacheLevel into)
        : into_{into}, most_ahead_{into == CacheLevel::second ? 2 * first_level_ahead : first_level_ahead}
    {
        const PairView& pairs = *source.view;
        const std::size_t pair = pair_coordinates * bytes_of_a_number(pairs), all = source.size * pair;
        if (all < most_ahead_) return;  // would be read before it came
        const auto data = reinterpret_cast<std::uintptr_t>(pairs.data());
        last_start_ = data + all - most_ahead_;
        next_ = data + first * pair;
        // About what memory delivers while a pair is screened; a half to five sixths make no difference (bench/LIMITS_MEMORY.md).
        rate_ = pair * 2 / 3;
    }

    /// Once for every `pairs` of the block at `address`, about when they are read. Memory answers at its own pace: more than it can
    /// deliver while they are screened is asked for only where it would not be there in time otherwise. The rest is asked for by
    /// meanwhile(), so that the rate is even.
    FASTCCD_INLINE void at_pairs(const void* address, std::size_t pairs)
    {
        auto at = reinterpret_cast<std::uintptr_t>(address);
        at = at < last_start_ ? at : last_start_;
        limit_ = at + most_ahead_;
        const std::uintptr_t needed = at + most_ahead_ / 2, even = next_ + pairs * rate_;
        ask_until(even < needed ? needed : even);
    }

    /// Between blocks, before something that takes about as long as memory takes for a block.
    FASTCCD_INLINE void meanwhile() { ask_until(next_ + block_bytes); }

private:
    FASTCCD_INLINE void ask_until(std::uintptr_t until) { next_ = ask_for(next_, until < limit_ ? until : limit_, into_); }

    // Addresses. As they stand here, for sources not asked for, next_ is never less than what at_pairs() would ask up to.
    const CacheLevel into_;
    const std::uintptr_t most_ahead_;  ///< Bytes; at least half as many are asked for before they are read.
    std::uintptr_t next_ = most_ahead_, limit_ = 0;
    std::uintptr_t last_start_ = 0;  ///< most_ahead_ before the end.
    std::uintptr_t rate_ = 0;        ///< Bytes a pair.
};

/// Asks for strided pairs before they are copied.
class StridedPrefetcher {
public:
    FASTCCD_INLINE StridedPrefetcher(const PairSource& source, CacheLevel into)
        : pairs_{*source.view}, into_{into}, last_{static_cast<std::ptrdiff_t>(source.size) - 1},
          element_{static_cast<std::ptrdiff_t>(bytes_of_a_number(pairs_)) * pairs_.stride()}
    {
    }

    /// Before the block that starts at pair `i` of the source.
    FASTCCD_INLINE void at_block(std::size_t i)
    {
        // Of three lanes for the x, y and z of a point, so that triples, of stride 3, get all of their three lines.
        constexpr auto ahead = static_cast<std::ptrdiff_t>(first_level_ahead / 2 / block_bytes * block_pairs);
        std::ptrdiff_t offset[3];
        for (std::ptrdiff_t axis = 0; axis < 3; ++axis) {
            const std::ptrdiff_t pair = static_cast<std::ptrdiff_t>(i) + ahead + 3 * axis;
            offset[axis] = element_ * (pair < last_ ? pair : last_);
        }
        if (into_ == CacheLevel::second)
            ask_for_rows<2>(offset);
        else
            ask_for_rows<3>(offset);
    }

private:
    /// A line of each of the 24 arrays, at these bytes of the x, y and z of a point.
    template <int locality>
    FASTCCD_INLINE void ask_for_rows(const std::ptrdiff_t (&offset)[3]) const
    {
#pragma GCC unroll 1
        for (std::size_t c = 0; c < pair_coordinates; c += 3)
            for (std::size_t axis = 0; axis < 3; ++axis)
                __builtin_prefetch(static_cast<const std::byte*>(pairs_.data(c + axis)) + offset[axis], 0, locality);
    }

    const PairView& pairs_;
    const CacheLevel into_;
    const std::ptrdiff_t last_;     ///< The last pair.
    const std::ptrdiff_t element_;  ///< Bytes from a pair's coordinate to the next one's.
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
