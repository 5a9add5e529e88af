// The README promises that 64 KiB of stack are enough for a thread that calls, as plugins and job systems have them.
#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <pthread.h>

#include <tbb/global_control.h>

#include "generators.hpp"
#include "mesh_of_pairs.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

/// Some systems give no thread less than PTHREAD_STACK_MIN.
std::size_t stack_bytes()
{
    constexpr std::size_t promised = 64 * 1024;
    return std::max(promised, static_cast<std::size_t>(PTHREAD_STACK_MIN));
}

/// Calls `function` on a thread that has no more stack than promised. What needs more ends the test with a segmentation fault.
template <class Function>
void on_small_stack(Function function)
{
    pthread_attr_t attributes;
    ASSERT_EQ(pthread_attr_init(&attributes), 0);
    ASSERT_EQ(pthread_attr_setstacksize(&attributes, stack_bytes()), 0);
    pthread_t thread;
    const auto start = [](void* argument) -> void* {
        (*static_cast<Function*>(argument))();
        return nullptr;
    };
    ASSERT_EQ(pthread_create(&thread, &attributes, start, &function), 0);
    pthread_attr_destroy(&attributes);
    ASSERT_EQ(pthread_join(thread, nullptr), 0);
}

/// The same pairs as those of a mesh, made and asked about.
void ask_a_mesh(const std::vector<oracle::Pair>& pairs, const Options& options)
{
    const MeshOfPairs made{pairs};
    const MovingMesh mesh = made.mesh();
    std::vector<double> toi(pairs.size());
    EXPECT_TRUE(time_of_impact(mesh, made.vertex_face, options, toi).ok());
    EXPECT_TRUE(time_of_impact(mesh, made.edge_edge, options, toi).ok());
    CollisionFreeStep step;
    EXPECT_TRUE(collision_free_step(mesh, made.vertex_face, made.edge_edge, options, step).ok());
}

/// Every question about packed pairs, of hard ones, so that lanes, the certified search and exact arithmetic all have a turn.
void ask_everything(oracle::Kind kind, const PairBuffer& buffer, Options options)
{
    const PairView pairs = buffer.view();
    std::vector<double> toi(pairs.size());
    std::vector<Contact> contacts;
    EXPECT_TRUE(time_of_impact(pair_kind(kind), pairs, options, toi).ok());
    EXPECT_TRUE(find_contacts(pair_kind(kind), pairs, options, contacts).ok());
    Contact earliest;
    EXPECT_TRUE(earliest_contact(pair_kind(kind), pairs, options, earliest).ok());
    EXPECT_EQ(answer(kind, pairs, options).toi, toi);
    options.exact = true;
    const Status settled = time_of_impact(pair_kind(kind), pairs, options, toi);
    EXPECT_TRUE(settled.ok() || settled.error == Error::exact_unavailable);
    options.exact = false;
    options.minimum_separation = 1e-3;
    EXPECT_TRUE(time_of_impact(pair_kind(kind), pairs, options, toi).ok());
}

void expect_enough(oracle::Kind kind, const std::vector<oracle::Pair>& pairs)
{
    const PairBuffer buffer = to_buffer(pairs);
    for (const Isa isa : isas_to_test()) {
        Options options;
        options.isa = isa;
        on_small_stack([&] { ask_everything(kind, buffer, options); });
        on_small_stack([&] { ask_a_mesh(pairs, options); });
    }
}

TEST(SmallStack, IsEnoughForEveryQuestionOnEveryIsa)
{
    for (const std::size_t threads : {1u, 2u}) {
        const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
        for (const std::string& family : families())
            for (const oracle::Kind kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 5, 16, pairs);
                expect_enough(kind, pairs);
            }
    }
}

/// The calling thread is the one that starts threads, makes an arena and deals out tiles, of pairs, of a mesh's vertices and of its boxes.
TEST(SmallStack, IsEnoughForManyPairsOnSeveralThreads)
{
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, 3};
    for (const oracle::Kind kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        std::vector<oracle::Pair> pairs;
        for (const char* family : {"uniform", "simcloth", "degenerate"}) {
            std::vector<oracle::Pair> more;
            generate(family, kind, 6, 1000, more);
            pairs.insert(pairs.end(), more.begin(), more.end());
        }
        expect_enough(kind, pairs);
    }
    // Pairs enough for boxes, and for their indices to be checked in parts.
    constexpr std::int32_t faces = 50'000;
    std::vector<double> start(3 * (faces + 2)), end;
    for (std::size_t i = 0; i < start.size(); ++i) start[i] = 1e-3 * static_cast<double>(i * i % 1009);
    end = start;
    std::vector<std::int32_t> corners;
    std::vector<VertexFace> vertex_face;
    for (std::int32_t face = 0; face < faces; ++face) {
        corners.insert(corners.end(), {face, face + 1, face + 2});
        for (std::int32_t vertex = 0; vertex < 5; ++vertex) vertex_face.push_back({vertex * (faces / 5), face});
    }
    std::vector<double> toi(vertex_face.size());
    on_small_stack([&] {
        const MovingMesh mesh{PositionView::rows(start.data(), faces + 2), PositionView::rows(end.data(), faces + 2),
                              IndexView::rows(corners.data(), faces, 3), {}};
        EXPECT_TRUE(time_of_impact(mesh, vertex_face, {}, toi).ok());
    });
}

/// The cubic is x(t) y(t) with roots at 2^-2098 and 2^-2097: exact arithmetic halves the step two thousand times to tell them apart.
TEST(SmallStack, IsEnoughForRootsThatAreHardToTellApart)
{
    constexpr double least = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
    expect_enough(oracle::Kind::vertex_face, {{{{0, 0, 0}, {least, 0, 0}, {0, least, 0}, {0, 0, 1},  //
                                                {0, 0, 0}, {-most, 0, 0}, {0, -most / 2, 0}, {0, 0, 1}}}});
}

}  // namespace
}  // namespace fastccd::testing
