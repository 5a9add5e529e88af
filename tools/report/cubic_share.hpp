// Degenerate coplanarity cubics among candidates: the paper's Table 2.
#pragma once

#include <cstddef>
#include <span>

#include "../scene/pair_vertices.hpp"

namespace fastccd::tools::report {

/// Candidates whose coplanarity cubic (paper, eq. 5 and 12) has no coefficient, or no coefficient of t^3, that differs from zero
/// beyond rounding.
struct CubicShare {
    std::size_t all_zero = 0;
    std::size_t no_cube = 0;  ///< Those with all zero included.
};

[[nodiscard]] CubicShare cubic_share(const Step& step, std::span<const VertexFace> pairs);
[[nodiscard]] CubicShare cubic_share(const Step& step, std::span<const EdgeEdge> pairs);

}  // namespace fastccd::tools::report
