#pragma once

#include "pair.hpp"

namespace fastccd::oracle {

enum class Separation { certainly_apart, not_excluded };

/// Tries to prove that the closed primitives do not touch at any time of [t_begin, t_end], by halving the interval up
/// to `depth` times and looking at no more than `max_intervals`. The proofs are planes that separate the primitives
/// during a whole subinterval: no cubic, no root, nothing in common with exact_ccd but the reading of doubles.
///
/// `certainly_apart` is exact; pairs that touch never get it. Pairs that are apart all the time do if the limits allow:
/// the depth is at most about log2(speed x duration / least distance).
Separation subdivide(Kind kind, const Pair& pair, double t_begin, double t_end, int depth, int max_intervals = 1000);

}  // namespace fastccd::oracle
