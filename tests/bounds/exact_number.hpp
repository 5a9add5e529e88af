// Exact values of what the kernels compute with rounding, from other formulas: blossoms as sums of determinants of
// positions, where the kernels expand end points.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fastccd::testing {

/// An integer times a power of two: doubles, their sums and products, without rounding.
class Exact {
public:
    Exact() = default;
    Exact(double value)  // NOLINT: a double is such a number
    {
        int exponent = 0;
        const double fraction = std::frexp(value, &exponent);
        mantissa_ = mpz_class(std::ldexp(fraction, 53));
        exponent_ = exponent - 53;
    }

    friend Exact operator+(const Exact& a, const Exact& b) { return sum(a, b, false); }
    friend Exact operator-(const Exact& a, const Exact& b) { return sum(a, b, true); }
    friend Exact operator*(const Exact& a, const Exact& b)
    {
        return {mpz_class(a.mantissa_ * b.mantissa_), a.exponent_ + b.exponent_};
    }

    [[nodiscard]] int sign() const { return sgn(mantissa_); }
    friend bool operator<(const Exact& a, const Exact& b) { return (a - b).sign() < 0; }

    /// |this| / unit, rounded.
    [[nodiscard]] double magnitude_in(double unit) const
    {
        if (sign() == 0) return 0.0;
        int unit_exponent = 0;
        const double unit_fraction = std::frexp(unit, &unit_exponent);  // 0: the result is infinite
        long exponent = 0;
        const double fraction = mpz_get_d_2exp(&exponent, mantissa_.get_mpz_t());
        const long shift = exponent + exponent_ - unit_exponent;
        return std::ldexp(std::fabs(fraction) / unit_fraction, static_cast<int>(std::clamp(shift, -5000L, 5000L)));
    }
    /// this / unit, rounded.
    [[nodiscard]] double in(double unit) const { return sign() * magnitude_in(unit); }

    /// The same number with many more digits than any computation here needs.
    [[nodiscard]] mpf_class wide() const
    {
        mpf_class value(mantissa_, 1024);
        if (exponent_ >= 0)
            value <<= static_cast<mp_bitcnt_t>(exponent_);
        else
            value >>= static_cast<mp_bitcnt_t>(-exponent_);
        return value;
    }

private:
    Exact(mpz_class mantissa, long exponent) : mantissa_{std::move(mantissa)}, exponent_{exponent} {}

    static Exact sum(const Exact& a, const Exact& b, bool negative)
    {
        if (b.sign() == 0) return a;
        const long exponent = a.sign() == 0 ? b.exponent_ : std::min(a.exponent_, b.exponent_);
        mpz_class left, right;
        if (a.sign() != 0) left = a.mantissa_ << static_cast<mp_bitcnt_t>(a.exponent_ - exponent);
        right = b.mantissa_ << static_cast<mp_bitcnt_t>(b.exponent_ - exponent);
        return {negative ? mpz_class(left - right) : mpz_class(left + right), exponent};
    }

    mpz_class mantissa_;
    long exponent_ = 0;
};

using ExactVector = std::array<Exact, 3>;

inline ExactVector operator-(const ExactVector& a, const ExactVector& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline ExactVector operator+(const ExactVector& a, const ExactVector& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline ExactVector cross(const ExactVector& a, const ExactVector& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Exact dot(const ExactVector& a, const ExactVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Exact determinant(const ExactVector& a, const ExactVector& b, const ExactVector& c) { return dot(a, cross(b, c)); }

/// r_i(s) = x_i(s t_max) - x_0(s t_max), i = 0, 1, 2 standing for x1, x2, x3, from 24 coordinates.
class ExactRelativeMotion {
public:
    ExactRelativeMotion(const double* coordinates, double t_max)
    {
        const Exact t = t_max, rest = Exact(1.0) - t;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto relative = [&](std::size_t end) {
                    return Exact(coordinates[12 * end + 3 * (i + 1) + axis]) - Exact(coordinates[12 * end + axis]);
                };
                start_[i][axis] = relative(0);
                end_[i][axis] = rest * start_[i][axis] + t * relative(1);
            }
    }

    [[nodiscard]] ExactVector at(std::size_t i, const Exact& s) const
    {
        const Exact rest = Exact(1.0) - s;
        ExactVector r;
        for (std::size_t axis = 0; axis < 3; ++axis) r[axis] = rest * start_[i][axis] + s * end_[i][axis];
        return r;
    }

private:
    ExactVector start_[3], end_[3];
};

/// Three times the Bernstein coefficients on [a, b] of det(r1, r2, r3): 3 F(a, a, b) is the sum of the three
/// determinants with one vector at b.
inline std::array<Exact, 4> thrice_cubic(const ExactRelativeMotion& r, const Exact& a, const Exact& b)
{
    ExactVector at_a[3], at_b[3];
    for (std::size_t i = 0; i < 3; ++i) at_a[i] = r.at(i, a), at_b[i] = r.at(i, b);
    const auto one_at = [](const ExactVector (&one)[3], const ExactVector (&two)[3]) {
        return determinant(one[0], two[1], two[2]) + determinant(two[0], one[1], two[2]) +
               determinant(two[0], two[1], one[2]);
    };
    const Exact three = 3.0;
    return {three * determinant(at_a[0], at_a[1], at_a[2]), one_at(at_b, at_a), one_at(at_a, at_b),
            three * determinant(at_b[0], at_b[1], at_b[2])};
}

/// Twice the Bernstein coefficients on [a, b] of u x v for linear u and v given at both ends.
inline std::array<ExactVector, 3> twice_cross(const ExactVector& ua, const ExactVector& va, const ExactVector& ub,
                                              const ExactVector& vb)
{
    const ExactVector start = cross(ua, va), end = cross(ub, vb);
    return {start + start, cross(ua, vb) + cross(ub, va), end + end};
}

}  // namespace fastccd::testing
