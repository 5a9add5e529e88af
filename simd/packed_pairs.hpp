// Packed pairs as screening reads them, doubles or floats: in place if they lie in blocks of the native layout or interleaved. Strided ones are
// copied to blocks.
#pragma once

#include <cstddef>
#include <type_traits>

#include <fastccd/pair_view.hpp>
#include <kernel_table.hpp>
#include <lane.hpp>
#include <prefetcher.hpp>
#include <relative_motion.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Coordinates of interleaved pairs, each to be asked for once, in order.
template <class L, class Number>
class TransposedPairs {
public:
    FASTCCD_INLINE explicit TransposedPairs(const Number* first) : TransposedPairs{first, first + width / 2 * pair_coordinates} {}
    /// Half of the lanes from each; all of a lane that is alone from `first`.
    FASTCCD_INLINE TransposedPairs(const Number* first, const Number* second)
    {
        for (unsigned lane = 0; lane < width; ++lane)
            pairs_[lane] = lane < half ? first + lane * pair_coordinates : second + (lane - half) * pair_coordinates;
    }
    FASTCCD_INLINE explicit TransposedPairs(const void* const* pairs)
    {
        for (unsigned lane = 0; lane < width; ++lane) pairs_[lane] = static_cast<const Number*>(pairs[lane]);
    }
    FASTCCD_INLINE L operator()(int c)
    {
        if (c % columns == 0) Lane<L>::transpose(pairs_, c, columns_);
        return columns_[c % columns];
    }

private:
    static constexpr unsigned width = Lane<L>::width, half = (width + 1) / 2;
    static constexpr int columns = Lane<L>::transposed_columns;
    static_assert(pair_coordinates % columns == 0);

    const Number* pairs_[width];
    L columns_[columns] = {};
};

/// Blocks of 8 pairs, [24][8].
struct InBlocks {
    /// From a coordinate of a pair to the next one.
    static constexpr std::size_t stride = block_pairs;

    template <class Number>
    static FASTCCD_INLINE Number* pair(Number* first, std::size_t i)
    {
        return first + i / block_pairs * block_coordinates + i % block_pairs;
    }
    template <class L, class Number>
    static FASTCCD_INLINE InRows<L, Number> coordinates(const Number* pair)
    {
        return {pair, static_cast<int>(stride)};
    }
    /// Of two batches of half as many pairs, as those of S lanes. Batches in one block follow one another.
    template <class S>
    static FASTCCD_INLINE auto in_single(const float* first, const float* second)
    {
        return [=](int c) FASTCCD_INLINE_LAMBDA {
            const std::size_t row = static_cast<std::size_t>(c) * stride;
            if constexpr (Lane<S>::width > block_pairs)
                return Lane<S>::load_halves(first + row, second + row);
            else
                return Lane<S>::load(first + row);
        };
    }
    template <class L, class Number>
    static FASTCCD_INLINE auto collected(const Number* blocks, const void* const* pairs)
    {
        return typename Lane<L>::template Collector<Number>{blocks, pairs};
    }
};

/// Copies in blocks, of pairs that lie anywhere. A layout of its own: pairs that are read in place took up to a tenth longer where the code was also
/// there to copy them (bench/LIMITS.md).
struct CopiedToBlocks : InBlocks {};

/// 24 coordinates a pair, one pair after the other. They are transposed in registers each time they are read: copied to blocks first, a pair
/// took 3 ns longer with AVX2 and AVX-512, of which a third is storing it (bench/LIMITS.md).
struct Interleaved {
    static constexpr std::size_t stride = 1;

    template <class Number>
    static FASTCCD_INLINE Number* pair(Number* first, std::size_t i)
    {
        return first + i * pair_coordinates;
    }
    template <class L, class Number>
    static FASTCCD_INLINE TransposedPairs<L, Number> coordinates(const Number* pair)
    {
        return TransposedPairs<L, Number>{pair};
    }
    template <class S>
    static FASTCCD_INLINE TransposedPairs<S, float> in_single(const float* first, const float* second)
    {
        return {first, second};
    }
    template <class L, class Number>
    static FASTCCD_INLINE TransposedPairs<L, Number> collected(const Number* /*blocks*/, const void* const* pairs)
    {
        return TransposedPairs<L, Number>{pairs};
    }
};

