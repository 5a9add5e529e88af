// Running the library on the pairs of the tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "oracle/pair.hpp"

namespace fastccd::testing {

PairKind pair_kind(oracle::Kind kind);
const char* kind_name(oracle::Kind kind);

/// The pairs in the native layout.
PairBuffer to_buffer(const std::vector<oracle::Pair>& pairs);
PairView interleaved(const std::vector<oracle::Pair>& pairs);

struct Answer {
    std::vector<double> toi;
    std::vector<std::uint8_t> roots;
    Summary summary;
};
/// Dense answer with roots. Throws std::runtime_error if the library reports an error.
Answer answer(oracle::Kind kind, const PairView& pairs, const Options& options);
/// The same without roots, which lets lanes stop at the first contact.
Answer answer_without_roots(oracle::Kind kind, const PairView& pairs, const Options& options);

/// Every instruction set of this build, except those this machine lacks; names those once on stderr, loudly.
std::vector<Isa> isas_to_test();

/// Index of the first pair with other bits in toi or another number of roots; the size if there is none.
std::size_t first_difference(const Answer& a, const Answer& b);

/// 24 hexadecimal floating-point numbers: a pair, losslessly, for a failure message.
std::string lossless(const oracle::Pair& pair);

}  // namespace fastccd::testing
