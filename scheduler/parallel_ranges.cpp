#include <parallel_ranges.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <thread>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <default_floating_point.hpp>

namespace fastccd {

namespace {

/// That many threads at the same time.
bool can_start(int threads) noexcept
{
    std::latch end{1};
    std::vector<std::thread> started;
    bool all = true;
    try {
        started.reserve(static_cast<std::size_t>(threads));
        for (int i = 0; i < threads; ++i) started.emplace_back([&end] { end.wait(); });
    } catch (...) {  // std::system_error, or no memory
        all = false;
    }
    end.count_down();
    for (std::thread& thread : started) thread.join();
    return all;
}

}  // namespace

bool workers_available()
{
    using Clock = std::chrono::steady_clock;
    static std::atomic<int> most_started{0}, refused{0};
    static std::atomic<Clock::time_point> next_trial{Clock::time_point{}};  // of as many as were refused
    int most = most_started.load(std::memory_order_relaxed);
    int workers = tbb::this_task_arena::max_concurrency() - 1;
    if (workers <= most) return true;
    // An arena may have room for more threads than there ever are.
    const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    workers = static_cast<int>(std::min(static_cast<std::size_t>(workers), allowed - 1));
    if (workers <= most) return true;
    if (workers >= refused.load(std::memory_order_relaxed) && Clock::now() < next_trial.load(std::memory_order_relaxed)) return false;
    if (!can_start(workers)) {
        refused.store(workers, std::memory_order_relaxed);
        next_trial.store(Clock::now() + std::chrono::seconds{1}, std::memory_order_relaxed);
        return false;
    }
    while (most < workers && !most_started.compare_exchange_weak(most, workers, std::memory_order_relaxed)) {
    }
    return true;
}

void enter_arena()
{
    const CallersFloatingPoint callers;
    tbb::this_task_arena::isolate([] {});
}

}  // namespace fastccd
