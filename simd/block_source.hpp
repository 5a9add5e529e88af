// Blocks of 8 pairs in the native layout, from any layout a PairView can have.
#pragma once

#include <cstddef>

#include <fastccd/pair_view.hpp>
#include <lane.hpp>

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

/// Block that starts at pair `first` (a multiple of 8) and has `count` <= 8 pairs. Zero-copy for blocked
/// double; otherwise `scratch` is filled and returned.
FASTCCD_INLINE const double* native_block(const PairView& pairs, std::size_t first, std::size_t count, double* scratch)
{
    const bool wide = pairs.scalar() == PairView::Scalar::float64;
    const std::size_t offset = first * pair_coordinates;
    switch (pairs.layout()) {
        case PairView::Layout::blocked:
            if (wide) return static_cast<const double*>(pairs.data()) + offset;
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
