// Generated pairs as a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "oracle/pair.hpp"

namespace fastccd::testing {

/// Each pair has four vertices of its own, a face of the last three of them, and two edges: vertex 4 i and face i, edges 2 i and 2 i + 1.
struct MeshOfPairs {
    std::vector<double> start, end;         // n x 3
    std::vector<std::int32_t> faces, edges;  // n x 3, n x 2
    std::vector<VertexFace> vertex_face;     ///< What is asked about, in the order of the pairs.
    std::vector<EdgeEdge> edge_edge;

    explicit MeshOfPairs(const std::vector<oracle::Pair>& pairs)
    {
        for (const oracle::Pair& pair : pairs) {
            const auto i = static_cast<std::int32_t>(vertex_face.size()), first = 4 * i;
            for (std::size_t p = 0; p < 4; ++p) {
                start.insert(start.end(), pair[p].begin(), pair[p].end());
                end.insert(end.end(), pair[4 + p].begin(), pair[4 + p].end());
            }
            faces.insert(faces.end(), {first + 1, first + 2, first + 3});
            edges.insert(edges.end(), {first, first + 1, first + 2, first + 3});
            vertex_face.push_back({first, i});
            edge_edge.push_back({2 * i, 2 * i + 1});
        }
    }

    /// Asks about each primitive of the pairs with `around` others, in steps of `step`.
    void pair_with_others(std::int32_t around, std::int32_t step)
    {
        const auto size = static_cast<std::int32_t>(faces.size() / 3);
        vertex_face.clear();
        edge_edge.clear();
        for (std::int32_t i = 0; i < size; ++i)
            for (std::int32_t k = 0; k < around; ++k) {
                const std::int32_t other = (i + step * k) % size;
                vertex_face.push_back({4 * other, i});
                edge_edge.push_back({2 * i, 2 * other + 1});
            }
    }

    [[nodiscard]] PositionView starts() const { return PositionView::rows(start.data(), start.size() / 3); }
    [[nodiscard]] PositionView ends() const { return PositionView::rows(end.data(), end.size() / 3); }
    [[nodiscard]] IndexView face_rows() const { return IndexView::rows(faces.data(), faces.size() / 3, 3); }
    [[nodiscard]] IndexView edge_rows() const { return IndexView::rows(edges.data(), edges.size() / 2, 2); }
    [[nodiscard]] MovingMesh mesh() const { return {starts(), ends(), face_rows(), edge_rows()}; }
};

}  // namespace fastccd::testing
