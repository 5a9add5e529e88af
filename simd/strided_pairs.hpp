// Strided packed pairs as screening reads them: copied to blocks of the native layout. A source of their own: pairs that are read in place took up to
// a tenth longer where the code was also there to copy them (bench/LIMITS.md).
#pragma once

#include <cstddef>

#include <fastccd/pair_view.hpp>
#include <kernel_table.hpp>
#include <lane.hpp>
#include <packed_pairs.hpp>
#include <prefetcher.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

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

/// What the stages read of a tile of strided pairs. See PackedPairs for what its functions are for.
template <class L, class Number>
class StridedPairs : public PairReader<L, InBlocks, Number> {
public:
    using typename PairReader<L, InBlocks, Number>::Place;
    static constexpr bool asks_ahead = false;  ///< But when they are copied.

    FASTCCD_INLINE StridedPairs(const TileRequest& tile, TileScratch& scratch)
        : pairs_{*tile.source->view}, first_{tile.first}, size_{tile.count}, copied_{copied_pairs<Number>(scratch)},
          prefetcher_{*tile.source, tile.preferences.into}
    {
    }

    [[nodiscard]] FASTCCD_INLINE std::size_t size() const { return size_; }

    FASTCCD_INLINE void begin_group(std::size_t i)
    {
        to_copy_ = i;
        group_end_ = size_ - i < group_pairs ? size_ : i + group_pairs;
        copy_next();
    }
    /// The 8 pairs after those from `i` on are copied now, so that memory is asked at an even rate, and nothing is read right after it was
    /// written: with a whole group copied first, strided pairs took a sixth longer (bench/LIMITS.md).
    FASTCCD_INLINE void begin_block(std::size_t /*i*/)
    {
        if (to_copy_ < group_end_) copy_next();
    }
    [[nodiscard]] FASTCCD_INLINE Place place(std::size_t i) const { return InBlocks::pair(copied_.group, i % group_pairs); }

    FASTCCD_INLINE void meanwhile() {}

    FASTCCD_INLINE void keep_place(ScreenedQueue& screened, unsigned k, std::size_t i) const { screened.pairs[k] = place(i); }
    FASTCCD_INLINE auto collected(ScreenedQueue& screened, unsigned count) const { return this->collected_near(copied_.group, screened, count); }
    /// Copies what is left in [screened], less than a batch, as the next group takes the place of this one.
    FASTCCD_INLINE void end_group(ScreenedQueue& screened)
    {
        for (unsigned k = 0; k < screened.size; ++k) {
            Number* const to = InBlocks::pair(copied_.block, k);
            const auto* const from = static_cast<Place>(screened.pairs[k]);
            if (from == to) continue;
            for (std::size_t c = 0; c < pair_coordinates; ++c) to[c * InBlocks::stride] = from[c * InBlocks::stride];
            screened.pairs[k] = to;
        }
    }

private:
    FASTCCD_INLINE void copy_next()
    {
        const std::size_t left = size_ - to_copy_;
        prefetcher_.at_block(first_ + to_copy_);
        pack_strided(pairs_, first_ + to_copy_, left < block_pairs ? left : block_pairs, copied_.group + to_copy_ % group_pairs * pair_coordinates);
        to_copy_ += block_pairs;
    }

    const PairView& pairs_;
    const std::size_t first_, size_;
    CopiedPairs<Number>& copied_;
    std::size_t to_copy_ = 0, group_end_ = 0;  ///< Of the group: the next pair to copy and the end.
    StridedPrefetcher prefetcher_;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
