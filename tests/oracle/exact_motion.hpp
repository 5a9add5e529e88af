#pragma once

#include <array>
#include <vector>

#include "algebraic_number.hpp"
#include "pair.hpp"
#include "polynomial.hpp"

namespace fastccd::oracle {

/// The motion of a pair with integer coefficients. Each axis is scaled by its own power of two, and time by another
/// one, t = u 2^time_exponent, such that u in [0, 1] covers [0, t_max]. Contact is invariant under both.
class ExactMotion {
public:
    ExactMotion(const Pair& pair, double t_max);

    /// t_max in units of u, in (1/2, 1], or 0.
    const Dyadic& end() const { return end_; }
    int time_exponent() const { return time_exponent_; }

    /// Component `axis` of xj - xi; linear in u.
    Polynomial difference(int i, int j, int axis) const;

    /// Component `axis` of (xj - xi) x (xl - xk): twice the signed area that they span seen along the axis; quadratic.
    Polynomial cross(int i, int j, int k, int l, int axis) const;

    /// Component `axis` of (xj - xi) x (xk - xi): the triangle's area; its sign is the turn i -> j -> k.
    Polynomial area(int i, int j, int k, int axis) const { return cross(i, j, i, k, axis); }

    /// det(x1 - x0, x2 - x0, x3 - x0): the coplanarity cubic (the paper's eq. 5).
    Polynomial volume() const;

    /// All areas, cross products and differences that decide static contact of coplanar points, without multiples.
    std::vector<Polynomial> planar_events() const;

private:
    std::array<std::array<Polynomial, 3>, 4> point_;  // [point][axis]
    Dyadic end_;
    int time_exponent_ = 0;
};

struct StaticContact {
    bool touching;
    bool degenerate;  // see Verdict::degenerate
};

/// Whether the primitives touch at `time`, at which the four points must be coplanar.
StaticContact contact_at(Kind kind, const ExactMotion& motion, AlgebraicNumber& time);

}  // namespace fastccd::oracle
