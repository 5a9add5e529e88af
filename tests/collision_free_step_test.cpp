// The step for a line search: the minimum over both kinds of candidates, whatever the threads; what stops it.
#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>

#include <shared_best.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

constexpr std::size_t no_pair = std::numeric_limits<std::size_t>::max();

std::vector<oracle::Pair> mixed(oracle::Kind kind, std::uint64_t seed, std::size_t per_family)
{
    std::vector<oracle::Pair> pairs, made;
    for (const std::string& family : families()) {
        generate(family, kind, seed, per_family, made);
        pairs.insert(pairs.end(), made.begin(), made.end());
    }
    return pairs;
}

/// Pairs of `pairs` whose toi is not below `least`.
std::vector<oracle::Pair> without_early(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, double least)
{
    const Answer dense = answer(kind, interleaved(pairs), {});
    std::vector<oracle::Pair> kept;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (!(dense.toi[i] < least)) kept.push_back(pairs[i]);
    return kept;
}

/// From the two dense answers.
CollisionFreeStep expected_step(const std::vector<oracle::Pair>& faces, const std::vector<oracle::Pair>& edges, const Options& options)
{
    const Contact face = answer(oracle::Kind::vertex_face, interleaved(faces), options).summary.earliest;
    const Contact edge = answer(oracle::Kind::edge_edge, interleaved(edges), options).summary.earliest;
    if (face.pair == no_pair && edge.pair == no_pair) return {options.t_max};
    if (face.toi <= edge.toi) return {face.toi, PairKind::vertex_face, face.pair};
    return {edge.toi, PairKind::edge_edge, edge.pair};
}

void expect_step(const std::vector<oracle::Pair>& faces, const std::vector<oracle::Pair>& edges, const Options& options)
{
    const CollisionFreeStep expected = expected_step(faces, edges, options);
    CollisionFreeStep found{7.0, PairKind::edge_edge, 7};
    ASSERT_TRUE(collision_free_step(interleaved(faces), interleaved(edges), options, found).ok());
    EXPECT_EQ(found.step, expected.step);
    EXPECT_EQ(found.kind, expected.kind);
    EXPECT_EQ(found.pair, expected.pair);
    EXPECT_EQ(found.limited(), expected.pair != no_pair);
}

TEST(CollisionFreeStep, IsTheMinimumOverBothKinds)
{
    const auto faces = mixed(oracle::Kind::vertex_face, 91, 40), edges = mixed(oracle::Kind::edge_edge, 91, 40);
    bool by_face = false, by_edge = false;
    for (const double least_face : {0.0, 1e-3, 0.5, 2.0})
        for (const double least_edge : {0.0, 1e-3, 0.4, 2.0}) {
            const auto some_faces = without_early(oracle::Kind::vertex_face, faces, least_face);
            const auto some_edges = without_early(oracle::Kind::edge_edge, edges, least_edge);
            for (const Isa isa : isas_to_test())
                for (const double t_max : {1.0, 0.45}) {
                    Options options;
                    options.isa = isa;
                    options.t_max = t_max;
                    expect_step(some_faces, some_edges, options);
                    const CollisionFreeStep step = expected_step(some_faces, some_edges, options);
                    (step.kind == PairKind::vertex_face ? by_face : by_edge) |= step.limited();
                }
        }
    EXPECT_TRUE(by_face && by_edge);
    expect_step({}, {}, {});
    expect_step(faces, {}, {});
    expect_step({}, edges, {});
    for (const double separation : {1e-6, 1e-2}) {
        Options apart;
        apart.minimum_separation = separation;
        expect_step(faces, edges, apart);
        expect_step(without_early(oracle::Kind::vertex_face, faces, 0.5), without_early(oracle::Kind::edge_edge, edges, 0.5), apart);
    }
}

