// Counts every operator new of the program, and with glibc every malloc, TBB's among them.
#pragma once

#include <cstddef>

namespace fastccd::testing {

/// Allocations so far, by all threads.
std::size_t allocations();

}  // namespace fastccd::testing