/// The last of `count` pairs stands for those past it, to a multiple of 8.
template <class Number>
FASTCCD_INLINE void copy_interleaved(const Number* __restrict pairs, std::size_t count, Number* __restrict copy)
{
    for (std::size_t k = 0; k < count * pair_coordinates; ++k) copy[k] = pairs[k];
    for (std::size_t k = count * pair_coordinates; k < block_coordinates; ++k) copy[k] = copy[k - pair_coordinates];
}

/// Eight numbers that follow one another. Without __restrict, which says that nothing stored here changes what is still to
/// be read, compilers move one number at a time.
template <class Number>
FASTCCD_INLINE void copy_row(const Number* __restrict data, Number* __restrict row)
{
    for (std::size_t k = 0; k < block_pairs; ++k) row[k] = data[k];
}

/// Eight pairs to a block, or fewer, of which the last one stands for those past it. Static and never inlined, so that loops that screen keep
/// their registers: inlined, random floats took 40 % longer with AVX-512 (bench/LIMITS.md).
template <class Number>
[[maybe_unused]] __attribute__((noinline)) static void pack_strided(const PairView& pairs, std::size_t first, std::size_t count, Number* block)
{
    const std::ptrdiff_t stride = pairs.stride();
    if (stride == 1 && count == block_pairs) {
#pragma GCC unroll 24
        for (std::size_t c = 0; c < pair_coordinates; ++c) copy_row(static_cast<const Number*>(pairs.data(c)) + first, block + c * block_pairs);
        return;
    }
    for (std::size_t c = 0; c < pair_coordinates; ++c) {
        const Number* const data = static_cast<const Number*>(pairs.data(c)) + static_cast<std::ptrdiff_t>(first) * stride;
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            block[c * block_pairs + lane] = data[static_cast<std::ptrdiff_t>(lane < count ? lane : count - 1) * stride];
    }
}

/// What the stages read of a tile of packed pairs, of numbers of this type in this layout; strided ones in CopiedToBlocks.
template <class L, class Layout, class Number>
class PackedPairs {
public:
    static constexpr bool holds_floats = std::is_same_v<Number, float>;
    /// Where the first coordinate of a pair lies, and by its layout the others, and the pairs that follow.
    using Place = const Number*;

    FASTCCD_INLINE PackedPairs(const TileRequest& tile, TileScratch& scratch)
        : pairs_{*tile.source->view}, first_{tile.first}, size_{tile.count}, copied_{copied_pairs(scratch)},
          prefetcher_{*tile.source, tile.first, tile.preferences.into}
    {
        if constexpr (!is_copied) in_place_ = static_cast<const Number*>(pairs_.data()) + first_ * pair_coordinates;
    }

    [[nodiscard]] FASTCCD_INLINE std::size_t size() const { return size_; }

    /// Number in the tile of pair `i` of this source, and of the pairs from `i` on, in the group begun last.
    [[nodiscard]] FASTCCD_INLINE std::size_t number(std::size_t i) const { return i; }
    [[nodiscard]] FASTCCD_INLINE L numbers(std::size_t i) const { return broadcast<L>(static_cast<double>(i)) + Lane<L>::lane_number(); }

    /// Before pairs from `i` on, a multiple of group_pairs. The last pair stands for those past the end, to a multiple of 8. Groups are to be
    /// begun in order.
    FASTCCD_INLINE void begin_group(std::size_t i)
    {
        const std::size_t count = size_ - i < group_pairs ? size_ - i : group_pairs;
        if constexpr (is_interleaved) group_is_in_place_ = count % block_pairs == 0;
        if (group_is_in_place_) {
            group_ = in_place_ + i * pair_coordinates;
            return;
        }
        if constexpr (is_copied || is_interleaved) {
            group_ = copied_.group;
            to_copy_ = i;
            group_end_ = i + count;
            copy_next();
        }
    }
    /// Before the 8 pairs from `i` on, of the group, are read. Those after them are copied then, so that memory is asked at an even rate, and
    /// nothing is read right after it was written: with a whole group copied first, strided pairs took a sixth longer (bench/LIMITS.md).
    FASTCCD_INLINE void begin_block(std::size_t /*i*/)
    {
        if constexpr (is_copied || is_interleaved)
            if (to_copy_ < group_end_) copy_next();
    }
    /// Of a pair of the group.
    [[nodiscard]] FASTCCD_INLINE Place place(std::size_t i) const { return Layout::pair(group_, i % group_pairs); }

