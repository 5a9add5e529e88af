// Calls from tasks of oneTBB, as a simulator makes them.
#include <gtest/gtest.h>

#include <atomic>

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
