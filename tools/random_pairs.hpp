// The paper's random test (section 7, Table 1): every position at t = 0 and t = 1 uniform in the
// unit cube.
#pragma once

#include <cstddef>
#include <cstdint>

#include <fastccd/pair_buffer.hpp>

namespace fastccd::tools {

/// The largest number of pairs of one seed; each of their coordinates has a counter of 64 bits.
inline constexpr std::uint64_t most_random_pairs = std::uint64_t{1} << 59;

/// Fills `pairs` with pairs first_pair, first_pair + 1, ... of the endless sequence that `seed`
/// stands for, in parallel in the caller's oneTBB arena. What a pair holds depends on seed and pair
/// number alone, so a sequence may be cut anywhere and made in any order by any number of threads.
///
/// Coordinate c of pair i is a multiple of 2^-53, uniform in [0, 1): the top 53 bits of output
/// 24 i + c of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
/// generators"), which is a hash of a counter and passes BigCrush. Its starting point is itself a
/// hash of the seed, so that neighbouring seeds give unrelated sequences.
void fill_random_pairs(std::uint64_t seed, std::uint64_t first_pair, PairBuffer& pairs);

}  // namespace fastccd::tools
