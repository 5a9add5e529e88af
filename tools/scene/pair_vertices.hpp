// The four vertices of a candidate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "broad_phase.hpp"

namespace fastccd::tools {

using PairVertices = std::array<std::int32_t, 4>;

/// The points x0..x3 of a pair, in the order that the library gives them: the vertex, then the face's.
[[nodiscard]] inline PairVertices pair_vertices(const Step& step, const VertexFace& pair)
{
    const std::int32_t* const face = &step.faces[3 * static_cast<std::size_t>(pair.face)];
    return {pair.vertex, face[0], face[1], face[2]};
}

/// The first edge's, then the second's.
[[nodiscard]] inline PairVertices pair_vertices(const Step& step, const EdgeEdge& pair)
{
    const Edge& a = step.edges[static_cast<std::size_t>(pair.edge_a)];
    const Edge& b = step.edges[static_cast<std::size_t>(pair.edge_b)];
    return {a[0], a[1], b[0], b[1]};
}

}  // namespace fastccd::tools
