// Calls from tasks of oneTBB, as a simulator makes them.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <tbb/task_scheduler_observer.h>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

/// While a caller waits for other threads to finish tiles, oneTBB would give it whatever else there is to do: another task like the
/// caller, on top of it, with the same scratch, and locks that are taken. `call(toi)` in many tasks at once; it is to answer `expected`.
template <class Call>
void expect_no_task_within(const Call& call, std::size_t tasks, const std::vector<double>& expected)
{
    constexpr int threads = 4;
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
    struct Scratch {
        std::vector<double> toi;
        int calls_under_way = 0;
    };
    tbb::enumerable_thread_specific<Scratch> scratch;
    std::atomic<int> nested{0}, wrong{0};
    const auto task = [&] {
        Scratch& own = scratch.local();
        if (own.calls_under_way++ > 0) ++nested;
        own.toi.assign(expected.size(), 0.0);
        if (!call(own.toi).ok() || own.toi != expected) ++wrong;
        --own.calls_under_way;
    };
    tbb::task_arena arena{threads};
    arena.execute([&] {
        tbb::task_group group;
        for (std::size_t i = 0; i < tasks; ++i) group.run(task);
        group.wait();
    });
    EXPECT_EQ(nested, 0);
    EXPECT_EQ(wrong, 0);
}

TEST(HostTasks, NoneBeginsWithinACall)
{
    std::vector<oracle::Pair> pairs;
    generate("uniform", oracle::Kind::edge_edge, 73, 20'000, pairs);
    const PairBuffer buffer = to_buffer(pairs);
    expect_no_task_within([&](std::vector<double>& toi) { return time_of_impact(PairKind::edge_edge, buffer.view(), {}, toi); }, amount(1000),
                          answer_without_roots(oracle::Kind::edge_edge, buffer.view(), {}).toi);
}

/// Nor while indices are checked, and boxes made.
TEST(HostTasks, NoneBeginsWithinACallAboutAMesh)
{
    constexpr std::int32_t edges = 1 << 10, around = 1 << 8;
    std::vector<double> positions(std::size_t{6} * edges);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = std::sin(static_cast<double>(i * i));
    std::vector<std::int32_t> ends(std::size_t{2} * edges);
    std::iota(ends.begin(), ends.end(), 0);
    std::vector<EdgeEdge> pairs;
    for (std::int32_t i = 0; i < edges; ++i)
        for (std::int32_t k = 0; k < around; ++k) pairs.push_back({i, (i + k) % edges});
    // At both ends of the step the same: boxes keep most apart, so that the check is a good part of the time.
    const PositionView at = PositionView::rows(positions.data(), 2 * edges);
    const auto call = [&](std::vector<double>& toi) {
        return time_of_impact(MovingMesh{at, at, {}, IndexView::rows(ends.data(), edges, 2)}, pairs, {}, toi);
    };
    std::vector<double> expected(pairs.size());
    ASSERT_TRUE(call(expected).ok());
    expect_no_task_within(call, amount(300), expected);
}

/// Counts how often one of oneTBB's threads came to work in an arena. Lives until the program ends: what oneTBB allocates for an observer
/// that is no more stays as long as a thread works in the arena, to be found only from that thread's memory, where LeakSanitizer does not
/// look.
class Workers : public tbb::task_scheduler_observer {
public:
    explicit Workers(tbb::task_arena& arena) : task_scheduler_observer{arena} { observe(true); }
    void on_scheduler_entry(bool is_worker) override { came_ += is_worker ? 1 : 0; }
    [[nodiscard]] int came() const { return came_; }

private:
    std::atomic<int> came_ = 0;
};

/// To wake a thread for what is done before it comes costs more than it saves, and callers of their own threads want no others.
TEST(HostTasks, FewPairsTakeNoThreadButTheCallers)
{
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, 4};
    std::vector<oracle::Pair> pairs;
    generate("uniform", oracle::Kind::edge_edge, 75, 1 << 15, pairs);
    std::vector<double> toi(pairs.size());
    const auto ask = [&](std::size_t count, const Options& options) {
        const PairView view = PairView::interleaved(pairs[0][0].data(), count);
        EXPECT_TRUE(time_of_impact(PairKind::edge_edge, view, options, std::span(toi).first(count)).ok());
        std::vector<Contact> contacts;
        EXPECT_TRUE(find_contacts(PairKind::edge_edge, view, options, contacts).ok());
    };
    static auto& arena = *new tbb::task_arena{4};
    static auto& workers = *new Workers{arena};
    Options separated, reference;
    separated.minimum_separation = 1e-3;
    reference.reference = true;
    for (std::size_t i = 0; i < amount(200); ++i)
        arena.execute([&] {
            ask(1024, {});
            ask(64, separated);
            ask(64, reference);
        });
    EXPECT_EQ(workers.came(), 0);
    for (int i = 0; i < 10'000 && workers.came() == 0; ++i) arena.execute([&] { ask(pairs.size(), {}); });
    EXPECT_GT(workers.came(), 0) << "many pairs take others, or this does not notice";
}

}  // namespace
}  // namespace fastccd::testing
