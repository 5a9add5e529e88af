#include <algorithm>
#include <span>
#include <vector>

#include <tbb/task_arena.h>

#include <fastccd/isa.hpp>

#include "../large_array.hpp"
#include "../narrow_phase_run.hpp"
#include "../pair_slice.hpp"
#include "../random_pairs.hpp"
#include "../scene/broad_phase.hpp"
#include "../scene/make_scene.hpp"
#include "machine.hpp"
#include "parts.hpp"

namespace fastccd::tools::report {
namespace {

/// Repeats until a fifth of a second has gone by, but at least three times.
Timing timed(int threads, const std::function<void()>& work)
{
    Timing timing;
    (void)seconds_on(threads, work);
    for (double sum = 0; sum < 0.2 || timing.repeats() < 3;) {
        const double seconds = seconds_on(threads, work);
        timing.add(seconds);
        sum += seconds;
    }
    return timing;
}

Json over_threads(const Plan& plan, ReportProgress& progress)
{
    const std::vector<int> counts = thread_counts();
    Json random = Json::array(), scene = Json::array();
    PairBuffer pairs{plan.thread_pairs()};
    fill_random_pairs(seed, 0, pairs);
    LargeArray<double> toi{pairs.size()};

    const ClothBall cloth{plan.cloth_size(), 2};
    const std::vector<double> start = cloth.positions(0), end = cloth.positions(1);
    const std::vector<Edge> edges = unique_edges(cloth.faces());
    LargeArray<EdgeEdge> candidate_list{std::span<const EdgeEdge>{edge_edge_candidates({start, end, cloth.faces(), edges})}};
    const std::span<const EdgeEdge> candidates = candidate_list.span();
    const MovingMesh mesh{PositionView::rows(start.data(), start.size() / 3),
                          PositionView::rows(end.data(), end.size() / 3),
                          {},
                          IndexView::rows(edges[0].data(), edges.size(), 2)};
    std::vector<Contact> contacts;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        progress.move(i, 2 * counts.size());
        const Timing packed =
            timed(counts[i], [&] { throw_unless_ok(time_of_impact(PairKind::vertex_face, pairs.view(), {}, toi.span())); });
        const Timing indexed = timed(counts[i], [&] {
            contacts.clear();
            throw_unless_ok(find_contacts(mesh, candidates, {}, contacts));
        });
        random.push_back({{"threads", counts[i]}, {"timing", packed.json(pairs.size())}});
        scene.push_back({{"threads", counts[i]}, {"timing", indexed.json(candidates.size())}});
    }
    return {{"random_vf", {{"pairs", pairs.size()}, {"points", random}}},
            {"cloth_ee_indexed", {{"pairs", candidates.size()}, {"points", scene}}}};
}

/// All pairs in one buffer, in one call.
Json in_memory(std::size_t count, int threads)
{
    PairBuffer pairs{count};
    fill_random_pairs(seed, 0, pairs);
    LargeArray<double> toi{count};
    const Timing timing =
        timed(threads, [&] { throw_unless_ok(time_of_impact(PairKind::vertex_face, pairs.view(), {}, toi.span())); });
    return {{"pairs", count}, {"timing", timing.json(count)}, {"resident_bytes", resident_memory()}};
}

/// As `fastccd random` does, and `fastccd run` with a file.
Json piece_by_piece(std::size_t count, int threads, ReportProgress& progress, std::size_t done, std::size_t total)
{
    PairBuffer pairs{std::min(chunk_pairs, count)};
    std::vector<Contact> contacts;
    Timing timing;
    const std::size_t repeats = count > 10'000'000 ? 1 : 3;
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
        double seconds = 0;
        for (std::size_t first = 0; first < count; first += pairs.size()) {
            progress.move(done * count + (repeat * count + first) / repeats, total * count);
            fill_random_pairs(seed, first, pairs);
            const PairView piece = slice(pairs.view(), 0, std::min(pairs.size(), count - first));
            contacts.clear();
            seconds += seconds_on(threads, [&] { throw_unless_ok(find_contacts(PairKind::vertex_face, piece, {}, contacts)); });
        }
        timing.add(seconds);
    }
    return {{"pairs", count}, {"timing", timing.json(count)}, {"resident_bytes", resident_memory()}};
}

Json over_pairs(const Plan& plan, ReportProgress& progress)
{
    const int threads = tbb::this_task_arena::max_concurrency();
    // A quarter of the memory: others live here too.
    const std::size_t fits = allowed_memory() / 4 / (pair_coordinates * sizeof(double));
    std::vector<std::size_t> counts;
    for (std::size_t count = 1000; count <= std::max<std::size_t>(plan.most_pairs(), 1000); count *= 10)
        counts.push_back(count);
    Json memory = Json::array(), pieces = Json::array();
    const std::size_t total = 2 * counts.size();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        progress.move(counts.size() + i, total);
        pieces.push_back(piece_by_piece(counts[i], threads, progress, counts.size() + i, total));
    }
    for (const std::size_t count : counts) {
        progress.move(total, total);
        if (count <= fits) memory.push_back(in_memory(count, threads));
    }
    return {{"in_memory", memory}, {"piece_by_piece", pieces}, {"piece", chunk_pairs}};
}

}  // namespace

Json scaling(const Plan& plan, ReportProgress& progress)
{
    Json result{{"isa", name(resolve_isa({}))}, {"threads", tbb::this_task_arena::max_concurrency()}, {"seed", seed}};
    result["over_threads"] = over_threads(plan, progress);
    result["over_pairs"] = over_pairs(plan, progress);
    return result;
}

}  // namespace fastccd::tools::report
