// Non-owning views of bulk pair buffers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fastccd {

/// Pairs per block of the native layout.
inline constexpr std::size_t block_pairs = 8;
/// Coordinates per pair: 4 points x 3 axes x 2 ends of the step. Coordinate
/// c = 12 * end + 3 * point + axis, that is x0 x1 x2 x3 at t = 0, then at t = 1.
inline constexpr std::size_t pair_coordinates = 24;
inline constexpr std::size_t block_coordinates = pair_coordinates * block_pairs;

/// Where the native layout has coordinate c of pair i.
[[nodiscard]] constexpr std::size_t blocked_index(std::size_t i, std::size_t c) noexcept
{
    return i / block_pairs * block_coordinates + c * block_pairs + i % block_pairs;
}

/// Where the coordinates of `size` pairs lie. Nothing is copied or owned; the memory must
/// stay valid and unchanged during a call. float coordinates are widened exactly. Any alignment
/// of the coordinates' type will do; blocks that begin cache lines, as in PairBuffer, are fastest.
class PairView {
public:
    enum class Layout : std::uint8_t {
        blocked,      ///< Blocks [24 coordinates][8 lanes]: the native, fastest layout.
        interleaved,  ///< Records of 24 coordinates, (N,8,3) in numpy's terms; nearly as fast.
        strided,      ///< 24 arrays, element i of an array at i * stride.
    };
    enum class Scalar : std::uint8_t { float64, float32 };

    PairView() = default;

    /// `data`: ceil(size / 8) blocks of [24][8]; lanes past `size` are ignored.
    static PairView blocked(const double* data, std::size_t size) noexcept { return {Layout::blocked, data, size}; }
    static PairView blocked(const float* data, std::size_t size) noexcept { return {Layout::blocked, data, size}; }

    /// `data`: size x 8 x 3, points in the order x0..x3 at t = 0, then x0..x3 at t = 1.
    static PairView interleaved(const double* data, std::size_t size) noexcept { return {Layout::interleaved, data, size}; }
    static PairView interleaved(const float* data, std::size_t size) noexcept { return {Layout::interleaved, data, size}; }

    /// `coordinates[c][i * stride]` is coordinate c of pair i; stride in elements, may be negative.
    static PairView strided(const std::array<const double*, pair_coordinates>& coordinates, std::ptrdiff_t stride,
                            std::size_t size) noexcept
    {
        return strided_view(coordinates, stride, size);
    }
    static PairView strided(const std::array<const float*, pair_coordinates>& coordinates, std::ptrdiff_t stride,
                            std::size_t size) noexcept
    {
        return strided_view(coordinates, stride, size);
    }

    // Always inlined: the kernels, compiled for wider instruction sets, use these too.
    [[nodiscard, gnu::always_inline]] inline std::size_t size() const noexcept { return size_; }
    [[nodiscard, gnu::always_inline]] inline Layout layout() const noexcept { return layout_; }
    [[nodiscard, gnu::always_inline]] inline Scalar scalar() const noexcept { return scalar_; }
    /// Start of the data (of coordinate c for a strided view).
    [[nodiscard, gnu::always_inline]] inline const void* data(std::size_t c = 0) const noexcept { return data_[c]; }
    [[nodiscard, gnu::always_inline]] inline std::ptrdiff_t stride() const noexcept { return stride_; }

private:
    template <class T>
    static constexpr Scalar scalar_of = sizeof(T) == sizeof(double) ? Scalar::float64 : Scalar::float32;

    template <class T>
    PairView(Layout layout, const T* data, std::size_t size) : size_{size}, layout_{layout}, scalar_{scalar_of<T>}
    {
        data_[0] = data;
    }

    template <class T>
    static PairView strided_view(const std::array<const T*, pair_coordinates>& coordinates, std::ptrdiff_t stride,
                                 std::size_t size)
    {
        PairView view{Layout::strided, coordinates[0], size};
        view.stride_ = stride;
        for (std::size_t c = 0; c < pair_coordinates; ++c) view.data_[c] = coordinates[c];
        return view;
    }

    const void* data_[pair_coordinates] = {};
    std::ptrdiff_t stride_ = 1;
    std::size_t size_ = 0;
    Layout layout_ = Layout::blocked;
    Scalar scalar_ = Scalar::float64;
};

}  // namespace fastccd
