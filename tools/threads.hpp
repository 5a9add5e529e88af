// The threads that the user asked for.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <scheduler/parallel_ranges.hpp>

namespace fastccd::tools {

/// Runs `work` in an arena of `threads` threads; 0: as many as the machine runs at once, or one alone if the system refuses
/// those, which is said on standard error. Throws std::runtime_error if it refuses threads that were asked for.
template <class Work>
void on_threads(std::uint64_t threads, const Work& work)
{
    // An arena alone gets no more workers than the machine has processors; the control raises that.
    std::optional<tbb::global_control> limit;
    if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena{threads > 0 ? static_cast<int>(threads) : tbb::task_arena::automatic};
    if (arena.execute(workers_available)) return arena.execute(work);
    const std::string refused = fmt::format("the system refuses {} threads (a limit on processes or memory?)", arena.max_concurrency());
    if (threads > 0) throw std::runtime_error(refused + "; ask for fewer with --threads");
    std::fputs(fmt::format("fastccd: {}; one is used\n", refused).c_str(), stderr);
    tbb::task_arena{1}.execute(work);
}

}  // namespace fastccd::tools
