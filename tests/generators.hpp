#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "oracle/pair.hpp"

namespace fastccd::testing {

/// Names of the families of hard pairs: each once with doubles, and once, as "f32_NAME", with coordinates that are
/// floats (widened). generators.cpp lists what each one is about.
const std::vector<std::string>& families();

/// Replaces `out` by n pairs of a family. The same arguments give the same bits with every compiler and standard
/// library, provided that no products and sums are contracted (-ffp-contract=off). All coordinates are finite.
/// Throws std::invalid_argument for an unknown family.
void generate(const std::string& family, oracle::Kind kind, std::uint64_t seed, std::size_t n,
              std::vector<oracle::Pair>& out);

/// `per_family` pairs of each family, in an order in which any batch holds easy and hard ones, of both kinds of coordinates.
std::vector<oracle::Pair> mixed_pairs(oracle::Kind kind, std::uint64_t seed, std::size_t per_family);

}  // namespace fastccd::testing
