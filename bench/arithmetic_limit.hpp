// How much arithmetic the threads of an arena can do between them: the roof over everything that computes.
#pragma once

#include <tbb/task_arena.h>

namespace fastccd::bench {

/// Seconds that a fixed number of independent products in registers takes, the widest that this machine has, on the threads of
/// an arena. There is no memory to wait for and nothing to overlap but the products, so a thread does all that its core
/// can do of them. One thread's seconds over those of N threads are the cores that the N have: N on cores of their own, 1 on the
/// hardware threads of one core. Virtual machines call both "cores", and may be moved from one to the other while they run.
[[nodiscard]] double product_seconds(tbb::task_arena& arena);

}  // namespace fastccd::bench
