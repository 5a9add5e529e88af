// The narrow phase from end to end, through the public interface: the table of bench_table.hpp.
//
// Every timed call is followed by a pass that merely reads the same memory on the same threads. Both see the same
// state of the machine, and the ratio of their medians is the fraction of the streaming limit. Another
// pass, as long as such passes take no more time than the calls, merely multiplies: what of a core's arithmetic each thread has.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <checked_source.hpp>
#include <fastccd/fastccd.hpp>
#include <large_array.hpp>

#include "arithmetic_limit.hpp"
#include "bench_main.hpp"
#include "bench_table.hpp"
#include "datasets.hpp"
#include "layouts.hpp"
#include "query_bench.hpp"
#include "streaming_limit.hpp"

namespace fastccd::bench {

namespace {

/// What the cases of one data set and layout share, built once: consecutive cases of the table.
struct Input {
    std::string data;
    PairKind kind;
    Layout layout;
    PairView::Scalar scalar;
    std::size_t pairs;
    std::size_t bytes;  ///< Of the list of pairs, that is without a mesh's vertices, faces and edges.
    std::optional<LayoutCopy> packed;
    std::optional<StreamingLimit> limit;
    MovingMesh mesh;
    tools::LargeArray<VertexFace> vertex_face;  ///< Of indexed pairs, one of the two lists.
    tools::LargeArray<EdgeEdge> edge_edge;
    tools::LargeArray<double> toi;  ///< Results of all calls, in the same memory.
};

MovingMesh moving_mesh(const SceneStep& scene)
{
    const std::size_t vertices = scene.start.size() / 3;
    return {PositionView::rows(scene.start.data(), vertices), PositionView::rows(scene.end.data(), vertices),
            IndexView::rows(scene.faces.data(), scene.faces.size() / 3, 3),
            IndexView::rows(scene.edges.data()->data(), scene.edges.size(), 2)};
}

PairView::Layout packed_layout(Layout layout)
{
    switch (layout) {
        case Layout::strided: return PairView::Layout::strided;
        case Layout::interleaved: return PairView::Layout::interleaved;
        default: return PairView::Layout::blocked;
    }
}

Input& input(const Case& c)
{
    static std::unique_ptr<Input> latest;
    if (latest && latest->data == c.data && latest->kind == c.kind && latest->layout == c.layout &&
        latest->scalar == c.scalar)
        return *latest;
    latest.reset();
    const Dataset& set = dataset(c.data, c.kind);
    latest = std::make_unique<Input>(Input{c.data, c.kind, c.layout, c.scalar, set.packed.size(), 0, {}, {}, {}, {}, {},
                                           tools::LargeArray<double>{set.packed.size()}});
    if (c.layout == Layout::indexed) {
        latest->mesh = moving_mesh(set.scene.value());
        if (c.kind == PairKind::vertex_face)
            latest->vertex_face = tools::LargeArray{std::span{set.vertex_face}};
        else
            latest->edge_edge = tools::LargeArray{std::span{set.edge_edge}};
        latest->bytes = set.packed.size() * sizeof(VertexFace);
    } else {
        latest->packed.emplace(set.packed, packed_layout(c.layout), c.scalar);
        latest->limit.emplace(latest->packed->streams());
        latest->bytes = latest->limit->bytes();
    }
    return *latest;
}

using Call = std::function<Status(Summary&)>;

/// `first`... are the leading arguments of the public functions: kind and view, or mesh and index pairs.
template <class A, class B>
Call call_of(Question question, const Options& options, A first, B second, std::span<double> toi)
{
    switch (question) {
        case Question::contacts:
            return [=, contacts = std::vector<Contact>{}](Summary& summary) mutable {
                contacts.clear();
                return find_contacts(first.get(), second, options, contacts, nullptr, &summary);
            };
        case Question::earliest:
        case Question::separation_earliest:
            return [=](Summary& summary) {
                return earliest_contact(first.get(), second, options, summary.earliest, &summary);
            };
        case Question::dense:
        case Question::separation: break;
    }
    return [=](Summary& summary) {
        return time_of_impact(first.get(), second, options, toi, &summary);
    };
}

/// At the start; 1 for data that are no scene.
double mean_edge_length(const Dataset& set)
{
    if (!set.scene) return 1.0;
    double sum = 0;
    for (const auto& edge : set.scene->edges) {
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto coordinate = [&](std::int32_t vertex) { return set.scene->start[3 * static_cast<std::size_t>(vertex) + axis]; };
            const double difference = coordinate(edge[1]) - coordinate(edge[0]);
            square += difference * difference;
        }
        sum += std::sqrt(square);
    }
    return sum / static_cast<double>(set.scene->edges.size());
}

Call call_of(const Case& c, Input& in)
{
    Options options;
    options.isa = c.isa;
    if (has_separation(c.question)) options.minimum_separation = bench_separation * mean_edge_length(dataset(c.data, c.kind));
    const std::span<double> toi = in.toi.span();
    if (c.layout != Layout::indexed)
        return call_of(c.question, options, std::cref(in.kind), in.packed->view(), toi);
    if (c.kind == PairKind::vertex_face)
        return call_of(c.question, options, std::cref(in.mesh), std::span<const VertexFace>{in.vertex_face.span()}, toi);
    return call_of(c.question, options, std::cref(in.mesh), std::span<const EdgeEdge>{in.edge_edge.span()}, toi);
}

/// A fast wrong answer is no result: the same pairs must give the same answer in every layout, instruction set and
/// thread count. Float coordinates are other pairs where the data are not float. What other runs answered is compared when they are
/// merged (report.py).
bool same_answer_as_before(const Case& c, const Summary& summary)
{
    using Key = std::tuple<std::string, PairKind, PairView::Scalar, Question>;
    using Answer = std::tuple<std::size_t, std::size_t, double>;
    static std::map<Key, Answer> answers;
    const Answer answer{is_earliest(c.question) ? 0 : summary.contacts, summary.earliest.pair,
                        summary.earliest.toi};
    return answers.try_emplace({c.data, c.kind, c.scalar, c.question}, answer).first->second == answer;
}

double median(std::vector<double>& values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void run(benchmark::State& state, const Case& c)
{
    Input& in = input(c);
    const Call call = call_of(c, in);
    tbb::task_arena arena(c.threads);
    Status status;
    Summary summary;
    const auto answer = [&] {
        summary = {};
        arena.execute([&] { status = call(summary); });
    };
    answer();  // starts the threads and faults in the pages of the result
    if (!status.ok()) return fail(state, message(status.error));
    if (!same_answer_as_before(c, summary)) return fail(state, "another answer than before for the same pairs");

    // The search for the earliest contact need not read all pairs, and indexed pairs are not what it streams.
    const bool streams = in.limit && !is_earliest(c.question);
    std::vector<double> call_seconds, pass_seconds, product_seconds;
    double calls_total = 0.0, products_total = 0.0;
    for ([[maybe_unused]] auto _ : state) {
        const auto begin = std::chrono::steady_clock::now();
        answer();
        call_seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        state.SetIterationTime(call_seconds.back());
        calls_total += call_seconds.back();
        if (streams) pass_seconds.push_back(in.limit->pass(arena));
        if (products_total <= calls_total) {  // calls may be of 0.1 ms, and many
            product_seconds.push_back(multiply(arena));
            products_total += product_seconds.back();
        }
    }

    using benchmark::Counter;
    state.counters["pairs/s"] = Counter(static_cast<double>(in.pairs), Counter::kIsIterationInvariantRate);
    if (!is_earliest(c.question))
        state.counters["bytes/s"] = Counter(static_cast<double>(in.bytes), Counter::kIsIterationInvariantRate);
    if (streams) {
        const double limit_seconds = median(pass_seconds);
        state.counters["limit_bytes/s"] = static_cast<double>(in.bytes) / limit_seconds;
        state.counters["limit_fraction"] = limit_seconds / median(call_seconds);
    }
    state.counters["products/s"] = products_per_pass / median(product_seconds);
    state.counters["pairs"] = static_cast<double>(in.pairs);
    if (!is_earliest(c.question)) state.counters["contacts"] = static_cast<double>(summary.contacts);
    state.counters["earliest_pair"] = static_cast<double>(summary.earliest.pair);
    state.counters["earliest_toi"] = summary.earliest.toi;
    state.counters["scalar_share"] = static_cast<double>(summary.scalar_pairs) / static_cast<double>(in.pairs);
}

/// Turning positions into a MovingMesh is not part of the indexed cases: it is done once per step for both kinds.
void make_mesh(const SceneStep& scene, double& seconds)
{
    const auto begin = std::chrono::steady_clock::now();
    const MovingMesh mesh = moving_mesh(scene);
    benchmark::DoNotOptimize(mesh.records());
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Nor are the boxes of its faces and edges, which the first call makes.
void make_boxes(const SceneStep& scene, double& seconds)
{
    const MovingMesh mesh = moving_mesh(scene);
    const IndexedSource faces = indexed(mesh, std::span<const VertexFace>{}).source.indexed;
    const IndexedSource edges = indexed(mesh, std::span<const EdgeEdge>{}).source.indexed;
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& [kind, source] : {std::pair{PairKind::vertex_face, faces}, std::pair{PairKind::edge_edge, edges}})
        benchmark::DoNotOptimize(mesh.boxes()->screen(kind, source, std::numeric_limits<std::size_t>::max(), 0.0).first);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void run_mesh(benchmark::State& state, const std::string& data, void (*make)(const SceneStep&, double&))
{
    const SceneStep& scene = dataset(data, PairKind::vertex_face).scene.value();
    for ([[maybe_unused]] auto _ : state) {
        double seconds = 0.0;
        make(scene, seconds);
        state.SetIterationTime(seconds);
    }
    const auto vertices = static_cast<double>(scene.start.size() / 3);
    state.counters["vertices"] = vertices;
    state.counters["vertices/s"] = benchmark::Counter(vertices, benchmark::Counter::kIsIterationInvariantRate);
}

void register_benchmarks(bool filtered)
{
    for (const Case& c : all_cases())
        if (filtered || in_default_selection(c))
            benchmark::RegisterBenchmark(name(c).c_str(), [c](benchmark::State& state) { run(state, c); })
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
    for (const std::string& data : available_datasets())
        if (is_scene(data))
            for (const bool boxes : {false, true})
                benchmark::RegisterBenchmark(((boxes ? "mesh_boxes/" : "moving_mesh/") + data).c_str(),
                                             [=](benchmark::State& state) { run_mesh(state, data, boxes ? make_boxes : make_mesh); })
                    ->UseManualTime()
                    ->Unit(benchmark::kMillisecond);
    register_query_benchmarks();
}

}  // namespace

}  // namespace fastccd::bench

int main(int argc, char** argv) { return fastccd::bench::run_benchmarks(argc, argv, fastccd::bench::register_benchmarks); }
