#pragma once

#include <gmpxx.h>

#include <array>

#include "dyadic.hpp"
#include "pair.hpp"

namespace fastccd::oracle {

using IntegerVector = std::array<mpz_class, 3>;
using IntegerPoints = std::array<IntegerVector, 4>;

/// A pair multiplied by the power of two that makes all 24 coordinates integers; the same one on every axis, so that
/// distances keep their ratios.
struct IntegerPair {
    explicit IntegerPair(const Pair& pair);

    /// The four points at time t, times 2^(exponent + t.level).
    IntegerPoints at(const Dyadic& t) const;

    std::array<IntegerVector, 8> point;
    int exponent = 0;
};

/// The shortest vector from the first closed primitive to the second one: numerator / denominator, denominator > 0.
/// Zero exactly if they touch. Degenerate primitives are the segments or points that they have become.
struct ShortestVector {
    IntegerVector numerator;
    mpz_class denominator;
};
ShortestVector shortest_vector(Kind kind, const IntegerPoints& points);

/// Exact squared distance between the two closed primitives at time t; all coordinates and t finite.
mpq_class squared_distance(Kind kind, const Pair& pair, double t);

/// The sum over the axes of the largest |component| of x_i - x_0 at both ends of the step: the size that rounding goes by.
mpq_class sum_of_extents(const Pair& pair);

/// By how much the distance at time t exceeds `allowed` >= 0, in units of `size` > 0; 0 if it does not. Exact but for the last root and division.
double excess_of_distance(Kind kind, const Pair& pair, double t, const mpq_class& allowed, const mpq_class& size);

}  // namespace fastccd::oracle
