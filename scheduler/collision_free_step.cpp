// The step for a line search: the first contact over candidates of both kinds.
#include <fastccd/fastccd.hpp>

#include <algorithm>
#include <cmath>

#include <checked_source.hpp>
#include <guarded.hpp>
#include <parallel_tiles.hpp>
#include <shared_best.hpp>

namespace fastccd {

namespace {

/// A worker that also remembers invalid pairs.
struct StepWorker : TileWorker {
    std::size_t invalid_before = 0;       ///< Invalid pairs up to its previous tile.
    std::size_t first_invalid = no_pair;  ///< Smallest index of those it has seen.
};

/// Offers the contacts of the job, and its invalid pairs as contacts at time 0, under their index plus `offset`. Returns
/// the first invalid pair that was looked at.
std::size_t offer_all(const Job& job, std::size_t offset, SharedBest& best)
{
    Workers<StepWorker> workers;
    const auto cutoff = [&](std::size_t first) { return best.cutoff(job, offset + first); };
    for_each_tile(job, workers, cutoff, [&](StepWorker& worker, std::size_t first, std::size_t count) {
        const Contact& earliest = worker.totals.earliest;
        if (earliest.pair != no_pair) best.offer({offset + earliest.pair, earliest.toi, earliest.proven, earliest.at_start});
        if (worker.totals.invalid == worker.invalid_before) return;
        worker.invalid_before = worker.totals.invalid;
        for_each_bit(worker.scratch.reported, count, [&](std::size_t i) {
            if (!std::isnan(worker.scratch.time[i])) return;
            worker.first_invalid = std::min(worker.first_invalid, offset + first + i);
            best.offer({offset + first + i, 0.0});
        });
    });
    std::size_t first_invalid = no_pair;
    workers.combine_each([&](const StepWorker& worker) { first_invalid = std::min(first_invalid, worker.first_invalid); });
    return first_invalid;
}

Status find_step(const CheckedSource& vertex_face, const CheckedSource& edge_edge, const Options& options, CollisionFreeStep& step)
{
    Job faces = no_job(PairKind::vertex_face), edges = no_job(PairKind::edge_edge);
    if (const Status status = prepare(faces.kind, vertex_face, options, false, faces); !status.ok()) return status;
    step.kind = PairKind::edge_edge;
    if (const Status status = prepare(edges.kind, edge_edge, options, false, edges); !status.ok()) return status;

    // One numbering of all candidates, vertex-face first, decides ties.
    SharedBest best;
    const std::size_t face_pairs = vertex_face.source.size;
    const std::size_t invalid_faces = offer_all(faces, 0, best);
    const std::size_t first_invalid = std::min(invalid_faces, offer_all(edges, face_pairs, best));
    const Contact& limit = best.contact();
    step = {std::min(limit.toi, options.t_max), PairKind::vertex_face, limit.pair};
    if (step.limited() && limit.pair >= face_pairs) {
        step.kind = PairKind::edge_edge;
        step.pair -= face_pairs;
    }
    // The first invalid pair that was looked at: if any limits the step, this one does.
    if (step.limited() && limit.pair == first_invalid) return {Error::invalid_pair, step.pair};
    return {};
}

}  // namespace

Status collision_free_step(const MovingMesh& mesh, std::span<const VertexFace> vertex_face, std::span<const EdgeEdge> edge_edge,
                           const Options& options, CollisionFreeStep& step) noexcept
{
    step = {};  // whatever goes wrong below, a check of the indices included
    return guarded([&] { return find_step(indexed(mesh, vertex_face), indexed(mesh, edge_edge), options, step); });
}

Status collision_free_step(const PairView& vertex_face, const PairView& edge_edge, const Options& options,
                           CollisionFreeStep& step) noexcept
{
    step = {};
    return guarded([&] { return find_step(packed(vertex_face), packed(edge_edge), options, step); });
}

}  // namespace fastccd
