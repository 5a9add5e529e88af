#pragma once

#include <gmpxx.h>

#include <array>
#include <span>

#include "pair.hpp"

namespace fastccd::oracle {

/// The number numerator / 2^level. Every finite double is one, so no rounding takes place on the way in.
struct Dyadic {
    mpz_class numerator;
    mp_bitcnt_t level = 0;
};

/// The exact value of a finite double with |value| <= 2^shift, divided by 2^shift; shift = 0 is the plain value.
/// Integers beyond 2^53 come out as they are, with level 0.
Dyadic to_dyadic(double value, int shift = 0);

/// Sign of a - b.
int compare(const Dyadic& a, const Dyadic& b);

/// Writes both, unchanged in value, with the larger one of their levels.
void bring_to_common_level(Dyadic& a, Dyadic& b);

/// Multiplies finite doubles by the one power of two that makes them all integers and returns its exponent e:
/// integers[i] = values[i] 2^e, exactly.
int to_common_integers(std::span<const double> values, std::span<mpz_class> integers);

}  // namespace fastccd::oracle
