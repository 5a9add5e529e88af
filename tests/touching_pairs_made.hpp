// Pairs that may touch, and leaves to look at, for touching_test.cpp and touching_lanes_test.cpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <interval_stack.hpp>
#include <search_parameters.hpp>

#include "generators.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {

inline constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

/// All families of hard pairs, and thin ones: look(pairs, name).
template <class Look>
void for_each_family(oracle::Kind kind, std::uint64_t seed, std::size_t count, Look look)
{
    std::vector<oracle::Pair> pairs;
    for (const std::string& family : families()) {
        generate(family, kind, seed, count, pairs);
        look(pairs, family);
    }
    pairs = ThinPairs{kind, seed}.next(count);
    look(pairs, "thin");
}

/// The leaves that hold s and lie on either side of it.
inline std::vector<scalar::Interval> leaves_around(double s, const SearchParameters& parameters)
{
    std::vector<scalar::Interval> leaves;
    for (int k = -1; k <= 1; ++k) {
        const double left = (std::floor(s * parameters.leaf_count) + k) * parameters.leaf_width;
        if (left > 0.0 && left + parameters.leaf_width <= 1.0) leaves.push_back({left, left + parameters.leaf_width});
    }
    return leaves;
}

}  // namespace fastccd::testing
