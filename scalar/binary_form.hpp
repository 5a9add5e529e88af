// Polynomials over [0, 1] with integer coefficients, and their signs at each other's roots, without any rounding.
#pragma once

#include <optional>
#include <vector>

#include <gmpxx.h>

namespace fastccd::scalar {

/// F(v, u) = sum of coefficients[k] v^(d-k) u^k, a form of degree d in v = 1 - u and u. Its coefficients are the
/// Bernstein coefficients of the polynomial F(1 - u, u), each times a binomial coefficient: the same signs.
struct BinaryForm {
    std::vector<mpz_class> coefficients;

    [[nodiscard]] std::size_t degree() const { return coefficients.size() - 1; }
    [[nodiscard]] bool is_zero() const;
    /// Sign at u = 0 and at u = 1.
    [[nodiscard]] int at_start() const { return sgn(coefficients.front()); }
    [[nodiscard]] int at_end() const { return sgn(coefficients.back()); }
    /// Sign variations of the coefficients: at least the number of roots in (0, 1), and as many if 0 or 1 (Descartes).
    [[nodiscard]] int variations() const;
};

BinaryForm operator+(const BinaryForm& a, const BinaryForm& b);  ///< Of equal degree.
BinaryForm operator-(const BinaryForm& a, const BinaryForm& b);  ///< Of equal degree.
BinaryForm operator*(const BinaryForm& a, const BinaryForm& b);

/// A part of [0, 1] by halving: [index, index + 1] / 2^depth.
struct DyadicPart {
    mpz_class index = 0;
    unsigned depth = 0;
};

/// The form over a part of [0, 1], as a form over [0, 1].
BinaryForm restricted(const BinaryForm& f, const DyadicPart& part);

/// A root in [0, 1] of a form: a number index / 2^depth, or the only one inside a part.
class AlgebraicTime {
public:
    static AlgebraicTime rational(DyadicPart at) { return AlgebraicTime{std::nullopt, std::move(at)}; }
    /// `f`, without multiple roots, has exactly one root inside the part and none at its ends.
    static AlgebraicTime inside(BinaryForm f, DyadicPart part) { return AlgebraicTime{std::move(f), std::move(part)}; }

    [[nodiscard]] bool is_start() const { return !form_ && where_.index == 0; }
    /// Sign of q there.
    [[nodiscard]] int sign(const BinaryForm& q);
    /// Largest k with k / 2^depth <= this time.
    [[nodiscard]] mpz_class floor_times_two_to(unsigned depth);

private:
    AlgebraicTime(std::optional<BinaryForm> form, DyadicPart where) : form_{std::move(form)}, where_{std::move(where)} {}

    void halve();

    std::optional<BinaryForm> form_;  ///< None: the time is where_.index / 2^where_.depth.
    DyadicPart where_;
};

/// The roots of `f`, which is not zero, in [0, 1], in increasing order, each once.
std::vector<AlgebraicTime> roots(const BinaryForm& f);

}  // namespace fastccd::scalar
