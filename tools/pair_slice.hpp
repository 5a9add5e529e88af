// Parts of a PairView.
#pragma once

#include <cassert>
#include <cstddef>

#include <fastccd/pair_buffer.hpp>
#include <fastccd/pair_view.hpp>

namespace fastccd::tools {

/// Bytes of one pair, whatever the layout.
[[nodiscard]] inline std::size_t pair_bytes(const PairView& view) noexcept
{
    return pair_coordinates * (view.scalar() == PairView::Scalar::float64 ? sizeof(double) : sizeof(float));
}

/// Pairs [begin, end) of a blocked or interleaved view, without copying. `begin` of a blocked view is
/// a multiple of 8: use copy_pairs for what lies before the first such index.
[[nodiscard]] inline PairView slice(const PairView& view, std::size_t begin, std::size_t end) noexcept
{
    assert(begin <= end && end <= view.size() && view.layout() != PairView::Layout::strided);
    assert(view.layout() == PairView::Layout::interleaved || begin % block_pairs == 0);
    const bool blocked = view.layout() == PairView::Layout::blocked;
    const auto part = [&](const auto* data) {
        const auto* const first = data + begin * pair_coordinates;  // blocks hold 24 numbers a pair too
        return blocked ? PairView::blocked(first, end - begin) : PairView::interleaved(first, end - begin);
    };
    return view.scalar() == PairView::Scalar::float64 ? part(static_cast<const double*>(view.data()))
                                                      : part(static_cast<const float*>(view.data()));
}

/// Coordinate c of pair i of a blocked or interleaved view.
[[nodiscard]] inline double coordinate(const PairView& view, std::size_t i, std::size_t c) noexcept
{
    assert(i < view.size() && c < pair_coordinates && view.layout() != PairView::Layout::strided);
    const std::size_t index = view.layout() == PairView::Layout::blocked ? blocked_index(i, c) : i * pair_coordinates + c;
    return view.scalar() == PairView::Scalar::float64
               ? static_cast<const double*>(view.data())[index]
               : static_cast<double>(static_cast<const float*>(view.data())[index]);
}

/// A copy of pairs [begin, end) of a blocked or interleaved view.
[[nodiscard]] inline PairBuffer copy_pairs(const PairView& view, std::size_t begin, std::size_t end)
{
    PairBuffer copy{end - begin};
    for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t c = 0; c < pair_coordinates; ++c) copy.at(i - begin, c) = coordinate(view, i, c);
    }
    return copy;
}

}  // namespace fastccd::tools