TEST(CollisionFreeStep, TiesGoToVertexFaceThenToTheSmallerIndexOnAnyThreadCount)
{
    auto faces = without_early(oracle::Kind::vertex_face, mixed(oracle::Kind::vertex_face, 92, 60), 0.75);
    auto edges = without_early(oracle::Kind::edge_edge, mixed(oracle::Kind::edge_edge, 92, 60), 0.75);
    // A point of the one and an end of the other meet head-on at half of the step: the same toi for both kinds.
    const oracle::Pair face{{{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, -1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
    const oracle::Pair edge{{{-1, 0, 1}, {1, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, -1}, {1, 0, -1}, {0, -1, 0}, {0, 1, 0}}};
    for (std::size_t i = 100; i < edges.size(); i += 77) edges[i] = edge;
    const auto only_edges = expected_step(faces, edges, {});
    ASSERT_EQ(only_edges.kind, PairKind::edge_edge);
    ASSERT_EQ(only_edges.pair, 100u);
    auto both = faces;
    for (std::size_t i = 2000; i < both.size(); i += 77) both[i] = face;
    ASSERT_EQ(expected_step(both, edges, {}).step, only_edges.step);
    for (const std::size_t threads : {1u, 2u, 5u}) {
        tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
        tbb::task_arena arena{static_cast<int>(threads)};
        arena.execute([&] {
            for (int repeat = 0; repeat < 5; ++repeat) {
                expect_step(faces, edges, {});
                expect_step(both, edges, {});
            }
        });
    }
}

TEST(SharedBest, LeavesOutOnlyWhatCannotBeBetter)
{
    // Workers see tiles in any order: contact at time 0 settles the tiles behind it, not those before.
    const Job job{PairKind::vertex_face, {}, {1e-9, 0.5, false}, nullptr, false};
    SharedBest best;
    EXPECT_EQ(best.cutoff(job, 0), 1.0);
    best.offer({5000, 0.25});
    EXPECT_EQ(best.cutoff(job, 6144), 0.5);
    best.offer({3000, 0.0});
    EXPECT_GE(best.cutoff(job, 2048), 0.0);
    EXPECT_LE(best.cutoff(job, 2048), 0x1p-1070);
    EXPECT_LT(best.cutoff(job, 3072), 0.0);
    best.offer({1000, 0.0});
    best.offer({2000, 0.0});
    best.offer({10, 0.1});
    EXPECT_EQ(best.contact().pair, 1000u);
}

/// Where times are subnormal, many of the parameter s are the same double.
TEST(SharedBest, LeavesInWhatIsAtTheSameTime)
{
    for (const double t_max : {1.0, 0.7, 1e-300, 1e-308, 1e-315, 1e-320, 3e-323}) {
        const Job job{PairKind::vertex_face, {}, {1e-9, t_max, false}, nullptr, false};
        for (double s = 0.001; s < 0.99; s *= 1.003) {
            SharedBest best;
            best.offer({.pair = 9, .toi = job.parameters.time(s)});
            double same = s;
            for (double later = s; later < 1.0 && job.parameters.time(later) == best.contact().toi; later += 1e-4) same = later;
            EXPECT_GE(time_limit(best.cutoff(job, 0)), same) << t_max << ' ' << s;
        }
    }
}

TEST(CollisionFreeStep, AnInvalidPairAllowsNone)
{
    const auto clean_faces = without_early(oracle::Kind::vertex_face, mixed(oracle::Kind::vertex_face, 93, 60), 0.5);
    const auto clean_edges = without_early(oracle::Kind::edge_edge, mixed(oracle::Kind::edge_edge, 93, 60), 0.5);
    oracle::Pair touching{{{0, 0, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
    for (const std::size_t threads : {1u, 4u}) {
        tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
        for (const std::size_t at : {std::size_t{0}, std::size_t{1500}, clean_edges.size() - 1}) {
            auto edges = clean_edges;
            edges[at][5][1] = std::numeric_limits<double>::quiet_NaN();
            edges.back()[0][0] = std::numeric_limits<double>::infinity();
            CollisionFreeStep step;
            Status status = collision_free_step(interleaved(clean_faces), interleaved(edges), {}, step);
            EXPECT_EQ(status.error, Error::invalid_pair);
            EXPECT_EQ(status.pair, at);
            EXPECT_EQ(step.kind, PairKind::edge_edge);
            EXPECT_EQ(step.step, 0.0);

            // Contact at time 0 before it says as much; after it, the invalid pair is still what is named.
            auto faces = clean_faces;
            faces[1200] = touching;
            status = collision_free_step(interleaved(faces), interleaved(edges), {}, step);
            EXPECT_TRUE(status.ok());
            EXPECT_EQ(step.step, 0.0);
            EXPECT_EQ(step.pair, 1200u);
            faces[1100][0][0] = std::numeric_limits<double>::quiet_NaN();
            faces[1300][0][0] = std::numeric_limits<double>::quiet_NaN();
            status = collision_free_step(interleaved(faces), interleaved(edges), {}, step);
            EXPECT_EQ(status.error, Error::invalid_pair);
            EXPECT_EQ(status.pair, 1100u);
            EXPECT_EQ(step.kind, PairKind::vertex_face);
        }
    }
}

TEST(CollisionFreeStep, OfAMeshAndItsErrors)
{
    // A vertex falls on a face for half of the step; an edge of the face is met by a faster edge earlier.
    const double start[] = {0, 0, 1, -1, -1, 0, 1, -1, 0, 0, 1, 0, -2, -1, 0.5, 2, -1, 0.5};
    const double end[] = {0, 0, -1, -1, -1, 0, 1, -1, 0, 0, 1, 0, -2, -1, -1.5, 2, -1, -1.5};
    const std::int32_t face[] = {1, 2, 3}, edges[] = {2, 3, 4, 5};
    const MovingMesh mesh{PositionView::rows(start, 6), PositionView::rows(end, 6), IndexView::rows(face, 1, 3), IndexView::rows(edges, 2, 2)};
    const std::vector<VertexFace> vertex_face{{0, 0}};
    const std::vector<EdgeEdge> edge_edge{{0, 1}};
    CollisionFreeStep step;
    ASSERT_TRUE(collision_free_step(mesh, vertex_face, edge_edge, {}, step).ok());
    EXPECT_EQ(step.kind, PairKind::edge_edge);
    EXPECT_LE(step.step, 0.25);
    EXPECT_GE(step.step, 0.25 - 1e-9);
    ASSERT_TRUE(collision_free_step(mesh, vertex_face, {}, {}, step).ok());
    EXPECT_EQ(step.kind, PairKind::vertex_face);
    EXPECT_GE(step.step, 0.5 - 1e-9);

    Status status = collision_free_step(mesh, vertex_face, std::vector<EdgeEdge>{{0, 1}, {0, 2}}, {}, step);
    EXPECT_EQ(status.error, Error::index_out_of_range);
    EXPECT_EQ(status.pair, 1u);
    EXPECT_EQ(status.index, 2);
    EXPECT_EQ(step.kind, PairKind::edge_edge);
    EXPECT_EQ(step.step, 0.0);
    status = collision_free_step(mesh, std::vector<VertexFace>{{-1, 0}}, edge_edge, {}, step);
    EXPECT_EQ(status.error, Error::index_out_of_range);
    EXPECT_EQ(step.kind, PairKind::vertex_face);
    Options options;
    options.t_max = 0.0;
    EXPECT_EQ(collision_free_step(mesh, vertex_face, edge_edge, options, step).error, Error::bad_t_max);
    EXPECT_EQ(collision_free_step(MovingMesh{}, vertex_face, edge_edge, {}, step).error, Error::wrong_size);
}

}  // namespace
}  // namespace fastccd::testing
