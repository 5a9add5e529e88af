// Counts every operator new of the program, what oneTBB's allocator gives, and with glibc every malloc.
#pragma once

#include <cstddef>

namespace fastccd::testing {

/// Allocations so far, by all threads.
std::size_t allocations();

/// From now on, allocations of at least `least` and fewer than `end` bytes fail; (0, 0): none. Under a sanitizer only those made by
/// operator new or oneTBB's allocator.
void refuse_allocations(std::size_t least, std::size_t end);
bool refuses_every_allocation();

}  // namespace fastccd::testing
