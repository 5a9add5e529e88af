// Stand-in for oneTBB's header, see workers.h.
#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/workers.h>

namespace tbb {

/// Nothing is cancelled here, and all threads have the same floating-point environment.
struct task_group_context {
    enum kind_type { isolated };
    enum traits_type { fp_settings };
    task_group_context(kind_type, traits_type) {}
};

/// Chunks of one grain, dealt to the workers in turn: neighbours run on different threads, and every thread gets its share, which
/// on a busy machine a common counter would not give.
template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body, task_group_context&)
{
    const std::size_t size = range.end() - range.begin(), grain = range.grainsize();
    stand_in::for_each_worker([&] {
        for (std::size_t first = stand_in::worker * grain; first < size; first += stand_in::worker_count * grain)
            body(blocked_range<Value>{range.begin() + first, range.begin() + std::min(first + grain, size), grain});
    });
}

}  // namespace tbb
