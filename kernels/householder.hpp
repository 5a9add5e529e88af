// Householder's iteration of third order, kept inside a bracket (paper, section 4.1.1; Householder,
// "The Numerical Treatment of a Single Nonlinear Equation", 1970).
//
// Nothing is concluded from the iteration having converged: its result is a guess that sign tests on
// both sides prove or leave undecided.
#pragma once

#include <sign_change.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// A root of f is sought between low and high; `rising` where f is negative at low.
template <class L>
struct Bracket {
    L low, high;
};

/// One step from s. Updates the bracket with the sign of f(s), and returns the next guess: Householder's
/// if it lies inside the bracket, the middle of the bracket otherwise.
template <class L>
FASTCCD_INLINE L householder_step(const PowerCubic<L>& f, LaneMask<L> rising, Bracket<L>& bracket, L s)
{
    const L value = evaluate(f, s);
    const L slope = ((broadcast<L>(3.0) * f.c3) * s + broadcast<L>(2.0) * f.c2) * s + f.c1;  // f'
    const L half_curvature = (broadcast<L>(3.0) * f.c3) * s + f.c2;                          // f'' / 2

    const LaneMask<L> negative = less(value, broadcast<L>(0.0));
    const LaneMask<L> root_after = (negative & rising) | !(negative | rising);
    bracket.low = select<L>(root_after, s, bracket.low);
    bracket.high = select<L>(root_after, bracket.high, s);

    // s - f (f'^2 - f f''/2) / (f'^3 - f f' f'' + f^2 f'''/6), with f''' / 6 = c3
    const L slope_squared = slope * slope;
    const L product = value * half_curvature;
    const L numerator = value * (slope_squared - product);
    const L denominator = slope * (slope_squared - (product + product)) + (value * value) * f.c3;
    const L next = s - numerator / denominator;

    // Closed: a converged guess is an end of its bracket.
    const LaneMask<L> inside = less_equal(bracket.low, next) & less_equal(next, bracket.high);
    return select<L>(inside, next, (bracket.low + bracket.high) * broadcast<L>(0.5));
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
