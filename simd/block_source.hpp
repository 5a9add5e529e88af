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

/// Vertex indices of one pair, x0..x3.
template <PairKind kind>
FASTCCD_INLINE void pair_vertices(const IndexedSource& source, std::size_t pair, std::size_t (&vertex)[4])
{
    const auto of = [&](std::int32_t primitive, int corner) FASTCCD_INLINE_LAMBDA {
        return static_cast<std::size_t>(source.primitives[primitive * source.row_stride + corner * source.column_stride]);
    };
    const std::int32_t first = source.pairs[2 * pair], second = source.pairs[2 * pair + 1];
    if constexpr (kind == PairKind::vertex_face) {
        vertex[0] = static_cast<std::size_t>(first);
        vertex[1] = of(second, 0);
        vertex[2] = of(second, 1);
        vertex[3] = of(second, 2);
    } else {
        vertex[0] = of(first, 0);
        vertex[1] = of(first, 1);
        vertex[2] = of(second, 0);
        vertex[3] = of(second, 1);
    }
}

/// Whole vertex records, transposed in registers. Lanes past `count` repeat the last pair.
template <PairKind kind, class Batch>
FASTCCD_INLINE void gather_block(const IndexedSource& source, std::size_t first, std::size_t count, double* block)
{
    constexpr unsigned group = Lane<Batch>::transposed_records;
    constexpr std::size_t record_size = 8;
    for (unsigned lane = 0; lane < block_pairs; lane += group) {
        const double* records[4][group];
        for (unsigned k = 0; k < group; ++k) {
            const std::size_t i = lane + k < count ? lane + k : count - 1;
            std::size_t vertex[4];
            pair_vertices<kind>(source, first + i, vertex);
            for (int point = 0; point < 4; ++point) records[point][k] = source.records + vertex[point] * record_size;
        }
        for (int point = 0; point < 4; ++point)
            Lane<Batch>::transpose_records(records[point], block + 3 * point * block_pairs + lane,
                                           block + (12 + 3 * point) * block_pairs + lane, block_pairs);
    }
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
