#pragma once

#include <cstddef>
#include <cstdio>

namespace fastccd::testing {

/// Memory is not what users see then.
#ifdef FASTCCD_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// Of what a test makes by the hundred: all, but a sixteenth in builds with sanitizers. Those look for faults of another kind, need
/// no rare numbers to find them, and take ten times as long.
constexpr std::size_t amount(std::size_t all) { return sanitized ? (all + 15) / 16 : all; }

/// The largest public scene takes them as long as all others of a test together. Says so.
inline bool too_large_for_sanitizers(std::size_t candidates)
{
    const bool is = sanitized && candidates > 10'000'000;
    if (is) std::fprintf(stderr, "NOT TESTED with sanitizers: a scene of %zu candidates\n", candidates);
    return is;
}

}  // namespace fastccd::testing
