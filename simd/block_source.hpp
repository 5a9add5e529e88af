// Blocks of 8 pairs in the native layout, from any layout a PairView can have.
#pragma once

#include <cstddef>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>
#include <kernel_table.hpp>
#include <lane.hpp>
#include <pair_source.hpp>
#include <pair_vertices.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Transposes up to 8 records of 24 doubles into [24][8]; lanes past `count` repeat the last record.
template <class Batch>
FASTCCD_INLINE void pack_interleaved(const double* records, std::size_t count, double* block)
{
    constexpr std::size_t part = 6;  // what Lane::transpose_records takes
    for (std::size_t lane = 0; lane < block_pairs; lane += Lane<Batch>::transposed_records)
        for (std::size_t c = 0; c < pair_coordinates; c += part) {
            const double* parts[Lane<Batch>::transposed_records];
            for (std::size_t k = 0; k < Lane<Batch>::transposed_records; ++k)
                parts[k] = records + (lane + k < count ? lane + k : count - 1) * pair_coordinates + c;
            Lane<Batch>::transpose_records(parts, block + c * block_pairs + lane, block + (c + 3) * block_pairs + lane, block_pairs);
        }
}

/// The same for records of 24 floats; `wide` has room for 8 records.
template <class Batch>
FASTCCD_INLINE void pack_interleaved(const float* records, std::size_t count, double* wide, double* block)
{
    for (std::size_t k = 0; k < count * pair_coordinates; ++k) wide[k] = static_cast<double>(records[k]);
    pack_interleaved<Batch>(wide, count, block);
}

/// One coordinate of 8 pairs that follow one another. Without __restrict, which says that nothing stored here changes what is still to
/// be read, compilers move one number at a time.
template <class T>
FASTCCD_INLINE void copy_row(const T* __restrict data, double* __restrict row)
{
    for (std::size_t lane = 0; lane < block_pairs; ++lane) row[lane] = static_cast<double>(data[lane]);
}

template <class T>
FASTCCD_INLINE void pack_strided(const PairView& pairs, std::size_t first, std::size_t count, double* block)
{
    const std::ptrdiff_t stride = pairs.stride();
    for (std::size_t c = 0; c < pair_coordinates; ++c) {
        const T* const data = static_cast<const T*>(pairs.data(c)) + static_cast<std::ptrdiff_t>(first) * stride;
        double* const row = block + c * block_pairs;
        if (stride == 1 && count == block_pairs)
            copy_row(data, row);
        else
            for (std::size_t lane = 0; lane < block_pairs; ++lane)
                row[lane] = static_cast<double>(data[static_cast<std::ptrdiff_t>(lane < count ? lane : count - 1) * stride]);
    }
}

FASTCCD_INLINE void widen_block(const float* data, double* block)
{
    for (std::size_t k = 0; k < block_coordinates; ++k) block[k] = static_cast<double>(data[k]);
}

/// Finds the vertex records of 8 of the pairs at `pairs`, and asks for them.
template <PairKind kind, bool contiguous>
FASTCCD_INLINE void resolve_pairs(const IndexedSource& source, const std::int32_t* pairs, const std::uint16_t* listed,
                                  const double* (&records)[4][block_pairs])
{
    // A copy, because the compiler cannot know that nothing stored below changes the original.
    const IndexedSource local = source;
    for (std::size_t lane = 0; lane < block_pairs; ++lane) {
        std::size_t vertex[4];
        pair_vertices<kind, contiguous>(local, pairs + 2 * std::size_t{listed[lane]}, vertex);
        for (int point = 0; point < 4; ++point) {
            const double* const record = local.records + vertex[point] * vertex_record_size;
            __builtin_prefetch(record);
            records[point][lane] = record;
        }
    }
}

