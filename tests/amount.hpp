#pragma once

#include <cstddef>

namespace fastccd::testing {

/// Of what a test makes by the hundred: all, but a sixteenth in builds with sanitizers. Those look for faults of another kind, need
/// no rare numbers to find them, and take ten times as long.
constexpr std::size_t amount(std::size_t all)
{
#ifdef FASTCCD_SANITIZED
    return (all + 15) / 16;
#else
    return all;
#endif
}

}  // namespace fastccd::testing
