// Householder's iteration of third order, kept inside a bracket (paper, section 4.1.1; Householder,
// "The Numerical Treatment of a Single Nonlinear Equation", 1970).
//
// Nothing is concluded from the iteration having converged: its result is a guess that sign tests on
// both sides prove or leave undecided.
#pragma once

#include <sign_change.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

// How far each stage goes, found by measuring; results do not depend on it, only how many pairs stay undecided.

/// Steps before a root is decided for the first time; with four, what is saved later is spent here.
inline constexpr int quick_steps = 3;
/// Half width of the bracket around its root on which a candidate is dismissed then, and over which one in contact is to be
/// inside: wide against rounding, narrow enough that edge functions rarely vanish within it.
inline constexpr double quick_bracket = 0x1p-20;
/// Steps of the others, which keep a bracket. With five, a few more roots were left to the certified search.
inline constexpr int most_steps = 6;
/// Half width of the bracket around their roots: small against any curvature that matters, large against E_tol.
inline constexpr double fine_bracket = 0x1p-16;

/// Householder's next guess from s, with f(s) in `value`; any value, NaN included, far from a simple root.
template <class L>
FASTCCD_INLINE L householder_guess(const PowerCubic<L>& f, L s, L value)
{
    const L three_c3 = broadcast<L>(3.0) * f.c3;
    const L slope = (three_c3 * s + (f.c2 + f.c2)) * s + f.c1;  // f'
    const L half_curvature = three_c3 * s + f.c2;              // f'' / 2
    // s - f (f'^2 - f f''/2) / (f'^3 - f f' f'' + f^2 f'''/6), with f''' / 6 = c3
    const L slope_squared = slope * slope;
    const L product = value * half_curvature;
    const L numerator = value * (slope_squared - product);
    const L denominator = slope * (slope_squared - (product + product)) + (value * value) * f.c3;
    return s - numerator / denominator;
}

/// A root of f is sought between low and high.
template <class L>
struct Bracket {
    L low, high;
};

/// Weight of the secant in first_guess: of 0.4, 0.5 and 0.55 to 0.8, the one after which two steps find the most roots of random pairs.
inline constexpr double secant_weight = 0.65;

/// Where to begin in a monotone piece, given f at its ends: between its middle and where the secant vanishes, as most pieces bend like
/// an S from one extremum to the next.
template <class L>
FASTCCD_INLINE L first_guess(const Bracket<L>& piece, L at_low, L at_high)
{
    const L secant = at_low / (at_low - at_high);
    const L share = broadcast<L>(0.5 * (1.0 - secant_weight)) + broadcast<L>(secant_weight) * secant;
    return piece.low + (piece.high - piece.low) * share;
}

/// One step from s, clipped to the bracket: close to most roots in the fewest instructions.
template <class L>
FASTCCD_INLINE L clipped_step(const PowerCubic<L>& f, const Bracket<L>& bracket, L s)
{
    return max(min(householder_guess(f, s, evaluate(f, s)), bracket.high), bracket.low);
}

/// A step from s that closes the bracket around the root of a monotone f by the sign of f(s), and bisects
/// where Householder's guess leaves it. `rising` where f is negative at the low end.
template <class L>
FASTCCD_INLINE L bracketed_step(const PowerCubic<L>& f, LaneMask<L> rising, Bracket<L>& bracket, L s)
{
    const L value = evaluate(f, s);
    const LaneMask<L> negative = less(value, broadcast<L>(0.0));
    const LaneMask<L> root_after = (negative & rising) | !(negative | rising);
    bracket.low = select<L>(root_after, s, bracket.low);
    bracket.high = select<L>(root_after, bracket.high, s);
    const L next = householder_guess(f, s, value);
    // Closed: a converged guess is an end of its bracket.
    const LaneMask<L> inside = less_equal(bracket.low, next) & less_equal(next, bracket.high);
    return select<L>(inside, next, (bracket.low + bracket.high) * broadcast<L>(0.5));
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
