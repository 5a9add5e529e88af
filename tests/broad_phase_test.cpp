#include "tools/scene/broad_phase.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "amount.hpp"
#include "test_data.hpp"
#include "tools/interrupt.hpp"
#include "tools/scene/box_tree.hpp"
#include "tools/scene/id_sorter.hpp"
#include "tools/scene/mesh_io.hpp"

namespace fastccd {

// In the namespace of the types, where GoogleTest looks.
void PrintTo(const VertexFace& pair, std::ostream* out)
{
    *out << pair.vertex << "/" << pair.face;
}
void PrintTo(const EdgeEdge& pair, std::ostream* out)
{
    *out << pair.edge_a << "/" << pair.edge_b;
}

namespace tools {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A mesh at two frames that owns its arrays.
struct Scene {
    std::vector<double> positions0;
    std::vector<double> positions1;
    std::vector<std::int32_t> faces;
    std::vector<Edge> edges;

    [[nodiscard]] Step step() const { return {positions0, positions1, faces, edges}; }
};

// The definition of a candidate, word by word, over all pairs.
bool boxes_overlap(const Scene& scene, std::vector<std::int32_t> a, std::vector<std::int32_t> b)
{
    for (const std::int32_t vertex : a) {
        if (std::find(b.begin(), b.end(), vertex) != b.end()) return false;
    }
    const auto range = [&scene](const std::vector<std::int32_t>& vertices, std::size_t axis) {
        double low = infinity;
        double high = -infinity;
        for (const std::int32_t vertex : vertices) {
            for (const auto* positions : {&scene.positions0, &scene.positions1}) {
                const double x = (*positions)[3 * static_cast<std::size_t>(vertex) + axis];
                low = std::min(low, x);
                high = std::max(high, x);
            }
        }
        return std::pair(low, high);
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low_a, high_a] = range(a, axis);
        const auto [low_b, high_b] = range(b, axis);
        if (!(low_a <= high_b && low_b <= high_a)) return false;
    }
    return true;
}

std::vector<VertexFace> all_vertex_face(const Scene& scene)
{
    std::vector<VertexFace> pairs;
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(scene.positions0.size() / 3); ++v) {
        for (std::size_t f = 0; f < scene.faces.size() / 3; ++f) {
            const std::int32_t* const c = &scene.faces[3 * f];
            if (boxes_overlap(scene, {v}, {c[0], c[1], c[2]}))
                pairs.push_back({v, static_cast<std::int32_t>(f)});
        }
    }
    return pairs;
}

std::vector<EdgeEdge> all_edge_edge(const Scene& scene)
{
    std::vector<EdgeEdge> pairs;
    for (std::size_t a = 0; a < scene.edges.size(); ++a) {
        for (std::size_t b = a + 1; b < scene.edges.size(); ++b) {
            const Edge& ea = scene.edges[a];
            const Edge& eb = scene.edges[b];
            if (boxes_overlap(scene, {ea[0], ea[1]}, {eb[0], eb[1]})) {
                pairs.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
            }
        }
    }
    return pairs;
}

// Random triangles over shared vertices. `draw()` gives a coordinate.
template <class Draw>
Scene random_scene(std::mt19937& random, int vertex_count, int face_count, Draw draw)
{
    Scene scene;
    for (int i = 0; i < 3 * vertex_count; ++i) {
        scene.positions0.push_back(draw());
        scene.positions1.push_back(draw());
    }
    std::uniform_int_distribution<std::int32_t> vertex(0, vertex_count - 1);
    for (int i = 0; i < 3 * face_count; ++i) scene.faces.push_back(vertex(random));
    scene.edges = unique_edges(scene.faces);
    return scene;
}

void expect_exact(const Scene& scene)
{
    EXPECT_EQ(vertex_face_candidates(scene.step()), all_vertex_face(scene));
    EXPECT_EQ(edge_edge_candidates(scene.step()), all_edge_edge(scene));
}

