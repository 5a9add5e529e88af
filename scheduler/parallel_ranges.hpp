// Loops over ranges in parallel, in the caller's oneTBB arena.
#pragma once

#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

namespace fastccd {

using Range = tbb::blocked_range<std::size_t>;

/// Whether the system lets this process have the threads that oneTBB may start for the caller's arena. oneTBB's workers start one
/// another, and if the system refuses one to a worker (a limit on processes or memory), that ends the program. So the
/// first call that wants more threads than any before it starts and joins as many, as a trial. For a second after a refusal, as many or more
/// are refused without one. False: keep to the caller's thread.
bool workers_available();

/// The arena of a thread that has none is made at its first use, and gives all its tasks, those that the program starts later, too, the
/// floating-point environment there is then. So that first use is made here, in the caller's environment.
void enter_arena();

/// Cancelling the caller's task group must not leave anything undone, and all threads are to have the floating-point environment of this
/// one (default_floating_point.hpp), not the one in which the arena was made.
struct OwnContext : tbb::task_group_context {
    OwnContext() : task_group_context{isolated, fp_settings} {}
};

// Isolated: a caller that is a task itself must not, while it waits for other threads here, begin with another task of the program, which
// might want a lock that the caller holds, or its thread's scratch.

/// body(range) for parts of [0, size) that are together all of it; a part of at most `grain` is not divided.
template <class Body>
void for_each_range(std::size_t size, std::size_t grain, const Body& body)
{
    if (size == 0) return;
    if (size <= grain || !workers_available()) {
        body(Range{0, size});
        return;
    }
    enter_arena();
    OwnContext context;
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(Range{0, size, grain}, body, context); });
}

/// join of body(range, identity) over such parts.
template <class Value, class Body, class Join>
Value reduce_ranges(std::size_t size, std::size_t grain, const Value& identity, const Body& body, const Join& join)
{
    if (size == 0) return identity;
    if (size <= grain || !workers_available()) return body(Range{0, size}, identity);
    enter_arena();
    OwnContext context;
    return tbb::this_task_arena::isolate([&] { return tbb::parallel_reduce(Range{0, size, grain}, identity, body, join, context); });
}

}  // namespace fastccd
