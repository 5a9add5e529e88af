// The threads behind this folder's stand-in for oneTBB, and all the order that it gives them.
//
// ThreadSanitizer does not see into an ordinary build of oneTBB, and takes every hand-over within it for a race. The headers here
// have the same names and give what the library uses, in instrumented code, and no more order between threads than oneTBB
// promises: what precedes a parallel_for in its caller happens before its bodies, they happen before its return, and nothing
// orders the bodies of one worker and those of another. Anything more, such as a lock around a common counter of chunks, would
// hide the races that race_test looks for. Not for use within a body of another parallel_for: the library has none.
#pragma once

#include <cstddef>
#include <latch>
#include <thread>
#include <vector>

namespace tbb::stand_in {

inline constexpr std::size_t worker_count = 4;

/// Of this thread, in the parallel_for that it works for; callers are worker 0.
inline thread_local std::size_t worker = 0;

/// Calls work() as each of the workers, on the caller's thread and on others. They begin together, so that they do overlap.
template <class Work>
void for_each_worker(const Work& work)
{
    std::latch beginning{worker_count};
    const auto run = [&](std::size_t index) {
        worker = index;
        beginning.arrive_and_wait();
        work();
    };
    std::vector<std::jthread> others;  // joined at the end
    for (std::size_t index = 1; index < worker_count; ++index) others.emplace_back(run, index);
    run(0);
}

}  // namespace tbb::stand_in
