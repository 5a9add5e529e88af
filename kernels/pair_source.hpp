// Where the pairs of a call come from, as plain data the kernels of every instruction set can read.
#pragma once

#include <cstddef>
#include <cstdint>

#include <fastccd/pair_view.hpp>
#include <grid_box.hpp>

namespace fastccd {

/// Doubles a vertex in the records of a MovingMesh: x y z at t = 0, x y z at t = 1, two unused.
inline constexpr std::size_t vertex_record_size = 8;

/// Pairs of indices into a MovingMesh.
struct IndexedSource {
    const double* records;           ///< vertex_record_size doubles a vertex.
    const std::int32_t* pairs;       ///< 2 a pair: vertex and face, or two edges.
    const std::int32_t* primitives;  ///< Vertices of the faces or edges.
    std::ptrdiff_t row_stride, column_stride;
    std::size_t vertex_count, primitive_count;
    BoxScreen boxes;
};

struct PairSource {
    const PairView* view;  ///< Packed pairs; null: `indexed`.
    IndexedSource indexed;
    std::size_t size;
};

}  // namespace fastccd
