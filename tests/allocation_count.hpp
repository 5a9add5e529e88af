// Counts every operator new of the program, and with glibc every malloc, TBB's among them.
#pragma once

#include <cstddef>

namespace fastccd::testing {

/// Allocations so far, by all threads.
std::size_t allocations();

/// From now on, allocations of at least so many bytes fail; with SIZE_MAX none does. Under a sanitizer only those made by
/// operator new.
void refuse_allocations_from(std::size_t bytes);
bool refuses_every_allocation();

}  // namespace fastccd::testing
