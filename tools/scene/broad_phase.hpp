// Candidate pairs of one step of a mesh: the broad phase.
//
// A primitive's box is the smallest axis-aligned box around its vertices at both frames; linear
// motion keeps the primitive inside it. Candidates are exactly the pairs whose boxes, closed and
// not inflated, overlap on all three axes in double precision (minima, maxima and comparisons do
// not round), or, with a separation, would if one of the two were grown by that much and rounded
// outward, except
//   vertex-face  pairs of a face and one of its own vertices,
//   edge-edge    pairs of edges with a common vertex.
// Primitives with a coordinate that is not finite at either frame have no box and are in no
// candidate: their pairs would be all that there are, and `non_finite_vertices` names the fault in
// a line instead.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <fastccd/indexed.hpp>

#include "edge.hpp"

namespace fastccd::tools {

/// One step: the same mesh at t = 0 and t = 1. Refers to arrays of the caller.
struct Step {
    std::span<const double> positions0;   ///< n x 3, row-major, at t = 0
    std::span<const double> positions1;   ///< n x 3, row-major, at t = 1
    std::span<const std::int32_t> faces;  ///< m x 3, row-major, indices in [0, n)
    std::span<const Edge> edges;          ///< indices in [0, n); see unique_edges
    double separation = 0;                ///< pairs that may come as close are candidates too
};

/// Receives the next candidates. Pieces hold at most a few million candidates where the mesh is
/// about equally dense; the memory is reused once the call returns.
using VertexFaceSink = std::function<void(std::span<const VertexFace>)>;
using EdgeEdgeSink = std::function<void(std::span<const EdgeEdge>)>;

/// Finds the vertex-face candidates of a step and hands them to `sink` piece by piece, in order of
/// vertex, then face.
///
/// Runs in the caller's TBB arena; `sink` is called from the calling thread, one call after the
/// other, while the search rests, and may itself use TBB. Candidates, order and pieces do not
/// depend on the number of threads. Throws std::invalid_argument when the arrays' sizes do not
/// agree or an index is out of range, and passes on what `sink` and check_interrupt() throw.
void find_vertex_face(const Step& step, const VertexFaceSink& sink);

/// The same for edge-edge: every unordered pair once, edge_a < edge_b, in order of edge_a, then
/// edge_b.
void find_edge_edge(const Step& step, const EdgeEdgeSink& sink);

/// All candidates at once: 8 bytes each.
[[nodiscard]] std::vector<VertexFace> vertex_face_candidates(const Step& step);
[[nodiscard]] std::vector<EdgeEdge> edge_edge_candidates(const Step& step);

/// The vertices, in ascending order, with a NaN or infinite coordinate at either frame. Throws
/// std::invalid_argument when the frames' sizes do not agree.
[[nodiscard]] std::vector<std::int32_t> non_finite_vertices(std::span<const double> positions0,
                                                            std::span<const double> positions1);

}  // namespace fastccd::tools
