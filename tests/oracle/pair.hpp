#pragma once

#include <array>

namespace fastccd::oracle {

enum class Kind { vertex_face, edge_edge };

/// Four moving points, x(t) = x(0) + t (x(1) - x(0)): x0..x3 at t = 0, then x0..x3 at t = 1, each x y z.
/// Vertex-face: x0 is the vertex, x1 x2 x3 the face. Edge-edge: x0 x1 is one edge, x2 x3 the other.
using Pair = std::array<std::array<double, 3>, 8>;

/// True if every coordinate is finite: what all functions of the oracle ask for.
bool is_finite(const Pair& pair);

}  // namespace fastccd::oracle
