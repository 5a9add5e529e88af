#include "parts.hpp"

#include <tbb/task_arena.h>
#include <time.h>

#include <fastccd/isa.hpp>

#include "../instruction_sets.hpp"

namespace fastccd::tools::report {

std::vector<Isa> available()
{
    std::vector<Isa> isas;
    for (const Isa isa : all_isas) {
        if (isa_available(isa)) isas.push_back(isa);
    }
    return isas;
}

std::vector<int> thread_counts()
{
    const int all = tbb::this_task_arena::max_concurrency();
    std::vector<int> counts;
    for (int threads = 1; threads < all; threads = threads < 8 ? threads + 1 : 2 * threads) counts.push_back(threads);
    counts.push_back(all);
    return counts;
}

double seconds_on(int threads, const std::function<void()>& work)
{
    tbb::task_arena arena{threads};
    double seconds = 0;
    arena.execute([&] { seconds = seconds_of(work); });
    return seconds;
}

double processor_seconds(const std::function<void()>& work)
{
    const auto now = [] {
        timespec time{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    tbb::task_arena arena{1};
    double seconds = 0;
    arena.execute([&] {
        const double start = now();
        work();
        seconds = now() - start;
    });
    return seconds;
}

}  // namespace fastccd::tools::report