/// Lists the pairs of the tile that their boxes do not keep apart: all, if there are no boxes. Returns how many.
template <class Batch>
FASTCCD_INLINE std::size_t list_pairs(const TileRequest& tile, std::uint16_t* listed)
{
    const BoxScreen boxes = tile.source->indexed.boxes;
    const std::int32_t* const pairs = tile.source->indexed.pairs + 2 * tile.first;
    const std::size_t count = tile.count;
    std::size_t size = 0;
    if (boxes.first == nullptr) {
        for (; size < count; ++size) listed[size] = static_cast<std::uint16_t>(size);
    } else {
        const auto list = [&](std::size_t i) FASTCCD_INLINE_LAMBDA {
            const auto first = Lane<Batch>::first_box(boxes.first[pairs[2 * i]], boxes.separation);
            // Without a branch, which could not be foreseen.
            listed[size] = static_cast<std::uint16_t>(i);
            size += Lane<Batch>::apart(first, boxes.second[pairs[2 * i + 1]]) ? 0 : 1;
        };
        std::size_t i = 0;
#pragma GCC unroll 4
        for (; i + boxes_ahead < count; ++i) {
            __builtin_prefetch(&boxes.second[pairs[2 * (i + boxes_ahead) + 1]]);
            list(i);
        }
        for (; i < count; ++i) list(i);
    }
    if (size > 0)
        for (std::size_t k = 0; k < (indexed_ahead + 1) * block_pairs; ++k) listed[size + k] = listed[size - 1];
    return size;
}

/// Whole vertex records of 8 pairs, transposed in registers to [24][8].
template <class Batch>
FASTCCD_INLINE void transpose_block(const double* const (&records)[4][block_pairs], double* block)
{
    for (std::size_t lane = 0; lane < block_pairs; lane += Lane<Batch>::transposed_records)
        for (std::size_t point = 0; point < 4; ++point)
            Lane<Batch>::transpose_records(&records[point][lane], block + 3 * point * block_pairs + lane,
                                           block + (12 + 3 * point) * block_pairs + lane, block_pairs);
}

/// Asks for memory from one address to another, line by line, and returns where it stopped (a function without a result would be
/// taken for one without effect). Not inlined, and its loops not unrolled: lines that one and the same instruction asks for, in their
/// order, come faster, probably because the hardware's own prefetchers take them up. With two instructions in turn half as many
/// lines are under way (bench/LIMITS.md). Static, so that g++ sees which registers it leaves alone: all vectors.
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

