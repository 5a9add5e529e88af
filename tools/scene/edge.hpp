#pragma once

#include <array>
#include <cstdint>

namespace fastccd::tools {

/// Two vertices, by index.
using Edge = std::array<std::int32_t, 2>;

}  // namespace fastccd::tools
