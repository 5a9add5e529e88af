// From the arguments of an entry point to a job.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <fastccd/indexed.hpp>
#include <index_check.hpp>
#include <mesh_boxes.hpp>
#include <tile_runner.hpp>

namespace fastccd {

/// A source and whether its indices are in range.
struct CheckedSource {
    PairSource source;
    Status status;
    MeshBoxes* boxes = nullptr;  ///< Of the mesh that indexed pairs refer to.
};

inline CheckedSource packed(const PairView& pairs) { return {{&pairs, {}, pairs.size()}, {}, nullptr}; }

inline CheckedSource indexed(const MovingMesh& mesh, const std::int32_t* pairs, std::size_t count, const IndexView& primitives,
                             std::size_t first_size)
{
    if (!mesh.status().ok()) return {{}, mesh.status(), nullptr};
    if ((pairs == nullptr && count > 0) || exceeds_memory(count, 2 * sizeof *pairs)) return {{}, {Error::wrong_size}, nullptr};
    return {{nullptr, {mesh.records(), pairs, primitives.data, primitives.row_stride, primitives.column_stride,
                       mesh.vertex_count(), primitives.size, {}}, count},
            check_pairs(pairs, count, first_size, primitives.size), mesh.boxes()};
}

// The pair types are two int32 each, read as such.
static_assert(sizeof(VertexFace) == 2 * sizeof(std::int32_t) && sizeof(EdgeEdge) == 2 * sizeof(std::int32_t));

inline CheckedSource indexed(const MovingMesh& mesh, std::span<const VertexFace> pairs)
{
    return indexed(mesh, pairs.data() == nullptr ? nullptr : &pairs.data()->vertex, pairs.size(), mesh.faces(), mesh.vertex_count());
}

inline CheckedSource indexed(const MovingMesh& mesh, std::span<const EdgeEdge> pairs)
{
    return indexed(mesh, pairs.data() == nullptr ? nullptr : &pairs.data()->edge_a, pairs.size(), mesh.edges(), mesh.edges().size);
}

inline Status prepare(PairKind kind, const CheckedSource& checked, const Options& options, bool count_roots, Job& job)
{
    if (!checked.status.ok()) return checked.status;
    const Status status = prepare(kind, checked.source, options, count_roots, job);
    if (status.ok() && job.kernels != nullptr && checked.boxes != nullptr)
        job.source.indexed.boxes =
            checked.boxes->screen(kind, checked.source.indexed, checked.source.size, options.minimum_separation);
    return status;
}

/// To be prepared.
inline Job no_job(PairKind kind) { return {kind, {}, {1.0, 1.0, false}, nullptr, false}; }

}  // namespace fastccd