TEST(BroadPhase, EqualsAllPairsOnRandomMeshes)
{
    std::mt19937 random(1);
    // Vertex counts around the width of the tree's nodes, where its last lanes are empty.
    for (const int vertices : {1, 2, 3, 4, 7, 8, 9, 20, 65, 100, 300}) {
        for (const double size : {0.05, 1.0}) {
            // Small movements around scattered places, so that some boxes overlap and some do not.
            std::uniform_real_distribution<double> place(-1, 1);
            Scene scene =
                random_scene(random, vertices, 2 * vertices, [&] { return place(random); });
            for (std::size_t i = 0; i < scene.positions0.size(); ++i) {
                scene.positions1[i] = scene.positions0[i] + size * scene.positions1[i];
            }
            expect_exact(scene);
        }
    }
}

TEST(BroadPhase, EqualsAllPairsOnTouchingAndFlatBoxes)
{
    std::mt19937 random(2);
    // Few integer values: most boxes touch in a face, edge or corner, or are flat in some axis.
    // -0.0 and 0.0 are equal, and so they touch.
    const std::array<double, 5> values{-1, -0.0, 0.0, 1, 2};
    std::uniform_int_distribution<std::size_t> pick(0, values.size() - 1);
    for (int round = 0; round < 20; ++round) {
        Scene scene = random_scene(random, 40, 30, [&] { return values[pick(random)]; });
        if (round % 2 == 0) scene.positions1 = scene.positions0;  // at rest
        if (round % 4 == 0) {
            for (std::size_t i = 2; i < scene.positions0.size(); i += 3)
                scene.positions0[i] = scene.positions1[i] = 0;
        }
        expect_exact(scene);
    }
}

TEST(BroadPhase, OneUlpDecides)
{
    // A vertex beside a triangle: touching counts, the next double beyond does not.
    Scene scene{{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0.5, 0}, {}, {0, 1, 2}, {}};
    scene.positions1 = scene.positions0;
    EXPECT_EQ(vertex_face_candidates(scene.step()), (std::vector<VertexFace>{{3, 0}}));
    scene.positions0[9] = scene.positions1[9] = std::nextafter(1.0, 2.0);
    EXPECT_TRUE(vertex_face_candidates(scene.step()).empty());
}

/// Every pair whose boxes are at most `separation` apart along each axis, and none that is farther by more than rounding.
TEST(BroadPhase, SeparationGrowsTheBoxes)
{
    std::mt19937_64 random{14};
    std::uniform_real_distribution<double> draw{-1.0, 1.0};
    Scene scene;
    for (int i = 0; i < 3 * 60; ++i) scene.positions0.push_back(draw(random));
    for (const double x : scene.positions0) scene.positions1.push_back(x + 0.05 * draw(random));
    for (std::int32_t v = 0; v < 60; ++v) scene.edges.push_back({v, (v + 1) % 60});
    const auto gap = [&](const Edge& a, const Edge& b) {
        double largest = -infinity;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
            for (std::size_t side = 0; side < 2; ++side)
                for (const std::int32_t vertex : side == 0 ? a : b)
                    for (const auto* positions : {&scene.positions0, &scene.positions1}) {
                        const double x = (*positions)[3 * static_cast<std::size_t>(vertex) + axis];
                        low[side] = std::min(low[side], x);
                        high[side] = std::max(high[side], x);
                    }
            largest = std::max({largest, low[0] - high[1], low[1] - high[0]});
        }
        return largest;
    };
    std::size_t before = edge_edge_candidates(scene.step()).size();
    for (const double separation : {0.1, 0.3, 1.0}) {
        Step step = scene.step();
        step.separation = separation;
        const std::vector<EdgeEdge> found = edge_edge_candidates(step);
        EXPECT_GT(found.size(), before);
        before = found.size();
        std::size_t next = 0;
        for (std::int32_t a = 0; a < 60; ++a)
            for (std::int32_t b = a + 1; b < 60; ++b) {
                const Edge& ea = scene.edges[static_cast<std::size_t>(a)];
                const Edge& eb = scene.edges[static_cast<std::size_t>(b)];
                if (ea[0] == eb[1] || ea[1] == eb[0]) continue;
                const bool candidate = next < found.size() && found[next].edge_a == a && found[next].edge_b == b;
                next += candidate;
                EXPECT_TRUE(candidate ? gap(ea, eb) <= separation + 1e-15 : gap(ea, eb) > separation) << a << ' ' << b;
            }
        EXPECT_EQ(next, found.size());
    }
}

