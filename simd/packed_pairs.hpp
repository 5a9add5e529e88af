// Packed pairs as screening reads them in place, doubles or floats: in blocks of the native layout or interleaved. Strided ones: strided_pairs.hpp.
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
    static constexpr bool in_whole_blocks = true;

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

/// 24 coordinates a pair, one pair after the other. They are transposed in registers each time they are read: copied to blocks first, a pair
/// took 3 ns longer with AVX2 and AVX-512, of which a third is storing it (bench/LIMITS.md).
struct Interleaved {
    static constexpr bool in_whole_blocks = false;

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

/// How stages read pairs of numbers of this type in this layout, wherever their first coordinate lies.
template <class L, class Layout, class Number>
struct PairReader {
    static constexpr bool holds_floats = std::is_same_v<Number, float>;
    /// Where the first coordinate of a pair lies, and by its layout the others, and the pairs that follow in a block of 8.
    using Place = const Number*;

    /// Number in the tile of pair `i`.
    [[nodiscard]] static FASTCCD_INLINE std::size_t number(std::size_t i) { return i; }
    [[nodiscard]] static FASTCCD_INLINE L numbers(std::size_t i) { return broadcast<L>(static_cast<double>(i)) + Lane<L>::lane_number(); }

    /// Coordinates, lane by lane, of the pair there and those after it.
    static FASTCCD_INLINE auto coordinates(Place place) { return Layout::template coordinates<L>(place); }
    /// Of floats: of both parts of a batch of S, without widening them.
    template <class S>
    static FASTCCD_INLINE auto coordinates_in_single(const Place (&parts)[2])
    {
        return Layout::template in_single<S>(parts[0], parts[1]);
    }
    /// Coordinates of the `count` pairs after the last one in [screened]; if they lie in blocks, with one at `near` (Lane::Collector).
    static FASTCCD_INLINE auto collected_near(Place near, ScreenedQueue& screened, unsigned count)
    {
        const void** const pairs = screened.pairs + screened.size;
        for (unsigned lane = count; lane < Lane<L>::width; ++lane) pairs[lane] = pairs[count - 1];
        return Layout::template collected<L>(near, pairs);
    }
};

template <class Number>
FASTCCD_INLINE CopiedPairs<Number>& copied_pairs(TileScratch& scratch)
{
    if constexpr (std::is_same_v<Number, float>)
        return scratch.copied_floats;
    else
        return scratch.copied;
}

/// The pairs that a tile of interleaved pairs has past its last whole block of 8, to be read as one: the last of them stands for those missing.
template <class Number>
FASTCCD_INLINE void copy_rest(const Number* __restrict pairs, std::size_t count, Number* __restrict block)
{
    for (std::size_t k = 0; k < count * pair_coordinates; ++k) block[k] = pairs[k];
    for (std::size_t k = count * pair_coordinates; k < block_coordinates; ++k) block[k] = block[k - pair_coordinates];
}

/// What the stages read of a tile of packed pairs, where they lie. Buffers in blocks are filled up to a whole one; of interleaved pairs those past
/// the last whole block of the tile are copied.
template <class L, class Layout, class Number>
class PackedPairs : public PairReader<L, Layout, Number> {
public:
    using typename PairReader<L, Layout, Number>::Place;
    static constexpr bool asks_ahead = true;

    FASTCCD_INLINE PackedPairs(const TileRequest& tile, TileScratch& scratch)
        : first_{static_cast<Place>(tile.source->view->data()) + tile.first * pair_coordinates}, size_{tile.count},
          rest_{copied_pairs<Number>(scratch).block}, prefetcher_{*tile.source, tile.first, tile.preferences.into}
    {
        if constexpr (!Layout::in_whole_blocks)
            if (whole_blocks() < size_) copy_rest(Layout::pair(first_, whole_blocks()), size_ - whole_blocks(), rest_);
    }

    [[nodiscard]] FASTCCD_INLINE std::size_t size() const { return size_; }

    /// Before pairs from `i` on, a multiple of group_pairs, are read. Groups are begun in order.
    FASTCCD_INLINE void begin_group(std::size_t /*i*/) {}
    /// Before the 8 pairs from `i` on, of the group, are read.
    FASTCCD_INLINE void begin_block(std::size_t /*i*/) {}
    /// Of a pair of the group. What is read past the tile's last pair, up to a multiple of 8, may be anything.
    [[nodiscard]] FASTCCD_INLINE Place place(std::size_t i) const
    {
        if constexpr (!Layout::in_whole_blocks)
            if (i >= whole_blocks()) return Layout::pair(rest_, i - whole_blocks());
        return Layout::pair(first_, i);
    }

    /// About when a batch of L is read. Batch by batch, although 8 blocks lie between what is asked for and what is read: with four lanes, at a
    /// block's start for both of its batches, scenes took 3 to 5 % longer on AMD's family 25 (bench/LIMITS.md). At pairs that were copied, the
    /// last ones of the source, no more is asked for than is left of it.
    FASTCCD_INLINE void ask_ahead(Place batch) { prefetcher_.at_pairs(batch, Lane<L>::width); }
    /// Before a batch of a later stage.
    FASTCCD_INLINE void meanwhile() { prefetcher_.meanwhile(); }

    /// For the pair at `k` in [screened], which is pair `i`.
    FASTCCD_INLINE void keep_place(ScreenedQueue& screened, unsigned k, std::size_t i) const { screened.pairs[k] = place(i); }
    /// Coordinates of the `count` pairs after the last one in [screened].
    FASTCCD_INLINE auto collected(ScreenedQueue& screened, unsigned count) const { return this->collected_near(first_, screened, count); }
    /// Before the next group is begun. Less than a batch is left in [screened].
    FASTCCD_INLINE void end_group(ScreenedQueue&) {}

private:
    [[nodiscard]] FASTCCD_INLINE std::size_t whole_blocks() const { return size_ / block_pairs * block_pairs; }

    const Place first_;
    const std::size_t size_;
    Number* const rest_;
    Prefetcher prefetcher_;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
