// For users of Eigen and libigl: views of matrices, nothing copied. Needs Eigen 3; the library itself does not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <Eigen/Core>

#include <fastccd/indexed.hpp>
#include <fastccd/single_pair.hpp>

namespace fastccd {

namespace eigen_detail {

template <class Matrix>
inline constexpr bool has_memory = (Matrix::Flags & Eigen::DirectAccessBit) != 0;

template <int columns, class Matrix>
constexpr void check_indices()
{
    static_assert(has_memory<Matrix>, "a view needs a matrix that lies in memory, not an expression");
    static_assert(std::is_same_v<typename Matrix::Scalar, std::int32_t>, "indices are int32");
    static_assert(Matrix::ColsAtCompileTime == columns || Matrix::ColsAtCompileTime == Eigen::Dynamic, "3 columns for faces, 2 for edges");
}

inline Point point(const Eigen::Ref<const Eigen::Vector3d>& x) { return {x[0], x[1], x[2]}; }

}  // namespace eigen_detail

/// Positions of n vertices, an n x 3 matrix of double or float in either storage order, or a block of one. A matrix with
/// another number of columns gives a view of as many rows without data: MovingMesh reports wrong_size.
template <class Matrix>
[[nodiscard]] PositionView positions(const Eigen::DenseBase<Matrix>& matrix) noexcept
{
    static_assert(eigen_detail::has_memory<Matrix>, "a view needs a matrix that lies in memory, not an expression");
    static_assert(Matrix::ColsAtCompileTime == 3 || Matrix::ColsAtCompileTime == Eigen::Dynamic, "one column for x, y and z each");
    const Matrix& m = matrix.derived();
    const auto rows = static_cast<std::size_t>(m.rows());
    if (m.cols() != 3 || rows == 0) return PositionView::xyz<double>(nullptr, nullptr, nullptr, 0, rows);
    return PositionView::xyz(m.data(), m.data() + m.colStride(), m.data() + 2 * m.colStride(), m.rowStride(), rows);
}

/// Faces, n x 3, or edges, n x 2, of int32, in either storage order. A matrix with another number of columns gives a view
/// without data: MovingMesh reports wrong_size.
template <class Matrix>
[[nodiscard]] IndexView faces(const Eigen::DenseBase<Matrix>& matrix) noexcept
{
    eigen_detail::check_indices<3, Matrix>();
    const Matrix& m = matrix.derived();
    return {m.cols() == 3 ? m.data() : nullptr, static_cast<std::size_t>(m.rows()), m.rowStride(), m.colStride()};
}
template <class Matrix>
[[nodiscard]] IndexView edges(const Eigen::DenseBase<Matrix>& matrix) noexcept
{
    eigen_detail::check_indices<2, Matrix>();
    const Matrix& m = matrix.derived();
    return {m.cols() == 2 ? m.data() : nullptr, static_cast<std::size_t>(m.rows()), m.rowStride(), m.colStride()};
}

// A view of a temporary would dangle.
template <class Matrix>
PositionView positions(const Eigen::PlainObjectBase<Matrix>&&) = delete;
template <class Matrix>
IndexView faces(const Eigen::PlainObjectBase<Matrix>&&) = delete;
template <class Matrix>
IndexView edges(const Eigen::PlainObjectBase<Matrix>&&) = delete;

/// One pair of a vertex and a face; see single_pair.hpp. First all points at t = 0, then at t = 1.
[[nodiscard]] inline PairToi vertex_face_toi(
    const Eigen::Ref<const Eigen::Vector3d>& vertex_0, const Eigen::Ref<const Eigen::Vector3d>& face0_0,
    const Eigen::Ref<const Eigen::Vector3d>& face1_0, const Eigen::Ref<const Eigen::Vector3d>& face2_0,
    const Eigen::Ref<const Eigen::Vector3d>& vertex_1, const Eigen::Ref<const Eigen::Vector3d>& face0_1,
    const Eigen::Ref<const Eigen::Vector3d>& face1_1, const Eigen::Ref<const Eigen::Vector3d>& face2_1, const Options& options = {}) noexcept
{
    using eigen_detail::point;
    const Point x0[4] = {point(vertex_0), point(face0_0), point(face1_0), point(face2_0)};
    const Point x1[4] = {point(vertex_1), point(face0_1), point(face1_1), point(face2_1)};
    return vertex_face_toi(x0, x1, options);
}

/// One pair of edges a and b.
[[nodiscard]] inline PairToi edge_edge_toi(
    const Eigen::Ref<const Eigen::Vector3d>& a0_0, const Eigen::Ref<const Eigen::Vector3d>& a1_0,
    const Eigen::Ref<const Eigen::Vector3d>& b0_0, const Eigen::Ref<const Eigen::Vector3d>& b1_0,
    const Eigen::Ref<const Eigen::Vector3d>& a0_1, const Eigen::Ref<const Eigen::Vector3d>& a1_1,
    const Eigen::Ref<const Eigen::Vector3d>& b0_1, const Eigen::Ref<const Eigen::Vector3d>& b1_1, const Options& options = {}) noexcept
{
    using eigen_detail::point;
    const Point x0[4] = {point(a0_0), point(a1_0), point(b0_0), point(b1_0)};
    const Point x1[4] = {point(a0_1), point(a1_1), point(b0_1), point(b1_1)};
    return edge_edge_toi(x0, x1, options);
}

}  // namespace fastccd
