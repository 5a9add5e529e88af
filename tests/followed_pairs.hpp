// Pairs that stay farther than d, at which the search with a separation has to let directions follow the primitives
// (scalar/following_direction.hpp): without that they take 4,096 looks and come to contact.
#pragma once

#include <array>

#include "oracle/pair.hpp"

namespace fastccd::testing {

struct FollowedPair {
    oracle::Kind kind;
    double distance;
    oracle::Pair pair;
};

inline constexpr double half_a_side = 4e4;

/// An end of a side on the line that touches the parabola (x, 1 - x^2/2) at x. With x from -1 to 1 over the step this moves along a straight
/// line, and the side stays 1 + x^4/8 from the origin, about which it turns: directions must be accurate to 1 - d over its length.
constexpr std::array<double, 3> on_tangent(double x, double end) { return {0.5 * (x + end), 1.0 - 0.5 * x * end, 0.125}; }

/// At the origin, a vertex, and the face has a third corner beyond the side; or the end of an edge that points away from it.
inline const FollowedPair followed_pairs[] = {
    {oracle::Kind::vertex_face, 1.0 - 1e-4,
     {{{0, 0, 0.125}, on_tangent(-1, -half_a_side), on_tangent(-1, half_a_side), {0, 9 * half_a_side, 400},
       {0, 0, 0.125}, on_tangent(1, -half_a_side), on_tangent(1, half_a_side), {0, 9 * half_a_side, 400}}}},
    {oracle::Kind::edge_edge, 1.0 - 1e-4,
     {{{0, 0, 0.125}, {0.3 * half_a_side, -half_a_side, 4000}, on_tangent(-1, -half_a_side), on_tangent(-1, half_a_side),
       {0, 0, 0.125}, {-0.3 * half_a_side, -half_a_side, 4000}, on_tangent(1, -half_a_side), on_tangent(1, half_a_side)}}},
};

}  // namespace fastccd::testing
