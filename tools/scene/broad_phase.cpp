#include "broad_phase.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "../interrupt.hpp"
#include "box_tree.hpp"

namespace fastccd::tools {
namespace {

void check_positions(std::span<const double> positions0, std::span<const double> positions1)
{
    if (positions0.size() != positions1.size() || positions0.size() % 3 != 0) {
        throw std::invalid_argument(fmt::format(
            "broad phase: {} and {} coordinates at the two frames; n x 3 at both are needed",
            positions0.size(), positions1.size()));
    }
}

void check_indices(std::span<const std::int32_t> indices, std::size_t vertex_count,
                   std::string_view primitive, std::size_t corners)
{
    if (indices.size() % corners != 0) {
        throw std::invalid_argument(
            fmt::format("broad phase: {} indices do not make {}s of {} vertices", indices.size(),
                        primitive, corners));
    }
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] < 0 || static_cast<std::size_t>(indices[i]) >= vertex_count) {
            throw std::invalid_argument(fmt::format("broad phase: {} {} refers to vertex {} of {}",
                                                    primitive, i / corners, indices[i],
                                                    vertex_count));
        }
    }
}

/// The box of the primitive with these vertices over the step; its bounds are NaN when a coordinate
/// is not finite.
Box swept_box(const Step& step, std::span<const std::int32_t> vertices)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const std::int32_t vertex : vertices) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t i = 3 * static_cast<std::size_t>(vertex) + axis;
            const double x0 = step.positions0[i];
            const double x1 = step.positions1[i];
            if (!std::isfinite(x0) || !std::isfinite(x1)) {
                constexpr double nan = std::numeric_limits<double>::quiet_NaN();
                return {{nan, nan, nan}, {nan, nan, nan}};
            }
            box.low[axis] = std::min({box.low[axis], x0, x1});
            box.high[axis] = std::max({box.high[axis], x0, x1});
        }
    }
    return box;
}

/// All that may come closer to what is in the box than `separation`, and never less for rounding.
Box grown(Box box, double separation)
{
    if (separation == 0) return box;
    constexpr double largest = std::numeric_limits<double>::max();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::max(std::nextafter(box.low[axis] - separation, -HUGE_VAL), -largest);
        box.high[axis] = std::min(std::nextafter(box.high[axis] + separation, HUGE_VAL), largest);
    }
    return box;
}

template <class VerticesOf>
std::vector<Box> swept_boxes(const Step& step, std::size_t count, const VerticesOf& vertices_of)
{
    std::vector<Box> boxes(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            boxes[i] = swept_box(step, vertices_of(i));
        }
    });
    return boxes;
}

// The search goes through the queries (vertices, or first edges) in rounds; a round's candidates
// are one piece for the sink. The size of a round follows from the number of candidates in the one
// before it, never from the number of threads. The first is small, and none is many times as large as
// the one before it: where everything overlaps, a query alone has as many candidates as there are edges.
constexpr std::size_t queries_per_task = 64;
constexpr std::size_t most_queries_per_round = 128 * queries_per_task;
constexpr std::size_t candidates_per_round = std::size_t{1} << 20;
constexpr std::size_t most_growth = 8;

std::size_t next_round(std::size_t queries, std::size_t candidates)
{
    const std::size_t per_query = candidates / queries + 1;
    const std::size_t wanted =
        candidates_per_round / per_query / queries_per_task * queries_per_task;
    const std::size_t most = std::clamp(most_growth * queries, queries_per_task, most_queries_per_round);
    return std::clamp(wanted, queries_per_task, most);
}

// What one task found: the partners of query after query, and where each query's end.
struct TaskResult {
    std::vector<std::int32_t> partners;
    std::array<std::size_t, queries_per_task> ends;
};

