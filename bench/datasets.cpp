#include "datasets.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <random_pairs.hpp>
#include <scene/broad_phase.hpp>
#include <scene/make_scene.hpp>
#include <scene/mesh_io.hpp>
#include <scene/pair_vertices.hpp>
#include <test_data.hpp>

namespace fastccd::bench {

namespace {

namespace fs = std::filesystem;

/// 384 MB packed, far beyond any cache. Odd, and so is the number of cache lines of an array of that many
/// doubles: 24 of them one after the other do not fall into the same sets of the cache.
constexpr std::size_t random_pairs = 2'000'001;
constexpr std::uint64_t random_seed = 1;

/// Vertices along a side of the generated cloth: as many pairs, roughly, as the public cloth-ball step has.
constexpr int generated_size = 500;

/// Vertices along a side of a sheet of "grids".
constexpr int grid_size = 200;

struct PublicScene {
    const char* name;
    const char* start;
    const char* end;
};
constexpr PublicScene public_scenes[] = {
    {"cloth-ball", "scenes/cloth-ball/cloth_ball92.ply", "scenes/cloth-ball/cloth_ball93.ply"},
    {"n-body", "scenes/n-body-simulation/balls16_18.ply", "scenes/n-body-simulation/balls16_19.ply"},
    {"cloth-funnel", "scenes/cloth-funnel/227.ply", "scenes/cloth-funnel/228.ply"},
};

SceneStep generated_scene()
{
    const tools::ClothBall scene{generated_size, 2};
    return {scene.positions(0), scene.positions(1), scene.faces(), tools::unique_edges(scene.faces())};
}

/// Two horizontal sheets of the same grid, of which the upper one falls through the lower one: every contact is at a side, at an
/// end, or along an edge.
SceneStep grids()
{
    SceneStep step;
    for (int sheet = 0; sheet < 2; ++sheet)
        for (int i = 0; i < grid_size; ++i)
            for (int j = 0; j < grid_size; ++j) {
                step.start.insert(step.start.end(), {static_cast<double>(i), static_cast<double>(j), static_cast<double>(sheet)});
                step.end.insert(step.end.end(), {static_cast<double>(i), static_cast<double>(j), sheet == 0 ? 0.0 : -0.7});
                const std::int32_t k = (sheet * grid_size + i) * grid_size + j;
                if (i + 1 < grid_size && j + 1 < grid_size)
                    step.faces.insert(step.faces.end(), {k, k + 1, k + grid_size, k + 1, k + grid_size + 1, k + grid_size});
            }
    step.edges = tools::unique_edges(step.faces);
    return step;
}

SceneStep public_scene(const PublicScene& scene)
{
    const fs::path data = testing::data_directory().value();
    tools::Mesh start = tools::read_mesh(data / scene.start);
    tools::Mesh end = tools::read_mesh(data / scene.end);
    if (start.faces != end.faces) throw std::runtime_error(std::string(scene.name) + ": the frames have different faces");
    SceneStep step{std::move(start.positions), std::move(end.positions), std::move(start.faces), {}};
    step.edges = tools::unique_edges(step.faces);
    return step;
}

SceneStep make_scene(const std::string& name)
{
    if (name == "generated") return generated_scene();
    if (name == "grids") return grids();
    for (const PublicScene& scene : public_scenes)
        if (name == scene.name) return public_scene(scene);
    throw std::runtime_error("no data set is called " + name);
}

/// Packs pairs of which points(i) gives the four vertices.
template <class Points>
PairBuffer pack(const SceneStep& scene, std::size_t size, Points points)
{
    PairBuffer packed{size};
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const std::array<std::int32_t, 4> vertices = points(i);
            for (std::size_t c = 0; c < pair_coordinates; ++c) {
                const std::vector<double>& positions = c < 12 ? scene.start : scene.end;
                const auto vertex = static_cast<std::size_t>(vertices[c % 12 / 3]);
                packed.at(i, c) = positions[3 * vertex + c % 3];
            }
        }
    });
    return packed;
}

template <class Pair>
void cap(std::vector<Pair>& pairs)
{
    if (pairs.size() > most_pairs) pairs.resize(most_pairs);
    pairs.shrink_to_fit();
}

void add_pairs(Dataset& set, SceneStep scene)
{
    const tools::Step step{scene.start, scene.end, scene.faces, scene.edges};
    if (set.kind == PairKind::vertex_face) {
        set.vertex_face = tools::vertex_face_candidates(step);
        cap(set.vertex_face);
        set.packed = pack(scene, set.vertex_face.size(), [&](std::size_t i) { return tools::pair_vertices(step, set.vertex_face[i]); });
    } else {
        set.edge_edge = tools::edge_edge_candidates(step);
        cap(set.edge_edge);
        set.packed = pack(scene, set.edge_edge.size(), [&](std::size_t i) { return tools::pair_vertices(step, set.edge_edge[i]); });
    }
    set.scene = std::move(scene);
}

}  // namespace

std::vector<std::string> available_datasets()
{
    std::vector<std::string> names{"random", "generated", "grids"};
    if (const auto data = testing::data_directory())
        for (const PublicScene& scene : public_scenes)
            if (fs::exists(*data / scene.start) && fs::exists(*data / scene.end)) names.emplace_back(scene.name);
    return names;
}

bool is_scene(const std::string& dataset) { return dataset != "random"; }

const Dataset& dataset(const std::string& name, PairKind kind)
{
    static std::unique_ptr<Dataset> latest;
    if (latest && latest->name == name && latest->kind == kind) return *latest;
    latest.reset();  // before the next one is built: both together may not fit
    auto set = std::make_unique<Dataset>();
    set->name = name;
    set->kind = kind;
    if (is_scene(name)) {
        add_pairs(*set, make_scene(name));
    } else {
        set->packed = PairBuffer{random_pairs};
        tools::fill_random_pairs(random_seed, 0, set->packed);
    }
    latest = std::move(set);
    return *latest;
}

}  // namespace fastccd::bench
