// The instruction sets of the library, and those that can be chosen here.
#pragma once

#include <string>

#include <fastccd/isa.hpp>

namespace fastccd::tools {

/// In ascending width.
inline constexpr Isa all_isas[] = {Isa::scalar, Isa::sse2, Isa::neon, Isa::avx2, Isa::avx512};

/// The names of all that can be chosen here, as "scalar, sse2, avx2".
[[nodiscard]] std::string available_isas();

}  // namespace fastccd::tools
