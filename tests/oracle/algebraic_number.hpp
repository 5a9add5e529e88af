#pragma once

#include <optional>
#include <vector>

#include "dyadic.hpp"
#include "polynomial.hpp"

namespace fastccd::oracle {

/// A real number in [0, 1]: either a dyadic number, known exactly, or the only root of a polynomial in an open
/// interval with dyadic ends. Questions about it are decided exactly; the interval narrows as they demand,
/// which changes the representation but never the number.
class AlgebraicNumber {
public:
    explicit AlgebraicNumber(Dyadic value);

    /// The root of `p` in (n, n + 1) / 2^level. It must be simple and the only one there, and p must not vanish
    /// at either end: then p changes sign across the root and a bisection can follow it.
    AlgebraicNumber(Polynomial p, mpz_class n, mp_bitcnt_t level);

    /// Sign of g at this number, exactly.
    int sign_of(const Polynomial& g);

    /// Sign of this number minus `value`.
    int compare_to(const Dyadic& value) const;

    /// Sign of this number minus `other`.
    int compare_to(AlgebraicNumber& other);

private:
    bool is_exact() const { return polynomial_.is_zero(); }
    Dyadic lower_end() const { return {n_, level_}; }
    Dyadic upper_end() const { return {is_exact() ? n_ : mpz_class(n_ + 1), level_}; }
    void halve();
    bool is_root_of(const Polynomial& g) const;

    Polynomial polynomial_;  // zero: the number is n / 2^level
    mpz_class n_;
    mp_bitcnt_t level_ = 0;
    int sign_before_ = 0;  // of the polynomial between the lower end and the root
};

struct Root {
    AlgebraicNumber value;
    int multiplicity;
};

/// All distinct real roots of a non-zero polynomial in the closed interval [0, 1], in no particular order.
std::vector<Root> roots_in_unit_interval(const Polynomial& p);

}  // namespace fastccd::oracle