    /// Coordinates, lane by lane, of the pair there and those after it.
    static FASTCCD_INLINE auto coordinates(Place place) { return Layout::template coordinates<L>(place); }
    /// Of floats: of both parts of a batch of S, without widening them.
    template <class S>
    static FASTCCD_INLINE auto coordinates_in_single(const Place (&parts)[2])
    {
        return Layout::template in_single<S>(parts[0], parts[1]);
    }

    /// Once for every batch of the group, before it is read or soon after. Batch by batch, although 8 blocks lie between what is
    /// asked for and what is read: with four lanes, at a block's start for both of its batches, scenes took 3 to 5 % longer on AMD's family
    /// 25 (bench/LIMITS.md).
    FASTCCD_INLINE void ask_ahead(Place batch)
    {
        if constexpr (!is_copied)
            if (group_is_in_place_) prefetcher_.at_pairs(batch, Lane<L>::width);
    }
    /// Before a batch of a later stage.
    FASTCCD_INLINE void meanwhile() { prefetcher_.meanwhile(); }

    /// For the pair at `k` in [screened], which is pair `i` of the group.
    FASTCCD_INLINE void keep_place(ScreenedQueue& screened, unsigned k, std::size_t i) const { screened.pairs[k] = place(i); }
    /// Coordinates of the `count` pairs after the last one in [screened].
    FASTCCD_INLINE auto collected(ScreenedQueue& screened, unsigned count) const
    {
        const void** const pairs = screened.pairs + screened.size;
        for (unsigned lane = count; lane < Lane<L>::width; ++lane) pairs[lane] = pairs[count - 1];
        return Layout::template collected<L>(is_copied ? copied_.group : in_place_, pairs);
    }
    /// Copies what is left in [screened], less than a batch, if the next group takes the place of this one.
    FASTCCD_INLINE void end_group(ScreenedQueue& screened)
    {
        if (!group_is_in_place_) keep_waiting(screened);
    }

private:
    static constexpr bool is_interleaved = std::is_same_v<Layout, Interleaved>, is_copied = std::is_same_v<Layout, CopiedToBlocks>;

    FASTCCD_INLINE void keep_waiting(ScreenedQueue& screened)
    {
        for (unsigned k = 0; k < screened.size; ++k) {
            Number* const to = Layout::pair(copied_.waiting, k);
            const auto* const from = static_cast<Place>(screened.pairs[k]);
            if (from == to) continue;
            for (std::size_t c = 0; c < pair_coordinates; ++c) to[c * Layout::stride] = from[c * Layout::stride];
            screened.pairs[k] = to;
        }
    }

    FASTCCD_INLINE void copy_next()
    {
        Number* const block = copied_.group + to_copy_ % group_pairs * pair_coordinates;
        const std::size_t count = size_ - to_copy_ < block_pairs ? size_ - to_copy_ : block_pairs;
        if constexpr (is_interleaved) {
            const Place from = in_place_ + to_copy_ * pair_coordinates;
            prefetcher_.at_pairs(from, block_pairs);
            copy_interleaved(from, count, block);
        } else {
            prefetcher_.at_strided_block(first_ + to_copy_);
            pack_strided(pairs_, first_ + to_copy_, count, block);
        }
        to_copy_ += block_pairs;
    }

    static FASTCCD_INLINE CopiedPairs<Number>& copied_pairs(TileScratch& scratch)
    {
        if constexpr (holds_floats)
            return scratch.copied_floats;
        else
            return scratch.copied;
    }

    const PairView& pairs_;
    const std::size_t first_, size_;
    CopiedPairs<Number>& copied_;
    const Number* in_place_ = nullptr;  ///< The tile's first pair, if groups are not copied, but perhaps the last one.
    const Number* group_ = nullptr;     ///< The group's first pair.
    bool group_is_in_place_ = !is_copied;
    std::size_t to_copy_ = 0, group_end_ = 0;  ///< Of the group: the next pair to copy and the end.
    Prefetcher prefetcher_;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
