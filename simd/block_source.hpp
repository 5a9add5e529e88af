// Blocks of 8 pairs in the native layout, from any layout a PairView can have.
#pragma once

#include <cstddef>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>
#include <kernel_table.hpp>
#include <lane.hpp>
#include <pair_source.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Copies up to 8 records into [24][8]; lanes past `count` repeat the last record.
template <class T>
FASTCCD_INLINE void pack_interleaved(const T* records, std::size_t count, double* block)
{
    for (std::size_t lane = 0; lane < block_pairs; ++lane) {
        const T* record = records + (lane < count ? lane : count - 1) * pair_coordinates;
        for (std::size_t c = 0; c < pair_coordinates; ++c) block[c * block_pairs + lane] = static_cast<double>(record[c]);
    }
}

template <class T>
FASTCCD_INLINE void pack_strided(const PairView& pairs, std::size_t first, std::size_t count, double* block)
{
    for (std::size_t c = 0; c < pair_coordinates; ++c) {
        const T* data = static_cast<const T*>(pairs.data(c)) + static_cast<std::ptrdiff_t>(first) * pairs.stride();
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            block[c * block_pairs + lane] =
                static_cast<double>(data[static_cast<std::ptrdiff_t>(lane < count ? lane : count - 1) * pairs.stride()]);
    }
}

FASTCCD_INLINE void widen_block(const float* data, double* block)
{
    for (std::size_t k = 0; k < block_coordinates; ++k) block[k] = static_cast<double>(data[k]);
}

/// Vertex indices x0..x3 of one pair {first, second}. `contiguous`: rows follow one another without gaps.
template <PairKind kind, bool contiguous>
FASTCCD_INLINE void pair_vertices(const IndexedSource& source, const std::int32_t* pair, std::size_t (&vertex)[4])
{
    constexpr std::ptrdiff_t columns = kind == PairKind::vertex_face ? 3 : 2;
    const auto of = [&](std::int32_t primitive, int corner) FASTCCD_INLINE_LAMBDA {
        const std::ptrdiff_t at = contiguous ? primitive * columns + corner
                                             : primitive * source.row_stride + corner * source.column_stride;
        return static_cast<std::size_t>(source.primitives[at]);
    };
    if constexpr (kind == PairKind::vertex_face) {
        vertex[0] = static_cast<std::size_t>(pair[0]);
        vertex[1] = of(pair[1], 0);
        vertex[2] = of(pair[1], 1);
        vertex[3] = of(pair[1], 2);
    } else {
        vertex[0] = of(pair[0], 0);
        vertex[1] = of(pair[0], 1);
        vertex[2] = of(pair[1], 0);
        vertex[3] = of(pair[1], 1);
    }
}

template <PairKind kind>
FASTCCD_INLINE bool rows_are_contiguous(const IndexedSource& source)
{
    return source.column_stride == 1 && source.row_stride == (kind == PairKind::vertex_face ? 3 : 2);
}

inline constexpr std::size_t vertex_record_size = 8;

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

/// Whole vertex records, transposed in registers.
template <class Batch>
FASTCCD_INLINE void transpose_block(const double* const (&records)[4][block_pairs], double* block)
{
    for (unsigned lane = 0; lane < block_pairs; lane += Lane<Batch>::transposed_records)
        for (std::size_t point = 0; point < 4; ++point)
            Lane<Batch>::transpose_records(&records[point][lane], block + 3 * point * block_pairs + lane,
                                           block + (12 + 3 * point) * block_pairs + lane, block_pairs);
}

/// Asks for packed pairs ahead of the one being read. Reading alone would ask in bursts, and a core has few requests under way
/// at once; so the later stages, which read nothing, ask as well, further ahead. Distances as measured: cloth-ball 8.0 ns a pair with
/// these, 9.3 asking for the second-level cache alone, 8.5 to 9 with twice the distances.
class Prefetcher {
public:
    /// `prefetched` is where the tile before this one has got to.
    FASTCCD_INLINE Prefetcher(const PairSource& source, std::size_t first, const double* prefetched)
    {
        const bool native = source.view != nullptr && source.view->layout() == PairView::Layout::blocked &&
                            source.view->scalar() == PairView::Scalar::float64;
        if (!native) return;
        const double* const data = static_cast<const double*>(source.view->data());
        end_ = data + (source.size + block_pairs - 1) / block_pairs * block_coordinates;
        next_ = data + first * pair_coordinates;
        limit_ = next_;
        if (next_ <= prefetched && prefetched <= ahead(most_blocks)) next_ = prefetched;
    }

