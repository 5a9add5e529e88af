// Where and how figures were obtained.
#pragma once

#include <cstddef>
#include <string>

#include "timing.hpp"

namespace fastccd::tools::report {

/// Model of the first processor. A virtual machine may hide the model's name but not its number.
[[nodiscard]] std::string processor();

/// Processor, memory, load, system, compiler, flags, instruction sets, version and commit of this build.
[[nodiscard]] Json machine();

/// Bytes of memory that the system has, that this process may have by its limits and by those of its control groups (of a container,
/// say), and that it has now; 0 where the system does not tell.
[[nodiscard]] std::size_t system_memory();
[[nodiscard]] std::size_t allowed_memory();
[[nodiscard]] std::size_t resident_memory();

}  // namespace fastccd::tools::report
