// How much arithmetic the threads of an arena can do between them: the roof over everything that computes.
#pragma once

#include <tbb/task_arena.h>

namespace fastccd::bench {

/// Products that wait for one another; as many such chains as keep two units with a latency of up to six cycles busy, and leave registers
/// for the factor where there are 16; and as many parts as let threads share a pass evenly, which takes some 6 ms of one.
inline constexpr int products_per_chain = 100'000, chains = 12, parts = 32;

/// Products of registers, the widest that this machine has, in a pass of multiply().
inline constexpr double products_per_pass = 1.0 * parts * chains * products_per_chain;

/// Seconds of a pass of independent products in registers, on the threads of an arena. There is no memory to wait for and nothing to
/// overlap but the products, so a thread does all that its core can do of them: half as many where another one, of this program or of
/// a neighbour of the virtual machine, runs on the core's other hardware thread. Two such threads look like two cores in a virtual
/// machine, which may be moved from one to the other while it runs.
[[nodiscard]] double multiply(tbb::task_arena& arena);

}  // namespace fastccd::bench
