// Pairs given as indices into a mesh that moves: what simulators hold.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include <fastccd/aligned_doubles.hpp>
#include <fastccd/export.h>
#include <fastccd/options.hpp>

namespace fastccd {

/// Candidate pair of a vertex and a face, by index.
struct VertexFace {
    std::int32_t vertex, face;
    friend constexpr auto operator<=>(const VertexFace&, const VertexFace&) = default;
};

/// Candidate pair of two edges, by index.
struct EdgeEdge {
    std::int32_t edge_a, edge_b;
    friend constexpr auto operator<=>(const EdgeEdge&, const EdgeEdge&) = default;
};

/// Positions of n vertices at one end of the step, where the caller holds them. float is widened exactly.
/// Eigen n x 3 matrices: rows() for RowMajor, columns() for ColMajor (libigl's default).
class PositionView {
public:
    PositionView() = default;

    /// n x 3, one vertex after the other.
    template <class T>
    static PositionView rows(const T* data, std::size_t n) noexcept
    {
        if (data == nullptr) return {data, data, data, 3, n};
        return {data, data + 1, data + 2, 3, n};
    }
    /// n x 3, all x, then all y, then all z.
    template <class T>
    static PositionView columns(const T* data, std::size_t n) noexcept
    {
        if (data == nullptr) return {data, data, data, 1, n};
        return {data, data + n, data + 2 * n, 1, n};
    }
    /// Vertex i at x[i * stride], y[i * stride], z[i * stride]; stride in elements, may be negative.
    template <class T>
    static PositionView xyz(const T* x, const T* y, const T* z, std::ptrdiff_t stride, std::size_t n) noexcept
    {
        return {x, y, z, stride, n};
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// In elements, which are of so many bytes.
    [[nodiscard]] std::ptrdiff_t stride() const noexcept { return stride_; }
    [[nodiscard]] std::size_t number_size() const noexcept { return is_float_ ? sizeof(float) : sizeof(double); }
    [[nodiscard]] bool has_data() const noexcept { return axis_[0] != nullptr && axis_[1] != nullptr && axis_[2] != nullptr; }
    /// Coordinate of vertex i along axis 0, 1 or 2.
    [[nodiscard]] double operator()(std::size_t i, int axis) const noexcept
    {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * stride_;
        return is_float_ ? static_cast<double>(static_cast<const float*>(axis_[axis])[at])
                         : static_cast<const double*>(axis_[axis])[at];
    }

private:
    template <class T>
    PositionView(const T* x, const T* y, const T* z, std::ptrdiff_t stride, std::size_t n)
        : axis_{x, y, z}, stride_{stride}, size_{n}, is_float_{std::is_same_v<T, float>}
    {
        static_assert(std::is_same_v<T, float> || std::is_same_v<T, double>, "positions are float or double");
    }

    const void* axis_[3] = {};
    std::ptrdiff_t stride_ = 0;
    std::size_t size_ = 0;
    bool is_float_ = false;
};

/// n rows of indices of vertices, from 0: 3 a face, 2 an edge, in either storage order.
struct IndexView {
    const std::int32_t* data = nullptr;
    std::size_t size = 0;            ///< Rows.
    std::ptrdiff_t row_stride = 0;     ///< Elements from a row to the next,
    std::ptrdiff_t column_stride = 0;  ///< and within a row; neither may be 0 where there is more than one.

    /// n x `columns` (3 or 2), one row after the other.
    static IndexView rows(const std::int32_t* data, std::size_t n, int columns) noexcept { return {data, n, columns, 1}; }
    /// 3 or 2 columns of n, one after the other.
    static IndexView columns(const std::int32_t* data, std::size_t n) noexcept
    {
        return {data, n, 1, static_cast<std::ptrdiff_t>(n)};
    }
};

class MeshBoxes;

/// Deleter of what only the library knows.
struct ReleaseBoxes {
    FASTCCD_API void operator()(MeshBoxes* boxes) const noexcept;
};

/// A mesh that moves linearly over the step. Copies the positions once into records of 64 bytes per vertex, which
/// is what makes indexed pairs fast; refers to the caller's faces and edges, which must outlive it unchanged. Calls with many
/// pairs add, once, 32 bytes for each vertex, face and edge: boxes that keep most pairs of a broad phase apart without a look
/// at their vertices.
class MovingMesh {
public:
    MovingMesh() = default;
    /// `other` is as if made by default then: no mesh.
    MovingMesh(MovingMesh&& other) noexcept { swap(other); }
    MovingMesh& operator=(MovingMesh&& other) noexcept
    {
        MovingMesh taken{std::move(other)};
        swap(taken);
        return *this;
    }
    /// Positions at t = 0 and t = 1 of the same vertices; faces n x 3 and edges n x 2, either may be empty.
    /// status() tells what is wrong, if anything: wrong_size for positions of different size, missing data, more than memory can
    /// hold or indices with a stride of 0 (and for a mesh made by default), bad_face_index, then bad_edge_index, with the row at fault as `pair`,
    /// out_of_memory. Calls that are given a mesh with an error return that error. O(vertices + faces + edges), positions on all
    /// threads of the arena.
    FASTCCD_API MovingMesh(const PositionView& start, const PositionView& end, const IndexView& faces, const IndexView& edges) noexcept;

    [[nodiscard]] Status status() const noexcept { return status_; }
    [[nodiscard]] std::size_t vertex_count() const noexcept { return vertex_count_; }
    [[nodiscard]] const IndexView& faces() const noexcept { return faces_; }
    [[nodiscard]] const IndexView& edges() const noexcept { return edges_; }
    /// Records x y z at t = 0, x y z at t = 1, two unused; 64-byte aligned.
    [[nodiscard]] const double* records() const noexcept { return records_.get(); }
    /// For the library's own calls; null in a mesh with an error and in one without vertices.
    [[nodiscard]] MeshBoxes* boxes() const noexcept { return boxes_.get(); }

private:
    void swap(MovingMesh& other) noexcept
    {
        std::swap(records_, other.records_);
        std::swap(boxes_, other.boxes_);
        std::swap(vertex_count_, other.vertex_count_);
        std::swap(faces_, other.faces_);
        std::swap(edges_, other.edges_);
        std::swap(status_, other.status_);
    }

    AlignedDoubles records_;
    std::unique_ptr<MeshBoxes, ReleaseBoxes> boxes_;
    std::size_t vertex_count_ = 0;
    IndexView faces_, edges_;
    Status status_{Error::wrong_size};
};

}  // namespace fastccd