/// The loop that both kinds share. `find(query, scratch)` returns the partners of a query in
/// ascending order; `sink` receives `Pair{query, partner}` in order of query, then partner.
template <class Pair, class Find, class Sink>
void search(const BoxTree& tree, std::size_t query_count, const Find& find, const Sink& sink)
{
    tbb::enumerable_thread_specific<BoxTree::Scratch> scratches(
        [&tree] { return BoxTree::Scratch(tree); });
    std::vector<TaskResult> results(most_queries_per_round / queries_per_task);
    std::vector<Pair> piece;

    std::size_t round = queries_per_task;
    for (std::size_t first = 0; first < query_count;) {
        const std::size_t last = std::min(first + round, query_count);
        const std::size_t tasks = (last - first + queries_per_task - 1) / queries_per_task;
        tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
            BoxTree::Scratch& scratch = scratches.local();
            TaskResult& result = results[task];
            result.partners.clear();
            const std::size_t begin = first + task * queries_per_task;
            const std::size_t end = std::min(begin + queries_per_task, last);
            for (std::size_t query = begin; query < end; ++query) {
                check_interrupt();
                const std::span<std::int32_t> partners = find(query, scratch);
                result.partners.insert(result.partners.end(), partners.begin(), partners.end());
                result.ends[query - begin] = result.partners.size();
            }
        });

        std::vector<std::size_t> offsets(tasks + 1, 0);
        for (std::size_t task = 0; task < tasks; ++task) {
            offsets[task + 1] = offsets[task] + results[task].partners.size();
        }
        piece.resize(offsets[tasks]);
        tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
            const TaskResult& result = results[task];
            const std::size_t begin = first + task * queries_per_task;
            Pair* out = piece.data() + offsets[task];
            std::size_t query = begin;
            for (std::size_t i = 0; i < result.partners.size(); ++i) {
                while (result.ends[query - begin] <= i) ++query;
                *out++ = {static_cast<std::int32_t>(query), result.partners[i]};
            }
        });
        if (!piece.empty()) sink(std::span<const Pair>(piece));
        round = next_round(last - first, piece.size());
        first = last;
    }
}

}  // namespace

void find_vertex_face(const Step& step, const VertexFaceSink& sink)
{
    check_positions(step.positions0, step.positions1);
    const std::size_t vertex_count = step.positions0.size() / 3;
    check_indices(step.faces, vertex_count, "face", 3);

    const BoxTree faces(swept_boxes(step, step.faces.size() / 3, [&](std::size_t face) {
        return step.faces.subspan(3 * face, 3);
    }));
    const auto find = [&](std::size_t query, BoxTree::Scratch& scratch) -> std::span<std::int32_t> {
        const auto vertex = static_cast<std::int32_t>(query);
        const Box box = swept_box(step, std::span(&vertex, 1));
        if (!is_finite(box)) return {};
        const std::span<std::int32_t> found = faces.overlapping(grown(box, step.separation), -1, scratch);
        const auto is_own = [&](std::int32_t face) {
            const std::int32_t* const corners = &step.faces[3 * static_cast<std::size_t>(face)];
            return corners[0] == vertex || corners[1] == vertex || corners[2] == vertex;
        };
        return found.first(static_cast<std::size_t>(
            std::remove_if(found.begin(), found.end(), is_own) - found.begin()));
    };
    search<VertexFace>(faces, vertex_count, find, sink);
}

void find_edge_edge(const Step& step, const EdgeEdgeSink& sink)
{
    check_positions(step.positions0, step.positions1);
    const std::span<const std::int32_t> ends(step.edges.empty() ? nullptr : step.edges[0].data(),
                                             2 * step.edges.size());
    check_indices(ends, step.positions0.size() / 3, "edge", 2);

    const std::vector<Box> boxes = swept_boxes(step, step.edges.size(), [&](std::size_t edge) {
        return std::span<const std::int32_t>(step.edges[edge]);
    });
    const BoxTree edges(boxes);
    const auto find = [&](std::size_t query, BoxTree::Scratch& scratch) -> std::span<std::int32_t> {
        if (!is_finite(boxes[query])) return {};
        const std::span<std::int32_t> found =
            edges.overlapping(grown(boxes[query], step.separation), static_cast<std::int32_t>(query), scratch);
        const Edge& a = step.edges[query];
        const auto is_neighbour = [&](std::int32_t other) {
            const Edge& b = step.edges[static_cast<std::size_t>(other)];
            return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
        };
        return found.first(static_cast<std::size_t>(
            std::remove_if(found.begin(), found.end(), is_neighbour) - found.begin()));
    };
    search<EdgeEdge>(edges, step.edges.size(), find, sink);
}

std::vector<VertexFace> vertex_face_candidates(const Step& step)
{
    std::vector<VertexFace> all;
    find_vertex_face(step, [&all](std::span<const VertexFace> piece) {
        all.insert(all.end(), piece.begin(), piece.end());
    });
    return all;
}

std::vector<EdgeEdge> edge_edge_candidates(const Step& step)
{
    std::vector<EdgeEdge> all;
    find_edge_edge(step, [&all](std::span<const EdgeEdge> piece) {
        all.insert(all.end(), piece.begin(), piece.end());
    });
    return all;
}

std::vector<std::int32_t> non_finite_vertices(std::span<const double> positions0,
                                              std::span<const double> positions1)
{
    check_positions(positions0, positions1);
    std::vector<std::int32_t> vertices;
    for (std::size_t i = 0; i < positions0.size(); i += 3) {
        bool finite = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            finite = finite && std::isfinite(positions0[i + axis]) &&
                     std::isfinite(positions1[i + axis]);
        }
        if (!finite) vertices.push_back(static_cast<std::int32_t>(i / 3));
    }
    return vertices;
}

}  // namespace fastccd::tools
