// The boxes of a mesh's primitives (grid_box.hpp).
#pragma once

#include <atomic>
#include <cstddef>

#include <fastccd/options.hpp>
#include <pair_source.hpp>

namespace fastccd {

/// Made for the faces or the edges of a mesh when a call first brings enough pairs for them to pay, and kept for the calls that
/// follow: 32 bytes for each vertex, face and edge. Calls on several threads may share them.
class MeshBoxes {
public:
    MeshBoxes() = default;
    ~MeshBoxes();
    MeshBoxes(const MeshBoxes&) = delete;
    MeshBoxes& operator=(const MeshBoxes&) = delete;

    /// What a call with so many pairs and this minimum separation compares. No boxes for few pairs, where a coordinate of
    /// the mesh is not finite, and where there is no memory for them: without them everything is found all the same.
    /// The first time O(vertices + primitives), on all threads of the arena.
    BoxScreen screen(PairKind kind, const IndexedSource& source, std::size_t pairs, double minimum_separation);

private:
    struct Set;
    static Set* make(PairKind kind, const IndexedSource& source);

    std::atomic<Set*> sets_[2] = {};
};

}  // namespace fastccd
