// Stand-in for oneTBB's header, see workers.h.
#pragma once

#include "workers.h"

namespace tbb::this_task_arena {

inline int max_concurrency() { return static_cast<int>(stand_in::worker_count); }

/// No thread here ever works for two at once.
template <class Call>
auto isolate(const Call& call)
{
    return call();
}

}  // namespace tbb::this_task_arena

namespace tbb {

/// Has as many threads as everything here.
struct task_arena {
    explicit task_arena(int) {}

    template <class Call>
    void execute(const Call& call)
    {
        call();
    }
};

}  // namespace tbb