TEST(BroadPhase, ExtremeScalesAndFarOutliers)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> exponent(-320, 308);
    std::bernoulli_distribution negative(0.5);
    const auto any_scale = [&] {
        return (negative(random) ? -1 : 1) * std::pow(10.0, exponent(random));
    };
    for (int round = 0; round < 5; ++round) expect_exact(random_scene(random, 50, 60, any_scale));

    std::uniform_real_distribution<double> place(-1, 1);
    Scene scene = random_scene(random, 100, 100, [&] { return place(random); });
    scene.positions0[0] = std::numeric_limits<double>::max();
    scene.positions1[0] = -std::numeric_limits<double>::max();
    expect_exact(scene);
}

TEST(BroadPhase, NonFinitePrimitivesHaveNoCandidatesAndAreNamed)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(-1, 1);
    const Scene clean = random_scene(random, 60, 80, [&] { return place(random); });
    Scene scene = clean;
    scene.positions0[3 * 7 + 1] = nan;
    scene.positions1[3 * 20] = infinity;
    scene.positions0[3 * 20] = -infinity;
    scene.positions1[3 * 59 + 2] = -infinity;
    const std::vector<std::int32_t> bad{7, 20, 59};
    EXPECT_EQ(non_finite_vertices(scene.positions0, scene.positions1), bad);
    EXPECT_TRUE(non_finite_vertices(clean.positions0, clean.positions1).empty());

    // What is left are the candidates of the clean scene without those vertices.
    const auto is_bad = [&](std::int32_t v) {
        return std::find(bad.begin(), bad.end(), v) != bad.end();
    };
    std::vector<VertexFace> vertex_face = all_vertex_face(clean);
    std::erase_if(vertex_face, [&](const VertexFace& pair) {
        const std::int32_t* const c = &scene.faces[3 * static_cast<std::size_t>(pair.face)];
        return is_bad(pair.vertex) || is_bad(c[0]) || is_bad(c[1]) || is_bad(c[2]);
    });
    std::vector<EdgeEdge> edge_edge = all_edge_edge(clean);
    std::erase_if(edge_edge, [&](const EdgeEdge& pair) {
        const Edge& a = scene.edges[static_cast<std::size_t>(pair.edge_a)];
        const Edge& b = scene.edges[static_cast<std::size_t>(pair.edge_b)];
        return is_bad(a[0]) || is_bad(a[1]) || is_bad(b[0]) || is_bad(b[1]);
    });
    EXPECT_EQ(vertex_face_candidates(scene.step()), vertex_face);
    EXPECT_EQ(edge_edge_candidates(scene.step()), edge_edge);

    std::fill(scene.positions0.begin(), scene.positions0.end(), nan);
    EXPECT_TRUE(vertex_face_candidates(scene.step()).empty());
    EXPECT_TRUE(edge_edge_candidates(scene.step()).empty());
}