    /// Before the block at `block` is read.
    FASTCCD_INLINE void at_block(const double* block)
    {
        if (end_ == nullptr) return;
        limit_ = block;
        const double* const least = ahead(least_blocks);
        const double* next = next_;
        for (; next < least; next += line) __builtin_prefetch(next, 0, locality);
        next_ = next;
        limit_ = ahead(most_blocks);
    }

    /// While other work is being done.
    FASTCCD_INLINE void lines(unsigned count)
    {
        if (next_ >= limit_) return;
        for (unsigned k = 0; k < count; ++k) __builtin_prefetch(next_ + k * line, 0, locality);
        next_ += count * line;
    }

    [[nodiscard]] FASTCCD_INLINE const double* prefetched() const { return next_; }

private:
    static constexpr std::size_t line = 8;
    static constexpr int locality = 3;  ///< First-level cache.
    static constexpr std::size_t least_blocks = 8, most_blocks = 16;

    FASTCCD_INLINE const double* ahead(std::size_t blocks) const
    {
        return static_cast<std::size_t>(end_ - limit_) > blocks * block_coordinates ? limit_ + blocks * block_coordinates : end_;
    }

    const double* next_ = nullptr;
    const double* limit_ = nullptr;
    const double* end_ = nullptr;
};

/// What the stages read of a tile: its pairs in blocks of the native layout; of indexed pairs those alone that their boxes do
/// not keep apart.
template <PairKind kind, class Batch>
class BlockSource {
public:
    FASTCCD_INLINE BlockSource(const TileRequest& tile, TileScratch& scratch)
        : tile_{tile}, scratch_{scratch}, indexed_{tile.source->view == nullptr},
          size_{indexed_ ? list_pairs<Batch>(tile, scratch.listed) : tile.count},
          prefetcher{*tile.source, tile.first, scratch.prefetched}
    {
        if (!indexed_ || size_ == 0) return;
        for (std::size_t i = 0; i < indexed_ahead * block_pairs; i += block_pairs) resolve(i);
    }

    [[nodiscard]] FASTCCD_INLINE std::size_t size() const { return size_; }

    /// Number in the tile of pair `i` of this source, and of the pairs from `i` on, in the block read last.
    [[nodiscard]] FASTCCD_INLINE std::size_t number(std::size_t i) const { return indexed_ ? scratch_.listed[i] : i; }
    [[nodiscard]] FASTCCD_INLINE Batch numbers(std::size_t i) const
    {
        return indexed_ ? Lane<Batch>::load(&scratch_.numbers[i % group_pairs])
                        : broadcast<Batch>(static_cast<double>(i)) + Lane<Batch>::lane_number();
    }

    /// The block that starts at pair `i`, a multiple of 8; the last pair stands for those past the end. Zero-copy for blocked
    /// double; otherwise one of scratch.blocks is filled and returned. Blocks are to be read in order.
    FASTCCD_INLINE const double* block(std::size_t i)
    {
        const double* const found = indexed_ ? transposed(i) : native(i);
        prefetcher.at_block(found);
        return found;
    }

private:
    FASTCCD_INLINE double* filled(std::size_t i) { return scratch_.blocks[i / block_pairs % (group_pairs / block_pairs)]; }
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

    FASTCCD_INLINE const double* transposed(std::size_t i)
    {
        resolve(i + indexed_ahead * block_pairs);
        transpose_block<Batch>(records(i), filled(i));
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            scratch_.numbers[i % group_pairs + lane] = static_cast<double>(scratch_.listed[i + lane]);
        return filled(i);
    }

    FASTCCD_INLINE const double* native(std::size_t i)
    {
        const PairView& pairs = *tile_.source->view;
        const std::size_t first = tile_.first + i, offset = first * pair_coordinates;
        const std::size_t count = size_ - i < block_pairs ? size_ - i : block_pairs;
        const bool wide = pairs.scalar() == PairView::Scalar::float64;
        double* const block = filled(i);
        switch (pairs.layout()) {
            case PairView::Layout::blocked:
                if (wide) return static_cast<const double*>(pairs.data()) + offset;
                widen_block(static_cast<const float*>(pairs.data()) + offset, block);
                break;
            case PairView::Layout::interleaved:
                if (wide)
                    pack_interleaved(static_cast<const double*>(pairs.data()) + offset, count, block);
                else
                    pack_interleaved(static_cast<const float*>(pairs.data()) + offset, count, block);
                break;
            case PairView::Layout::strided:
                if (wide)
                    pack_strided<double>(pairs, first, count, block);
                else
                    pack_strided<float>(pairs, first, count, block);
                break;
        }
        return block;
    }

    const TileRequest& tile_;
    TileScratch& scratch_;
    const bool indexed_;
    const std::size_t size_;

public:
    Prefetcher prefetcher;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
