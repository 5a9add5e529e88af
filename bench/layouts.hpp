// Copies of packed pairs in every layout that a PairView can have.
#pragma once

#include <cstddef>

#include <fastccd/aligned_doubles.hpp>
#include <fastccd/pair_buffer.hpp>
#include <fastccd/pair_view.hpp>

namespace fastccd::bench {

/// Memory that a pass over the pairs reads: `count` arrays of `bytes` each, side by side from front to back.
/// Blocked and interleaved pairs are one array, strided ones 24.
struct Streams {
    const std::byte* data = nullptr;  ///< 64-byte aligned.
    std::size_t count = 0;
    std::size_t bytes = 0;  ///< Of one array; a multiple of 64, which is also where the next one begins.
};

/// Pairs in one layout, double or float. Refers to `packed` itself where that is the layout. To float
/// coordinates are rounded; the mesh frames of most public scenes are float in the first place.
class LayoutCopy {
public:
    LayoutCopy(const PairBuffer& packed, PairView::Layout layout, PairView::Scalar scalar);

    [[nodiscard]] const PairView& view() const noexcept { return view_; }
    [[nodiscard]] const Streams& streams() const noexcept { return streams_; }

private:
    template <class T>
    void fill(const PairBuffer& packed, PairView::Layout layout);

    AlignedDoubles storage_;  ///< Of doubles or floats; null if the view is of `packed`.
    PairView view_;
    Streams streams_;
};

}  // namespace fastccd::bench