TEST(BroadPhase, OrderAndPiecesDoNotDependOnThreads)
{
    std::mt19937 random(5);
    // Small triangles, each of its own three vertices, scattered through a cube.
    std::uniform_real_distribution<double> place(-1, 1);
    Scene scene;
    for (int triangle = 0; triangle < 7000; ++triangle) {
        const std::array<double, 3> centre{place(random), place(random), place(random)};
        for (int i = 0; i < 9; ++i) {
            const double x = centre[static_cast<std::size_t>(i % 3)] + 0.1 * place(random);
            scene.positions0.push_back(x);
            scene.positions1.push_back(x + 0.02 * place(random));
            if (i % 3 == 0) scene.faces.push_back(static_cast<std::int32_t>(scene.faces.size()));
        }
    }
    scene.edges = unique_edges(scene.faces);

    using Pieces = std::vector<std::vector<EdgeEdge>>;
    const auto run = [&scene](int threads) {
        Pieces pieces;
        tbb::task_arena arena(threads);
        arena.execute([&] {
            find_edge_edge(scene.step(), [&](std::span<const EdgeEdge> piece) {
                pieces.emplace_back(piece.begin(), piece.end());
            });
        });
        return pieces;
    };
    // More threads than a small machine has processors are wanted here.
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    const Pieces one = run(1);
    ASSERT_GT(one.size(), 2U) << "several pieces, or nothing is shown";
    for (const int threads : {2, 4}) EXPECT_TRUE(run(threads) == one) << threads << " threads";
    EXPECT_TRUE(std::is_sorted(one[0].begin(), one[0].end()));
    EXPECT_LT(one[0].back(), one[1].front());
}

// Triangles, each of three vertices of its own. On every axis one stays below -1, one above 1, and one goes from above 1 to below
// -1: the box of each edge and each face holds the cube between, so all overlap.
Scene dense_scene(std::size_t triangles)
{
    std::mt19937 random(8);
    std::uniform_real_distribution<double> place(0, 1);
    Scene scene;
    for (std::size_t i = 0; i < 9 * triangles; ++i) {
        const double x = i / 3 % 3 == 0 ? -1 - place(random) : 1 + place(random);
        scene.positions0.push_back(x);
        scene.positions1.push_back(i / 3 % 3 == 2 ? -x : x);
        if (i % 3 == 0) scene.faces.push_back(static_cast<std::int32_t>(i / 3));
    }
    scene.edges = unique_edges(scene.faces);
    return scene;
}

/// No more than the million candidates that a round aims at: 64 edges alone have 288,000 here.
TEST(BroadPhase, PiecesOfDenseMeshesAreSmallFromTheFirst)
{
    const Scene scene = dense_scene(testing::amount(1500));
    std::size_t found = 0, largest = 0;
    find_edge_edge(scene.step(), [&](std::span<const EdgeEdge> piece) {
        found += piece.size();
        largest = std::max(largest, piece.size());
    });
    EXPECT_GT(found, scene.edges.size() * scene.edges.size() / 4);
    EXPECT_LE(largest, std::size_t{1} << 20);
}

/// In a process of its own, which has just been told of the signal when the search begins.
TEST(BroadPhaseDeathTest, SignalsEndThePieceInWork)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const Scene scene = dense_scene(30);
    const auto search = [&scene] {
        install_signal_handlers();
        std::raise(SIGINT);
        try {
            find_edge_edge(scene.step(), [](auto) { std::_Exit(2); });
        } catch (const Interrupted& interrupted) {
            std::_Exit(interrupted.signal == SIGINT ? 0 : 3);
        }
        std::_Exit(1);
    };
    EXPECT_EXIT(search(), ::testing::ExitedWithCode(0), "");
}

TEST(BroadPhase, ExceptionOfTheSinkPassesThrough)
{
    const Scene scene{
        {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0}, {0, 1, 2}, {}};
    EXPECT_THROW(find_vertex_face(scene.step(), [](auto) { throw std::runtime_error("stop"); }),
                 std::runtime_error);
}

