// One look at a time that answers for all intervals around it.
//
// Intervals on the way down to a contact have no certificate, and to find that out takes all of them. Where the pair meets at s, or
// comes as close to it as rounding can tell, values at s contradict each certificate on any interval that contains s: a value at s
// lies between the coefficients on the interval, which would all have to be beyond a bound.
//
// Both are computed. One lerp errs by 2.5 u M at most, M the larger magnitude of its operands: by u M of both products, (1 - s) M + s M in
// size, by u M of their sum, and by u / 2 M as 1 - s is rounded. Blossoms of n levels err by 2.5 n u C, C the largest coefficient on [0,
// 1]. So if all coefficients that the search computes on an interval are beyond its bound, a value computed at s within is beyond that
// bound less twice that much. It is not: so they are not. The sum or difference of bound and margin is rounded by u C at most, as there are
// no coefficients beyond a bound that is greater than C; a fifth of u is for terms in u^2. Of the bound of an edge function, 13 u or more
// of the sum of its terms (12 u where the bound from extents is the smaller one, magnitudes.hpp), this leaves 0.8 u at least for the
// rounding of a value that is zero. Of that of a gap, 12 u of the extent, it leaves nothing where the gap is up to twice the extent: then
// no look says that the pair meets. Over a leaf in which it does, C is small (restriction.hpp).
#pragma once

#include <interval_certificates.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// How far a value at s may lie outside of the coefficients on an interval that contains s, both computed.
template <class L>
FASTCCD_INLINE L value_margin(const Cubic<L>& f)
{
    return broadcast<L>((2 * 7.5 + 1.2) * ErrorBounds::u) * largest_magnitude(f);
}
template <class L>
FASTCCD_INLINE L value_margin(const Quadratic<L>& q)
{
    return broadcast<L>((2 * 5.0 + 1.2) * ErrorBounds::u) * largest_magnitude(q);
}

template <class L>
FASTCCD_INLINE L value_margin(const Linear<L>& f)
{
    return broadcast<L>((2 * 2.5 + 1.2) * ErrorBounds::u) * largest_magnitude(f);
}

template <class L>
FASTCCD_INLINE LaneMask<L> may_be_coplanar(const PolynomialsOf<L>& pair, L s)
{
    const Cubic<L> f = cubic_of(pair);
    return less_equal(abs(on_interval(f, s, s).c0) + value_margin(f), pair.cubic_bound);
}

/// As apart_along, with the signs that edge functions may have throughout an interval.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> may_touch_along(const PolynomialsOf<L>& pair, int axis, L s)
{
    const auto sign = [&](int edge) FASTCCD_INLINE_LAMBDA -> StrictSign<L> {
        const auto& e = pair.edges[axis][edge];
        const Quadratic<L> q = quadratic_of(e);
        const L value = on_interval(q, s, s).c0, needed = e.bound - value_margin(q);
        return {less(needed, value), less(value, negated(needed))};
    };
    const StrictSign<L> p = sign(0), q = sign(1), t = sign(2);
    if constexpr (kind == PairKind::vertex_face)
        return !not_inside(p, q, t);
    else
        return !(on_one_side(p, t) | on_one_side(q, sign(3)));
}

/// As separated_on along one axis: some vertex of the second primitive is not above, and some not below, some of the first.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> may_overlap_along(const PolynomialsOf<L>& pair, int axis, L s)
{
    LaneMask<L> reaches_up = no_lanes<L>(), reaches_down = reaches_up;
    for (int k = 0; k < gap_count(kind); ++k) {
        const auto& g = pair.gaps[axis][k];
        const Linear<L> gap = linear_of(g);
        const L value = lerp(gap.c0, gap.c1, s), needed = g.bound - value_margin(gap);
        reaches_up = reaches_up | !less(needed, value);
        reaches_down = reaches_down | !less(value, negated(needed));
    }
    return reaches_up & reaches_down;
}

/// Where no interval that contains s has one of the three certificates (apart_on), rounding included.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> meets_at(const PolynomialsOf<L>& pair, L s)
{
    LaneMask<L> meets = may_be_coplanar(pair, s);
    for (int axis = 0; axis < 3; ++axis) {
        if (Lane<L>::bits(meets) == 0) return meets;
        meets = meets & may_touch_along<kind>(pair, axis, s) & may_overlap_along<kind>(pair, axis, s);
    }
    return meets;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
