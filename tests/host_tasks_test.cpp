// Calls from tasks of oneTBB, as a simulator makes them.
#include <gtest/gtest.h>

#include <atomic>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

/// While a caller waits for other threads to finish tiles, oneTBB would give it whatever else there is to do: another task like the
/// caller, on top of it, with the same scratch, and locks that are taken.
TEST(HostTasks, NoneBeginsWithinACall)
{
    constexpr int threads = 4;
    const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
    std::vector<oracle::Pair> pairs;
    generate("uniform", oracle::Kind::edge_edge, 73, 20'000, pairs);
    const PairBuffer buffer = to_buffer(pairs);
    const Answer expected = answer_without_roots(oracle::Kind::edge_edge, buffer.view(), {});

    struct Scratch {
        std::vector<double> toi;
        int calls_under_way = 0;
    };
    tbb::enumerable_thread_specific<Scratch> scratch;
    std::atomic<int> nested{0}, wrong{0};
    const auto task = [&] {
        Scratch& own = scratch.local();
        if (own.calls_under_way++ > 0) ++nested;
        own.toi.assign(pairs.size(), 0.0);
        if (!time_of_impact(PairKind::edge_edge, buffer.view(), {}, own.toi).ok() || own.toi != expected.toi) ++wrong;
        --own.calls_under_way;
    };
    tbb::task_arena arena{threads};
    arena.execute([&] {
        tbb::task_group group;
        for (std::size_t i = 0; i < amount(1000); ++i) group.run(task);
        group.wait();
    });
    EXPECT_EQ(nested, 0);
    EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace fastccd::testing
