// Nothing is thrown across the interface: want of memory is an error like others. And a cancelled task group of the
// caller leaves no pair without an answer.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <numeric>
#include <type_traits>
#include <utility>

#include <kernel_table.hpp>
#include <mesh_boxes.hpp>

#include "allocation_count.hpp"
#include "generators.hpp"
#include "mesh_of_pairs.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

/// While it lives, allocations of at least `least` and fewer than `end` bytes fail.
struct Refusal {
    explicit Refusal(std::size_t least, std::size_t end = SIZE_MAX) { refuse_allocations(least, end); }
    ~Refusal() { refuse_allocations(0, 0); }
    Refusal(const Refusal&) = delete;
    Refusal& operator=(const Refusal&) = delete;
};

// What the interface promises at compile time.
static_assert(noexcept(time_of_impact(PairKind{}, PairView{}, Options{}, std::span<double>{})));
static_assert(noexcept(find_contacts(PairKind{}, PairView{}, Options{}, std::declval<std::vector<Contact>&>())));
static_assert(noexcept(earliest_contact(PairKind{}, PairView{}, Options{}, std::declval<Contact&>())));
static_assert(noexcept(collision_free_step(PairView{}, PairView{}, Options{}, std::declval<CollisionFreeStep&>())));
static_assert(std::is_nothrow_constructible_v<MovingMesh, PositionView, PositionView, IndexView, IndexView>);
static_assert(std::is_nothrow_move_constructible_v<MovingMesh>);

constexpr std::size_t most_pairs = 5000;

struct Pairs {
    std::vector<oracle::Pair> list;
    PairView view;
    std::vector<double> toi;

    explicit Pairs(std::size_t size) : toi(size)
    {
        generate("uniform", oracle::Kind::vertex_face, 55, size, list);
        view = interleaved(list);
    }
};

/// For a process of its own: from here on the system refuses memory. Then 0 if every call says so.
[[noreturn]] void exit_after_calls_without_memory()
{
    Pairs pairs{1000};
    Contact earliest{};
    CollisionFreeStep step{0.5};
    const rlimit nothing_more{1, 1};
    setrlimit(RLIMIT_AS, &nothing_more);
    const bool named = time_of_impact(PairKind::vertex_face, pairs.view, {}, pairs.toi).error == Error::out_of_memory &&
                       earliest_contact(PairKind::vertex_face, pairs.view, {}, earliest).error == Error::out_of_memory &&
                       collision_free_step(pairs.view, pairs.view, {}, step).error == Error::out_of_memory && step.step == 0.0;
    std::_Exit(named ? 0 : 1);
}

TEST(OutOfMemoryDeathTest, OfTheSystemIsAnErrorOfEveryCall)
{
    if (!refuses_every_allocation()) GTEST_SKIP() << "NOT TESTED: a sanitizer needs memory of its own; nothing was checked here";
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process that has run nothing of the library before
    EXPECT_EXIT(exit_after_calls_without_memory(), ::testing::ExitedWithCode(0), "");
}

