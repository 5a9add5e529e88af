// The threads that the user asked for.
#pragma once

#include <cstdint>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace fastccd::tools {

/// Runs `work` in an arena of `threads` threads; 0: as many as the machine runs at once.
template <class Work>
void on_threads(std::uint64_t threads, const Work& work)
{
    // An arena alone gets no more workers than the machine has processors; the control raises that.
    std::optional<tbb::global_control> limit;
    if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena{threads > 0 ? static_cast<int>(threads) : tbb::task_arena::automatic};
    arena.execute(work);
}

}  // namespace fastccd::tools