TEST(BroadPhase, NothingInNothingOut)
{
    const Scene nothing;
    EXPECT_TRUE(vertex_face_candidates(nothing.step()).empty());
    EXPECT_TRUE(edge_edge_candidates(nothing.step()).empty());
    const Scene points{{0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, {}, {}};
    EXPECT_TRUE(vertex_face_candidates(points.step()).empty());
}

TEST(BroadPhase, RefusesArraysThatDoNotFit)
{
    Scene scene{{0, 0, 0, 1, 0, 0, 0, 1, 0},
                {0, 0, 0, 1, 0, 0, 0, 1, 0},
                {0, 1, 2},
                {{0, 1}, {0, 2}, {1, 2}}};
    EXPECT_NO_THROW((void)vertex_face_candidates(scene.step()));
    scene.faces[2] = 3;
    EXPECT_THROW((void)vertex_face_candidates(scene.step()), std::invalid_argument);
    scene.faces[2] = -1;
    EXPECT_THROW((void)vertex_face_candidates(scene.step()), std::invalid_argument);
    scene.faces.pop_back();
    EXPECT_THROW((void)vertex_face_candidates(scene.step()), std::invalid_argument);
    scene.edges[1][1] = 3;
    EXPECT_THROW((void)edge_edge_candidates(scene.step()), std::invalid_argument);
    scene.positions1.pop_back();
    EXPECT_THROW((void)edge_edge_candidates(scene.step()), std::invalid_argument);
    EXPECT_THROW((void)non_finite_vertices(scene.positions0, scene.positions1),
                 std::invalid_argument);
}

TEST(IdSorter, SortsLikeStdSort)
{
    std::mt19937 random(6);
    for (const std::size_t limit : {1U, 64U, 65U, 4096U, 4097U, 300000U}) {
        IdSorter sorter(limit);
        std::vector<std::int32_t> all(limit);
        std::iota(all.begin(), all.end(), 0);
        for (const std::size_t count : {1U, 15U, 16U, 17U, 100U, 5000U}) {
            std::shuffle(all.begin(), all.end(), random);
            std::vector<std::int32_t> ids(
                all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(count, limit)));
            std::vector<std::int32_t> expected = ids;
            std::sort(expected.begin(), expected.end());
            sorter.sort(ids);
            EXPECT_EQ(ids, expected);
        }
    }
}

// Simulation scenes with known candidate counts; the data comes with its own README.
struct KnownScene {
    std::string frame0;
    std::string frame1;
    std::size_t edges;
    std::size_t vertex_face;
    std::size_t edge_edge;
};

TEST(BroadPhase, CountsOnPublicScenes)
{
    const auto data = testing::data_directory();
    if (!data || !std::filesystem::is_directory(*data / "scenes")) GTEST_SKIP() << testing::no_data_message;
    const std::filesystem::path scenes = *data / "scenes";
    const std::array<KnownScene, 3> known{{
        {"cloth-ball/cloth_ball92.ply", "cloth-ball/cloth_ball93.ply", 138825, 1655541, 5197332},
        {"n-body-simulation/balls16_18.ply", "n-body-simulation/balls16_19.ply", 219840, 9396388,
         22366873},
        {"cloth-funnel/227.ply", "cloth-funnel/228.ply", 27930, 7319, 33770},
    }};
    for (const KnownScene& scene : known) {
        if (testing::too_large_for_sanitizers(scene.edge_edge)) continue;
        SCOPED_TRACE(scene.frame0);
        const Mesh mesh0 = read_mesh(scenes / scene.frame0);
        const Mesh mesh1 = read_mesh(scenes / scene.frame1);
        ASSERT_EQ(mesh0.faces, mesh1.faces);
        const std::vector<Edge> edges = unique_edges(mesh0.faces);
        EXPECT_EQ(edges.size(), scene.edges);
        const Step step{mesh0.positions, mesh1.positions, mesh0.faces, edges};
        std::size_t vertex_face = 0;
        find_vertex_face(step,
                         [&](std::span<const VertexFace> piece) { vertex_face += piece.size(); });
        EXPECT_EQ(vertex_face, scene.vertex_face);
        std::size_t edge_edge = 0;
        find_edge_edge(step, [&](std::span<const EdgeEdge> piece) { edge_edge += piece.size(); });
        EXPECT_EQ(edge_edge, scene.edge_edge);
    }
}

}  // namespace
}  // namespace tools
}  // namespace fastccd