/// For a process of its own, in which oneTBB may start far more threads than the system then gives. 0 if calls answer all the same.
[[noreturn]] void exit_after_calls_without_threads()
{
    constexpr int threads = 4096;
    Pairs pairs{100'000};
    Options options;
    options.reference = true;  // takes so long that all of them are wanted
    const tbb::global_control many{tbb::global_control::max_allowed_parallelism, threads};
    tbb::task_arena arena{threads};
    const rlimit some{2'000'000'000, 2'000'000'000};
    setrlimit(RLIMIT_AS, &some);
    bool answered = true;
    arena.execute([&] { answered = time_of_impact(PairKind::vertex_face, pairs.view, options, pairs.toi).ok(); });
    std::vector<double> expected(pairs.toi.size());
    tbb::task_arena{1}.execute([&] { answered &= time_of_impact(PairKind::vertex_face, pairs.view, options, expected).ok(); });
    std::_Exit(answered && pairs.toi == expected ? 0 : 1);
}

TEST(OutOfThreadsDeathTest, LeavesTheCallersThread)
{
    if (!refuses_every_allocation()) GTEST_SKIP() << "NOT TESTED: a sanitizer needs memory of its own; nothing was checked here";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(exit_after_calls_without_threads(), ::testing::ExitedWithCode(0), "");
}

TEST(OutOfMemory, InATaskIsAnError)
{
    Pairs pairs{most_pairs};
    std::vector<Contact> contacts{{1, 0.5}};
    std::vector<std::size_t> invalid{3};
    Status status;
    {
        const Refusal refusal{1000};  // what a worker's own list of contacts grows to
        status = find_contacts(PairKind::vertex_face, pairs.view, {}, contacts, &invalid);
    }
    EXPECT_EQ(status.error, Error::out_of_memory);
    EXPECT_EQ(contacts.size(), 1u);
    EXPECT_EQ(invalid.size(), 1u);
    EXPECT_TRUE(find_contacts(PairKind::vertex_face, pairs.view, {}, contacts, &invalid).ok());
}

TEST(OutOfMemory, OfTheCallersListsLeavesThemAsTheyWere)
{
    Pairs pairs{most_pairs};
    for (std::size_t i = 0; i < pairs.list.size(); i += 2) pairs.list[i][0][0] = std::numeric_limits<double>::infinity();
    // More invalid pairs than contacts: the list of those is the allocation that fails.
    std::vector<Contact> contacts;
    std::vector<std::size_t> invalid{3};
    contacts.reserve(most_pairs);
    Status status;
    {
        const Refusal refusal{pairs.list.size() / 2 * sizeof(std::size_t), sizeof(Contact) * tile_pairs};  // nothing that a worker has
        status = find_contacts(PairKind::vertex_face, pairs.view, {}, contacts, &invalid);
    }
    EXPECT_EQ(status.error, Error::out_of_memory);
    EXPECT_TRUE(contacts.empty());
    EXPECT_EQ(invalid.size(), 1u);
}

TEST(OutOfMemory, OfAMeshAndABuffer)
{
    std::vector<double> positions(30000, 0.5);
    const PositionView view = PositionView::rows(positions.data(), positions.size() / 3);
    Status status;
    bool thrown = false;
    {
        const Refusal refusal{20000};
        status = MovingMesh{view, view, {}, {}}.status();
        try {
            PairBuffer buffer{1000};
        } catch (const std::bad_alloc&) {
            thrown = true;
        }
    }
    EXPECT_EQ(status.error, Error::out_of_memory);
    EXPECT_TRUE(thrown);
    EXPECT_THROW(PairBuffer{SIZE_MAX}, std::bad_alloc);
    EXPECT_THROW(PairBuffer{SIZE_MAX / 192}, std::bad_alloc);
}

/// They save time, and nothing else depends on them.
TEST(OutOfMemory, OfBoxesIsNoError)
{
    constexpr std::size_t primitives = 20'000;
    constexpr std::int32_t around = 16;
    for (const oracle::Kind kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        MeshOfPairs made{Pairs{primitives}.list};
        made.pair_with_others(around, 7);
        std::vector<double> toi(made.vertex_face.size()), expected = toi;
        const auto ask = [&](std::vector<double>& times, std::size_t least, std::size_t refused_end) {
            const MovingMesh mesh = made.mesh();
            const Refusal refusal{least, refused_end};
            return kind == oracle::Kind::vertex_face ? time_of_impact(mesh, made.vertex_face, {}, times)
                                                     : time_of_impact(mesh, made.edge_edge, {}, times);
        };
        EXPECT_TRUE(ask(expected, 0, 0).ok());
        // More than a worker's scratch: boxes of 80,000 vertices alone, and with those of the primitives.
        for (const std::size_t least : {sizeof(TileScratch) + 100'000, std::size_t{4'000'000}}) {
            toi.assign(toi.size(), 0.5);
            EXPECT_TRUE(ask(toi, least, SIZE_MAX).ok()) << kind_name(kind) << ' ' << least;
            EXPECT_EQ(toi, expected) << kind_name(kind) << ' ' << least;
        }
    }
}

TEST(OutOfMemory, ThrownWhereBoxesAreMadeIsNoError)
{
    std::vector<double> positions(3000);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = std::sin(static_cast<double>(i));
    std::vector<std::int32_t> faces(3000);
    std::iota(faces.begin(), faces.end(), 0);
    for (std::int32_t& vertex : faces) vertex %= 1000;
    const PositionView view = PositionView::rows(positions.data(), 1000);
    const MovingMesh mesh{view, view, IndexView::rows(faces.data(), 1000, 3), {}};
    const IndexedSource source{mesh.records(), nullptr, faces.data(), 3, 1, 1000, 1000, {}};
    MeshBoxes boxes;
    {
        const Refusal refusal{1, 1000};  // what is small, and thrown by operator new
        EXPECT_EQ(boxes.screen(PairKind::vertex_face, source, 100'000, 0.0).first, nullptr);
    }
    EXPECT_NE(boxes.screen(PairKind::vertex_face, source, 100'000, 0.0).first, nullptr);
}

TEST(OutOfMemory, OfAMeshWithoutItsSetsOfBoxes)
{
    const std::vector<double> positions(300, 0.5);
    const PositionView view = PositionView::rows(positions.data(), 100);
    const Refusal refusal{1, 100};
    EXPECT_EQ((MovingMesh{view, view, {}, {}}.status().error), Error::out_of_memory);
}

TEST(Cancellation, OfTheCallersTaskGroupLeavesNothingOut)
{
    Pairs pairs{most_pairs};
    const Answer expected = answer(oracle::Kind::vertex_face, pairs.view, {});
    std::vector<double> positions(60000, 0.5);
    const PositionView view = PositionView::rows(positions.data(), positions.size() / 3);
    const std::vector<VertexFace> out_of_range(200000, {0, 0});
    Status indices;
    double last_position = 0.0;
    tbb::task_group group;
    group.run_and_wait([&] {
        group.cancel();
        (void)time_of_impact(PairKind::vertex_face, pairs.view, {}, pairs.toi);
        const MovingMesh mesh{view, view, {}, {}};
        last_position = mesh.records()[8 * mesh.vertex_count() - 3];
        indices = find_contacts(mesh, out_of_range, {}, *std::make_unique<std::vector<Contact>>());
    });
    EXPECT_EQ(pairs.toi, expected.toi);
    EXPECT_EQ(last_position, 0.5);
    EXPECT_EQ(indices.error, Error::index_out_of_range);
}

}  // namespace
}  // namespace fastccd::testing
