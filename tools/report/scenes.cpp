#include <algorithm>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fastccd/isa.hpp>
#include <tbb/task_arena.h>

#include "../interrupt.hpp"
#include "../scene/frames.hpp"
#include "../scene/make_scene.hpp"
#include "../scene/step_mesh.hpp"
#include "cubic_share.hpp"
#include "parts.hpp"

namespace fastccd::tools::report {
namespace {

namespace fs = std::filesystem;

/// A scene that hands out its steps.
struct Scene {
    std::string name;
    const char* source;
    std::size_t steps;
    std::function<void(const std::function<void(const Step&)>&)> for_each_step;
};

Scene generated_scene(const Plan& plan)
{
    const auto frames = static_cast<std::size_t>(plan.cloth_frames());
    return {"cloth on a ball", "generated", frames - 1, [&plan](const auto& visit) {
                const ClothBall cloth{plan.cloth_size(), plan.cloth_frames()};
                const std::vector<Edge> edges = unique_edges(cloth.faces());
                std::vector<double> start = cloth.positions(0);
                for (int frame = 1; frame < cloth.frames(); ++frame) {
                    std::vector<double> end = cloth.positions(frame);
                    visit(Step{start, end, cloth.faces(), edges});
                    start = std::move(end);
                }
            }};
}

/// Every folder of DATA/scenes that holds mesh frames; in order of time by their names, shorter ones first (9 before 10).
std::vector<Scene> public_scenes(const fs::path& data)
{
    std::vector<Scene> scenes;
    if (!fs::is_directory(data / "scenes")) return scenes;
    for (const auto& folder : fs::directory_iterator{data / "scenes"}) {
        if (!folder.is_directory()) continue;
        std::vector<std::string> frames;
        for (const auto& file : fs::directory_iterator{folder}) {
            if (named_as_mesh(file.path())) frames.push_back(file.path().string());
        }
        if (frames.size() < 2) continue;
        std::ranges::sort(frames, {}, [](const std::string& path) { return std::pair{path.size(), path}; });
        scenes.push_back({folder.path().filename().string(), "data", frames.size() - 1, [frames](const auto& visit) {
                              Frames reader{frames};
                              for (std::size_t i = 0; i < reader.step_count(); ++i) visit(reader.next_step());
                          }});
    }
    std::ranges::sort(scenes, {}, &Scene::name);
    return scenes;
}

void find(const Step& step, const VertexFaceSink& sink) { find_vertex_face(step, sink); }
void find(const Step& step, const EdgeEdgeSink& sink) { find_edge_edge(step, sink); }

/// Of one kind in one step.
template <class Pair>
Json kind_json(const Step& step, const MovingMesh& mesh, std::size_t repeats, bool each_isa)
{
    std::vector<Pair> pairs;
    Timing broad, narrow;
    broad.add(seconds_of([&] {
        find(step, [&](std::span<const Pair> piece) {
            check_interrupt();
            pairs.insert(pairs.end(), piece.begin(), piece.end());
        });
    }));
    const std::span<const Pair> candidates{pairs};
    std::vector<Contact> contacts;
    Summary summary;
    const auto answer = [&](const Options& options, int threads) {
        check_interrupt();
        return seconds_on(threads, [&] {
            contacts.clear();
            throw_unless_ok(find_contacts(mesh, candidates, options, contacts, nullptr, &summary));
        });
    };
    const int all_threads = tbb::this_task_arena::max_concurrency();
    for (std::size_t repeat = 0; repeat <= repeats; ++repeat) {
        const double seconds = answer({}, all_threads);
        if (repeat > 0) narrow.add(seconds);
    }
    const CubicShare share = cubic_share(step, candidates);
    Json json{{"candidates", pairs.size()},  {"contacts", summary.contacts},
              {"proven", summary.proven},    {"certified_search", summary.scalar_pairs},
              {"all_zero", share.all_zero},  {"no_cube", share.no_cube},
              {"broad_phase", broad.json()}, {"narrow_phase", narrow.json(pairs.size())}};
    if (!each_isa) return json;
    json["speeds"] = Json::array();
    for (const Isa isa : available()) {
        std::vector<int> counts{1, all_threads};
        counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
        for (const int threads : counts) {
            Options options;
            options.isa = isa;
            Timing timing;
            for (std::size_t repeat = 0; repeat < repeats; ++repeat) timing.add(answer(options, threads));
            json["speeds"].push_back({{"isa", name(isa)}, {"threads", threads}, {"timing", timing.json(pairs.size())}});
        }
    }
    return json;
}

Json scene_json(const Scene& scene, std::size_t repeats, const std::function<void(std::size_t)>& done)
{
    Json json{{"name", scene.name}, {"source", scene.source}, {"vertices", 0}, {"faces", 0},
              {"edges", 0},         {"steps", Json::array()}};
    std::size_t number = 0;
    scene.for_each_step([&](const Step& step) {
        done(number++);
        json["vertices"] = step.positions0.size() / 3;
        json["faces"] = step.faces.size() / 3;
        json["edges"] = step.edges.size();
        const bool last = number == scene.steps;
        Json kinds_json;
        Timing mesh_timing;
        MovingMesh mesh;
        for (std::size_t repeat = 0; repeat < repeats; ++repeat) mesh_timing.add(seconds_of([&] { mesh = moving_mesh(step); }));
        kinds_json["moving_mesh"] = mesh_timing.json();
        kinds_json["vf"] = kind_json<VertexFace>(step, mesh, repeats, last);
        kinds_json["ee"] = kind_json<EdgeEdge>(step, mesh, repeats, last);
        json["steps"].push_back(std::move(kinds_json));
    });
    return json;
}

/// The paper's Table 2, of its own method: E_tol 1e-9, one core of 2014.
Json paper_scenes()
{
    const auto row = [](const char* name, int frames, std::size_t pairs, double all_zero, double no_cube, std::size_t contacts,
                        double seconds) {
        return Json{{"name", name},
                    {"frames", frames},
                    {"candidates", pairs},
                    {"all_zero_share", all_zero},
                    {"no_cube_share", no_cube},
                    {"contacts", contacts},
                    {"seconds", seconds}};
    };
    return {row("Lion", 44, 227'217'729, 0.00001, 0.05, 1'734'172, 35.6),
            row("Cloth-ball", 93, 31'170'312, 0.11, 0.003, 65'182, 6.4),
            row("N-Body (Balls_16)", 75, 427'022'018, 0, 0.79, 288'694, 64.8),
            row("Dragon-Bunny", 15, 1'343'153'663, 0, 0.005, 2'836'492, 280.3)};
}

}  // namespace

void check_scenes(const fs::path& data)
{
    for (const Scene& scene : public_scenes(data)) scene.for_each_step([](const Step&) { check_interrupt(); });
}

Json scenes(const Plan& plan, ReportProgress& progress)
{
    std::vector<Scene> all{generated_scene(plan)};
    if (plan.data) std::ranges::move(public_scenes(*plan.data), std::back_inserter(all));
    std::size_t steps = 0, before = 0;
    for (const Scene& scene : all) steps += scene.steps;
    Json result{{"tolerance", Options{}.tolerance},
                {"isa", name(resolve_isa({}))},
                {"threads", tbb::this_task_arena::max_concurrency()},
                {"paper", paper_scenes()},
                {"scenes", Json::array()}};
    for (const Scene& scene : all) {
        result["scenes"].push_back(scene_json(scene, std::min<std::size_t>(plan.repeats(), 5),
                                              [&](std::size_t done) { progress.move(before + done, steps); }));
        before += scene.steps;
    }
    return result;
}

}  // namespace fastccd::tools::report
