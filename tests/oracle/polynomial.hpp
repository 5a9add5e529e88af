#pragma once

#include <gmpxx.h>

#include <array>

#include "dyadic.hpp"

namespace fastccd::oracle {

/// Polynomial of degree 3 or less with integer coefficients; coefficient[i] belongs to t^i.
/// Degree 3 is all that moving points need: coordinates are linear, areas quadratic, volumes cubic.
struct Polynomial {
    std::array<mpz_class, 4> coefficient;

    /// -1 for the zero polynomial.
    int degree() const;
    bool is_zero() const { return degree() < 0; }

    friend bool operator==(const Polynomial&, const Polynomial&) = default;
};

Polynomial operator+(const Polynomial& a, const Polynomial& b);
Polynomial operator-(const Polynomial& a, const Polynomial& b);
/// The degrees of the factors must not add up to more than 3.
Polynomial operator*(const Polynomial& a, const Polynomial& b);

Polynomial derivative(const Polynomial& p);

/// p divided by the greatest common divisor of its coefficients, leading coefficient positive: polynomials that are
/// multiples of each other become equal.
Polynomial primitive_part(const Polynomial& p);

/// Greatest common divisor over the rationals, as a primitive polynomial. Its roots are exactly the common roots.
Polynomial gcd(const Polynomial& a, const Polynomial& b);

/// a / b, primitive, for b that divides a over the rationals.
Polynomial exact_quotient(const Polynomial& a, const Polynomial& b);

/// Sign of p at an exact place.
int sign_at(const Polynomial& p, const Dyadic& place);

/// Bernstein coefficients of p on [n, n + 1] / 2^level, times a positive number.
/// p there lies within their hull, and has as many roots inside as they have sign changes, less an even number
/// (Descartes' rule in Bernstein form; Farouki, "The Bernstein polynomial basis", CAGD 29 (2012), section 4).
std::array<mpz_class, 4> bernstein(const Polynomial& p, const mpz_class& n, mp_bitcnt_t level);

/// +1 or -1 if the Bernstein coefficients prove that p has this sign on all of [n, n + 1] / 2^level, else 0.
int sign_on(const Polynomial& p, const mpz_class& n, mp_bitcnt_t level);

/// Number of sign changes in the Bernstein coefficients on [n, n + 1] / 2^level.
int sign_changes(const Polynomial& p, const mpz_class& n, mp_bitcnt_t level);

}  // namespace fastccd::oracle
