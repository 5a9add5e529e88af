// Blocks of 8 pairs in the native layout, from any layout a PairView can have.
#pragma once

#include <cstddef>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>
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

/// 8 pairs of indices: whole vertex records, transposed in registers.
template <PairKind kind, class Batch, bool contiguous>
FASTCCD_INLINE void gather_records(const IndexedSource& source, const std::int32_t* pairs, double* block)
{
    constexpr unsigned group = Lane<Batch>::transposed_records;
    for (unsigned lane = 0; lane < block_pairs; lane += group) {
        const double* records[4][group];
        for (unsigned k = 0; k < group; ++k) {
            std::size_t vertex[4];
            pair_vertices<kind, contiguous>(source, pairs + 2 * (lane + k), vertex);
            for (int point = 0; point < 4; ++point)
                records[point][k] = source.records + vertex[point] * vertex_record_size;
        }
        for (int point = 0; point < 4; ++point)
            Lane<Batch>::transpose_records(records[point], block + 3 * point * block_pairs + lane,
                                           block + (12 + 3 * point) * block_pairs + lane, block_pairs);
    }
}

/// Lanes past `count` repeat the last pair.
template <PairKind kind, class Batch>
FASTCCD_INLINE void gather_block(const IndexedSource& source, std::size_t first, std::size_t count, double* block)
{
    const std::int32_t* pairs = source.pairs + 2 * first;
    std::int32_t padded[2 * block_pairs];
    if (count < block_pairs) {
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            for (std::size_t k = 0; k < 2; ++k) padded[2 * lane + k] = pairs[2 * (lane < count ? lane : count - 1) + k];
        pairs = padded;
    }
    if (rows_are_contiguous<kind>(source))
        gather_records<kind, Batch, true>(source, pairs, block);
    else
        gather_records<kind, Batch, false>(source, pairs, block);
}

/// Blocks ahead of the one being read that are asked for: memory latency over the time one block takes.
inline constexpr std::size_t prefetch_blocks = 4;

FASTCCD_INLINE void prefetch_block(const double* block)
{
    for (std::size_t k = 0; k < block_coordinates; k += block_pairs)
        __builtin_prefetch(block + prefetch_blocks * block_coordinates + k);
}

/// Block that starts at pair `first` (a multiple of 8) and has `count` <= 8 pairs. Zero-copy for blocked
/// double; otherwise `scratch` is filled and returned.
template <PairKind kind, class Batch>
FASTCCD_INLINE const double* native_block(const PairSource& source, std::size_t first, std::size_t count, double* scratch)
{
    if (source.view == nullptr) {
        gather_block<kind, Batch>(source.indexed, first, count, scratch);
        return scratch;
    }
    const PairView& pairs = *source.view;
    const bool wide = pairs.scalar() == PairView::Scalar::float64;
    const std::size_t offset = first * pair_coordinates;
    switch (pairs.layout()) {
        case PairView::Layout::blocked:
            if (wide) {
                const double* block = static_cast<const double*>(pairs.data()) + offset;
                prefetch_block(block);
                return block;
            }
            widen_block(static_cast<const float*>(pairs.data()) + offset, scratch);
            break;
        case PairView::Layout::interleaved:
            if (wide)
                pack_interleaved(static_cast<const double*>(pairs.data()) + offset, count, scratch);
            else
                pack_interleaved(static_cast<const float*>(pairs.data()) + offset, count, scratch);
            break;
        case PairView::Layout::strided:
            if (wide)
                pack_strided<double>(pairs, first, count, scratch);
            else
                pack_strided<float>(pairs, first, count, scratch);
            break;
    }
    return scratch;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
