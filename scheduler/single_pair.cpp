// One pair: the certified search, which is what defines the answer in a batch too.
#include <fastccd/single_pair.hpp>

#include <algorithm>
#include <cmath>

#include <fastccd/pair_view.hpp>
#include <checked_source.hpp>
#include <guarded.hpp>

namespace fastccd {

namespace {

PairToi single(PairKind kind, std::span<const Point, 4> x0, std::span<const Point, 4> x1, const Options& options) noexcept
{
    PairToi answer;
    answer.status = guarded([&] {
        Options search_alone = options;
        search_alone.reference = true;
        search_alone.isa = Isa::scalar;  // whatever was asked for
        Job job = no_job(kind);
        if (const Status status = prepare(kind, PairSource{nullptr, {}, 1}, search_alone, false, job); !status.ok()) return status;

        double coordinates[pair_coordinates];
        double* next = coordinates;
        for (const Point& point : x0) next = std::copy(point.begin(), point.end(), next);
        for (const Point& point : x1) next = std::copy(point.begin(), point.end(), next);
        const scalar::SearchResult found = answer_pair(job, coordinates, 1.0);
        answer.toi = found.toi;
        answer.proven = std::isfinite(found.toi) && found.proof != scalar::Proof::none;
        answer.at_start = options.minimum_separation > 0.0 && found.toi == 0.0;
        return Status{};
    });
    return answer;
}

}  // namespace

PairToi vertex_face_toi(std::span<const Point, 4> x0, std::span<const Point, 4> x1, const Options& options) noexcept
{
    return single(PairKind::vertex_face, x0, x1, options);
}

PairToi edge_edge_toi(std::span<const Point, 4> x0, std::span<const Point, 4> x1, const Options& options) noexcept
{
    return single(PairKind::edge_edge, x0, x1, options);
}

}  // namespace fastccd
