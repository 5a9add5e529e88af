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

/// Finds the vertex records of the 8 pairs at `pairs`, and asks for them.
template <PairKind kind, bool contiguous>
FASTCCD_INLINE void resolve_pairs(const IndexedSource& source, const std::int32_t* pairs, const double* (&records)[4][block_pairs])
{
    // A copy, because the compiler cannot know that nothing stored below changes the original.
    const IndexedSource local = source;
    for (std::size_t lane = 0; lane < block_pairs; ++lane) {
        std::size_t vertex[4];
        pair_vertices<kind, contiguous>(local, pairs + 2 * lane, vertex);
        for (int point = 0; point < 4; ++point) {
            const double* const record = local.records + vertex[point] * vertex_record_size;
            __builtin_prefetch(record);
            records[point][lane] = record;
        }
    }
}

/// The same for the block that starts at pair `first`; the last pair stands for those past the end.
template <PairKind kind>
FASTCCD_INLINE void resolve_block(const PairSource& pairs, std::size_t first, const double* (&records)[4][block_pairs])
{
    const std::int32_t* ids = pairs.indexed.pairs + 2 * first;
    std::int32_t padded[2 * block_pairs];
    if (pairs.size < first + block_pairs) {
        for (std::size_t lane = 0; lane < block_pairs; ++lane) {
            const std::size_t pair = first + lane < pairs.size ? first + lane : pairs.size - 1;
            for (std::size_t k = 0; k < 2; ++k) padded[2 * lane + k] = pairs.indexed.pairs[2 * pair + k];
        }
        ids = padded;
    }
    if (rows_are_contiguous<kind>(pairs.indexed))
        resolve_pairs<kind, true>(pairs.indexed, ids, records);
    else
        resolve_pairs<kind, false>(pairs.indexed, ids, records);
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

/// Block that starts at pair `first` (a multiple of 8) and has `count` <= 8 pairs. Zero-copy for blocked
/// double; otherwise one of scratch.blocks is filled and returned.
template <PairKind kind, class Batch>
FASTCCD_INLINE const double* native_block(const TileRequest& tile, std::size_t i, std::size_t count, TileScratch& scratch)
{
    const PairSource& source = *tile.source;
    const std::size_t first = tile.first + i;
    double* const block = scratch.blocks[i / block_pairs % (group_pairs / block_pairs)];
    if (source.view == nullptr) {
        const auto records_of = [&](std::size_t j) FASTCCD_INLINE_LAMBDA -> auto& {
            return scratch.records[j / block_pairs % (indexed_ahead + 1)];
        };
        if (i == 0)
            for (std::size_t j = 0; j < indexed_ahead * block_pairs; j += block_pairs)
                resolve_block<kind>(source, first + j, records_of(j));
        resolve_block<kind>(source, first + indexed_ahead * block_pairs, records_of(i + indexed_ahead * block_pairs));
        transpose_block<Batch>(records_of(i), block);
        return block;
    }
    const PairView& pairs = *source.view;
    const bool wide = pairs.scalar() == PairView::Scalar::float64;
    const std::size_t offset = first * pair_coordinates;
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

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