/// Asks for packed pairs before they are read.
class Prefetcher {
public:
    FASTCCD_INLINE Prefetcher(const PairSource& source, std::size_t first, CacheLevel into)
        : into_{into}, most_ahead_{into == CacheLevel::second ? 2 * first_level_ahead : first_level_ahead}
    {
        if (source.view == nullptr) return;
        const PairView& pairs = *source.view;
        const std::size_t number = pairs.scalar() == PairView::Scalar::float64 ? sizeof(double) : sizeof(float);
        if (pairs.layout() == PairView::Layout::strided) {
            strided_ = &pairs;
            element_ = static_cast<std::ptrdiff_t>(number) * pairs.stride();
            last_ = static_cast<std::ptrdiff_t>(source.size) - 1;
            return;
        }
        const std::size_t pair = pair_coordinates * number, all = source.size * pair;
        if (all < most_ahead_) return;  // would be read before it came
        const auto data = reinterpret_cast<std::uintptr_t>(pairs.data());
        last_start_ = data + all - most_ahead_;
        next_ = data + first * pair;
        // About what memory delivers while a pair is screened; a half to five sixths make no difference (bench/LIMITS.md).
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
    /// The same for the layout `strided`, before the block that starts at pair `i` of the source.
    FASTCCD_INLINE void at_strided_block(std::size_t i)
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

    /// Between blocks, before something that takes about as long as memory takes for a block.
    FASTCCD_INLINE void meanwhile() { ask_until(next_ + block_bytes); }

private:
    static constexpr std::uintptr_t block_bytes = block_coordinates * sizeof(double);
    /// How far ahead of the block being read pairs are asked for, at most: 16 blocks of doubles, at least half of it. With more, lines
    /// leave the first-level cache again before they are read. In the second-level one there is room: 16 to 32 blocks, of which up
    /// to 64 are as good, and 8 take up to a tenth longer (bench/LIMITS.md).
    static constexpr std::uintptr_t first_level_ahead = 16 * block_bytes;

    /// A line of each of the 24 arrays, at these bytes of the x, y and z of a point.
    template <int locality>
    FASTCCD_INLINE void ask_for_rows(const std::ptrdiff_t (&offset)[3]) const
    {
#pragma GCC unroll 1
        for (std::size_t c = 0; c < pair_coordinates; c += 3)
            for (std::size_t axis = 0; axis < 3; ++axis)
                __builtin_prefetch(static_cast<const std::byte*>(strided_->data(c + axis)) + offset[axis], 0, locality);
    }

    FASTCCD_INLINE void ask_until(std::uintptr_t until) { next_ = ask_for(next_, until < limit_ ? until : limit_, into_); }

    // Addresses. As they stand here, for sources not asked for, next_ is never less than what at_pairs() would ask up to.
    const CacheLevel into_;
    const std::uintptr_t most_ahead_;  ///< Bytes; at least half as many are asked for before they are read.
    std::uintptr_t next_ = most_ahead_, limit_ = 0;
    std::uintptr_t last_start_ = 0;  ///< most_ahead_ before the end.
    std::uintptr_t rate_ = 0;        ///< Bytes a pair.
    const PairView* strided_ = nullptr;
    std::ptrdiff_t element_ = 0, last_ = 0;  ///< Bytes from a pair's coordinate to the next one's; the last pair.
};

/// What the stages read of a tile: its pairs in blocks of the native layout; of indexed pairs those alone that their boxes do
/// not keep apart.
template <PairKind kind, class Batch>
class BlockSource {
public:
    FASTCCD_INLINE BlockSource(const TileRequest& tile, TileScratch& scratch)
        : tile_{tile}, scratch_{scratch}, indexed_{tile.source->view == nullptr},
          size_{indexed_ ? list_pairs<Batch>(tile, scratch.listed) : tile.count},
          prefetcher_{*tile.source, tile.first, tile.preferences.into}
    {
        if (indexed_) {
            if (size_ == 0) return;
            for (std::size_t i = 0; i < indexed_ahead * block_pairs; i += block_pairs) resolve(i);
        } else if (const PairView& pairs = *tile.source->view;
                   pairs.layout() == PairView::Layout::blocked && pairs.scalar() == PairView::Scalar::float64) {
            in_place_ = static_cast<const double*>(pairs.data()) + tile.first * pair_coordinates;
        }
    }

    [[nodiscard]] FASTCCD_INLINE std::size_t size() const { return size_; }

    /// Number in the tile of pair `i` of this source, and of the pairs from `i` on, in the group read last.
    [[nodiscard]] FASTCCD_INLINE std::size_t number(std::size_t i) const { return indexed_ ? scratch_.listed[i] : i; }
    [[nodiscard]] FASTCCD_INLINE Batch numbers(std::size_t i) const
    {
        return indexed_ ? Lane<Batch>::load(&scratch_.numbers[i % group_pairs])
                        : broadcast<Batch>(static_cast<double>(i)) + Lane<Batch>::lane_number();
    }

    /// Where the blocks of the group that starts at pair `i`, a multiple of group_pairs, lie one after another; the last pair stands for
    /// those past the end. Groups are to be read in order, and at_block() to be called before each block.
    FASTCCD_INLINE const double* group(std::size_t i)
    {
        if (is_in_place()) return in_place_ + i * pair_coordinates;
        to_copy_ = i;
        group_end_ = size_ - i < group_pairs ? size_ : i + group_pairs;
        copy_next();
        return scratch_.blocks[0];
    }

    /// Before a block of the group is read. The one after it is copied then, so that memory is asked at an even rate, and nothing is
    /// read right after it was written: with a whole group copied first, strided pairs took a sixth longer (bench/LIMITS.md).
    FASTCCD_INLINE void at_block()
    {
        if (to_copy_ < group_end_) copy_next();
    }

