// Error bounds from the magnitudes of the products themselves, tighter than those from extents.
//
// A sum of products errs relative to the sum of the absolute values of its terms. Where many pairs are decided, lanes bound every
// term by the extents. The certified search, which has the last word, adds the terms up, and so do lanes for roots that lie close
// to the end of a leaf: the same formulas as in coplanarity.hpp, of absolute values and with every sign positive. The bounds never
// exceed those from extents, on which the other margins of the lanes rest.
//
// With t_max != 1 (rho = 10) a component a1 of r_i at the end of the interval is (1 - t) a0 + t q, which may cancel: it errs by
// at most u (4 |(1 - t) a0| + 3 |t q|) <= u (7 |a0| + 3 |a1|), not by a multiple of |a1|; a0 errs by u |a0|. What 7 |a0| adds to
// a coefficient are terms of the coefficient before it. So the bounds below are relative to the largest sum of terms, m, of all
// coefficients, and would be wrong for each by itself. With S0, S1, S2 the sums of the terms of the Bernstein coefficients
// (inner ones divided by 2 and 3), factors err by
//     r_i x r_j:                     2 S0,  7 S0 + 4 S1,  14 S1 + 6 S2:               at most 2 rho m,
//     the cubic:                     3 F0,  7 F0 + 5 F1,  14 F1 + 7 F2,  21 F2 + 9 F3:  at most 3 rho m,
// in units of u; roundings of the products themselves come on top.
#pragma once

#include <coplanarity.hpp>
#include <error_bound.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Share of the bound from extents that is kept, against products of tiny components that underflow: volumes are at least
/// smallest_volume here (the search's extents at least 2^-100, scaling.hpp), so this is far above 2^-975 (length_floor). An axis without any
/// extent has that of the floor: there, all products are exactly 0.
inline constexpr double underflow_share = 0x1p-40;

template <class L>
FASTCCD_INLINE Vector3<L> absolute(const Vector3<L>& v)
{
    return {abs(v.x), abs(v.y), abs(v.z)};
}

template <class L>
FASTCCD_INLINE Vector3<L> cross_magnitude(const Vector3<L>& a, const Vector3<L>& b)
{
    return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}

/// Sums of the absolute terms of the Bernstein coefficients of r_i x r_j; the middle one doubled.
template <class L>
FASTCCD_INLINE QuadraticVector<L> cross_product_magnitude(const RelativeMotion<L>& r, int i, int j)
{
    const Vector3<L> a0 = absolute(r.start[i]), a1 = absolute(r.end[i]);
    const Vector3<L> b0 = absolute(r.start[j]), b1 = absolute(r.end[j]);
    return {cross_magnitude(a0, b0), add(cross_magnitude(a0, b1), cross_magnitude(a1, b0)), cross_magnitude(a1, b1)};
}

/// The largest sum of the absolute terms of a Bernstein coefficient of the coplanarity cubic.
template <class L>
FASTCCD_INLINE L cubic_magnitude(const RelativeMotion<L>& r)
{
    const QuadraticVector<L> p = cross_product_magnitude(r, 0, 1);
    const Vector3<L> c0 = absolute(r.start[2]), c1 = absolute(r.end[2]);
    return max(max(dot(p.start, c0), dot(p.end, c1)),
               max(dot(p.twice_middle, c0) + dot(p.start, c1), dot(p.end, c0) + dot(p.twice_middle, c1)) / broadcast<L>(3.0));
}

/// Bound of the coefficients of one component of r_i x r_j on any part of the interval.
/// Terms err by 2 rho + 1 (factors, product), sums by 2 more (the middle coefficient), the two blossom levels by 6: relative
/// to m, the largest sum of magnitudes of the three, which also bounds the coefficients.
template <class L>
FASTCCD_INLINE L quadratic_bound(L start, L twice_middle, L end, L from_extents, const ErrorBounds& bounds)
{
    const L m = max(start, broadcast<L>(0.5) * twice_middle, end);
    const L bound = broadcast<L>((2 * bounds.rho + 9 + ErrorBounds::slack) * ErrorBounds::u) * m;
    return min(bound + broadcast<L>(underflow_share) * from_extents, from_extents);
}

/// Bound of the Bernstein coefficients of the coplanarity cubic on any part of the interval, in the certified search.
/// Terms of 3 f1: 2 rho + 1, + 2 for the sums of the cross products, rho + 1 for the third factor, + 3 for the sums of
/// the dot products, + 2 for the multiplication by 1/3, and 9 for three blossom levels: 3 rho + 18.
template <class L>
FASTCCD_INLINE L cubic_bound(const RelativeMotion<L>& r, L from_extents, const ErrorBounds& bounds)
{
    const L bound = broadcast<L>((3 * bounds.rho + 18 + ErrorBounds::slack) * ErrorBounds::u) * cubic_magnitude(r);
    return min(bound + broadcast<L>(underflow_share) * from_extents, from_extents);
}

/// What ErrorBounds::cubic_on_interval_lanes() is to extents: a strict sign beyond this on [a, b] in the lanes is one in the search, beyond
/// its bound, on every part of [a, b]. Added are the blossom levels of both, 9 each, and, as lanes do not scale axes, what may
/// underflow here.
template <class L>
FASTCCD_INLINE L cubic_bound_lanes(const RelativeMotion<L>& r, L volume, const ErrorBounds& bounds)
{
    const double per_magnitude = (3 * bounds.rho + 36 + 2 * ErrorBounds::slack) * ErrorBounds::u;
    const L from_extents = broadcast<L>(bounds.cubic_on_interval_lanes()) * volume;
    return min(broadcast<L>(per_magnitude) * cubic_magnitude(r) + broadcast<L>(2 * underflow_share) * from_extents, from_extents);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