    /// Blocks are not copied and stay where they are; otherwise the next group takes the place of the last one.
    [[nodiscard]] FASTCCD_INLINE bool is_in_place() const { return in_place_ != nullptr; }

    /// Where all blocks of the tile lie, or those of the group.
    [[nodiscard]] FASTCCD_INLINE const double* blocks() const { return is_in_place() ? in_place_ : scratch_.blocks[0]; }

    /// Once for every batch of a block of the group, before it is read or soon after. Batch by batch, although 8 blocks lie between what is
    /// asked for and what is read: with four lanes, at a block's start for both of its batches, scenes took 3 to 5 % longer on AMD's family
    /// 25 (bench/LIMITS.md).
    FASTCCD_INLINE void at_batch(const double* block)
    {
        if (is_in_place()) prefetcher_.at_pairs(block, Lane<Batch>::width);
    }
    /// Before a batch of a later stage.
    FASTCCD_INLINE void meanwhile() { prefetcher_.meanwhile(); }

private:
    FASTCCD_INLINE void copy_next()
    {
        double* const block = scratch_.blocks[to_copy_ % group_pairs / block_pairs];
        if (indexed_)
            transpose(to_copy_, block);
        else
            pack(to_copy_, block);
        to_copy_ += block_pairs;
    }

    FASTCCD_INLINE auto& records(std::size_t i) { return scratch_.records[i / block_pairs % (indexed_ahead + 1)]; }

    FASTCCD_INLINE void resolve(std::size_t i)
    {
        const IndexedSource& source = tile_.source->indexed;
        const std::int32_t* const pairs = source.pairs + 2 * tile_.first;
        if (rows_are_contiguous<kind>(source))
            resolve_pairs<kind, true>(source, pairs, scratch_.listed + i, records(i));
        else
            resolve_pairs<kind, false>(source, pairs, scratch_.listed + i, records(i));
    }

    FASTCCD_INLINE void transpose(std::size_t i, double* block)
    {
        resolve(i + indexed_ahead * block_pairs);
        transpose_block<Batch>(records(i), block);
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            scratch_.numbers[i % group_pairs + lane] = static_cast<double>(scratch_.listed[i + lane]);
    }

    FASTCCD_INLINE void pack(std::size_t i, double* block)
    {
        const PairView& pairs = *tile_.source->view;
        const std::size_t first = tile_.first + i;
        const std::size_t count = size_ - i < block_pairs ? size_ - i : block_pairs;
        const bool wide = pairs.scalar() == PairView::Scalar::float64, strided = pairs.layout() == PairView::Layout::strided;
        const std::size_t offset = strided ? 0 : first * pair_coordinates;
        const auto* const doubles = wide ? static_cast<const double*>(pairs.data()) + offset : nullptr;
        const auto* const floats = wide ? nullptr : static_cast<const float*>(pairs.data()) + offset;
        if (strided)
            prefetcher_.at_strided_block(first);
        else
            prefetcher_.at_pairs(wide ? static_cast<const void*>(doubles) : floats, block_pairs);
        switch (pairs.layout()) {
            case PairView::Layout::blocked:  // of floats
                widen_block(floats, block);
                break;
            case PairView::Layout::interleaved:
                if (wide)
                    pack_interleaved<Batch>(doubles, count, block);
                else
                    pack_interleaved<Batch>(floats, count, scratch_.wide, block);
                break;
            case PairView::Layout::strided:
                if (wide)
                    pack_strided<double>(pairs, first, count, block);
                else
                    pack_strided<float>(pairs, first, count, block);
                break;
        }
    }

    const TileRequest& tile_;
    TileScratch& scratch_;
    const bool indexed_;
    const std::size_t size_;
    const double* in_place_ = nullptr;         ///< The tile's first block, if blocks are not copied.
    std::size_t to_copy_ = 0, group_end_ = 0;  ///< Of the group: the next pair to copy and the end.
    Prefetcher prefetcher_;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
