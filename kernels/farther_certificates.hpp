// Certificates of a distance above d over the whole interval, from those of absence of contact.
//
// Two primitives are within d exactly if they touch once the second one is moved by some vector v, |v| <= d. Then
//
//     f becomes f + v . n,   n = r1 x r2 + r2 x r3 + r3 x r1 (vertex-face) or r1 x r2 - r1 x r3 (edge-edge),   |v . n| <= d |n|:
//
// what has v twice or three times is zero. An edge function, along an axis, becomes
//
//     (r_i + v) x (r_j + v) = r_i x r_j + v x (r_j - r_i)   or   r1 x (r_j + v) = r1 x r_j + r1 x v,
//
// (the fourth of two edges, (r3 - r2) x (r1 - r2 - v), by (r3 - r2) x v), of which the last term is at most d times the length of r_j - r_i
// or r1 in the projection. So where f exceeds d |n|, or edge functions d times these lengths, the certificates of contact (certificates.hpp)
// hold for all v at once: the pair stays farther than d. A gap along an axis only has to exceed d. On Bernstein coefficients as there: |n| is
// at most the largest |coefficient| of n, and lengths at both ends of the interval bound those in between.
// Bounds: SeparationBounds::certificates().
//
// The direction of a single look (separation_certificate.hpp) proves more where primitives are close; this costs less than a look and settles most
// pairs that no axis keeps apart.
#pragma once

#include <halves_certificate.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class L>
FASTCCD_INLINE L largest_area(const Scales<L>& scale)
{
    return max(scale.yz, scale.zx, scale.xy);
}

/// By the cubic on the whole interval. Components of r are at most the extents, so those of a cross product twice an area, and |n| is at
/// most sqrt(3) times 6 (vertex-face) or 4 areas: below 10.5 and 7 by 1 %, which covers what extents and products err by.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> farther_by_volume(const CoplanarityCubic<L>& f, const Scales<L>& scale, const FartherBounds& bounds)
{
    constexpr double areas = kind == PairKind::vertex_face ? 10.5 : 7.0;
    const L bound = broadcast<L>(bounds.volume_on_whole) * scale.volume + broadcast<L>(3.0 * areas * bounds.distance) * largest_area(scale);
    const L three = broadcast<L>(3.0);
    return one_sign(bound, three * f.start, f.thrice_second, f.thrice_third, three * f.end);
}

/// n, from the edge functions p, q, t of visit_edge_functions().
template <PairKind kind, class L>
FASTCCD_INLINE QuadraticVector<L> normal(const QuadraticVector<L>& p, const QuadraticVector<L>& q, const QuadraticVector<L>& t)
{
    if constexpr (kind == PairKind::vertex_face)
        return {add(add(p.start, q.start), t.start), add(add(p.twice_middle, q.twice_middle), t.twice_middle), add(add(p.end, q.end), t.end)};
    else
        return {subtract(p.start, t.start), subtract(p.twice_middle, t.twice_middle), subtract(p.end, t.end)};
}

/// Not below |n| over the whole interval.
template <class L>
FASTCCD_INLINE L longest(const QuadraticVector<L>& n, const Scales<L>& scale, const FartherBounds& bounds)
{
    const auto largest = [](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return max(abs(v.x), abs(v.y), abs(v.z)); };
    const L component = max(max(largest(n.start), largest(n.end)), broadcast<L>(0.5) * largest(n.twice_middle));
    return broadcast<L>(1.7320508075688774) * component + broadcast<L>(bounds.normal) * largest_area(scale);
}

/// Coefficients on halves come in different multiples, which do not matter where they are compared with nothing but rounding; d is the same for
/// all of them. All at 12 times a coefficient, and 4 times:
template <class L>
FASTCCD_INLINE HalvedCubic<L> evened(const HalvedCubic<L>& f)
{
    const L two = broadcast<L>(2.0), twelve = broadcast<L>(12.0), middle = broadcast<L>(1.5) * f.first[3];
    return {{twelve * f.first[0], two * f.first[1], f.first[2], middle}, {middle, f.second[1], two * f.second[2], twelve * f.second[3]}};
}
template <class L>
FASTCCD_INLINE HalvedQuadratic<L> evened(const HalvedQuadratic<L>& f)
{
    const L two = broadcast<L>(2.0), four = broadcast<L>(4.0);
    return {four * f.start, two * f.first, f.middle, two * f.second, four * f.end};
}

/// On each half, by the cubic or in a coordinate projection.
template <PairKind kind, class L>
FASTCCD_INLINE ApartOnHalves<L> farther_on_halves(const CoplanarityCubic<L>& f, const QuadraticVector<L>& p, const QuadraticVector<L>& q,
                                                  const QuadraticVector<L>& t, const QuadraticVector<L>& s, const Extents<L>& extents,
                                                  const Scales<L>& scale, const FartherBounds& bounds)
{
    const L volume_bound = broadcast<L>(bounds.halves.cubic) * scale.volume +
                           broadcast<L>(12.0 * bounds.distance) * longest(normal<kind>(p, q, t), scale, bounds);
    const L extent[3] = {extents.x, extents.y, extents.z};
    return apart_on_halves<kind>(
        evened(halved(f)), volume_bound, p, q, t, s, scale, [](const HalvedQuadratic<L>& h) FASTCCD_INLINE_LAMBDA { return evened(h); },
        [&](L area, int a, int b) FASTCCD_INLINE_LAMBDA -> ProjectionBounds<L> {
            // In the projection r1 is at most as long as the sum of its extents, and a difference of two r_i twice that.
            const L of_r1 = broadcast<L>(4.0 * bounds.distance) * (extent[a] + extent[b]), of_difference = of_r1 + of_r1;
            return {broadcast<L>(bounds.halves.quadratic) * area + (kind == PairKind::vertex_face ? of_difference : of_r1),
                    broadcast<L>(bounds.halves.quadratic_sum) * area + of_difference};
        });
}

/// Farther than d on each half by any of the certificates: a gap along an axis, or those of halves. What farther_by_volume() proves is included,
/// by its bound. `extents` are set.
template <PairKind kind, class L>
FASTCCD_INLINE ApartOnHalves<L> farther_on_halves(const RelativeMotion<L>& r, const FartherBounds& bounds, Extents<L>& extents)
{
    const LaneMask<L> along_axis = linear_certificate<kind>(r, bounds, extents);
    const Scales<L> scale = scales(extents);
    const CoplanarityCubic<L> f = coplanarity_cubic(r, cross_product(r, 0, 1));
    const ApartOnHalves<L> farther =
        visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
            return farther_on_halves<kind>(f, p, q, t, s, extents, scale, bounds);
        });
    return {along_axis | farther.first, along_axis | farther.second};
}

/// n between two times at which the positions are `a` and `b`.
template <PairKind kind, class L>
FASTCCD_INLINE QuadraticVector<L> normal_between(const Vector3<L> (&a)[3], const Vector3<L> (&b)[3])
{
    if constexpr (kind == PairKind::vertex_face)
        return cross_product(RelativeMotion<L>{{subtract(a[1], a[0]), subtract(a[2], a[1])}, {subtract(b[1], b[0]), subtract(b[2], b[1])}}, 0, 1);
    else
        return cross_product(RelativeMotion<L>{{a[0], subtract(a[1], a[2])}, {b[0], subtract(b[1], b[2])}}, 0, 1);
}

/// |v|, but for rounding not below it. Squares may underflow, each by 2^-1075: a root errs by at most 2^-536 then.
template <class L>
FASTCCD_INLINE L length_from_above(const Vector3<L>& v)
{
    return sqrt(dot(v, v)) + broadcast<L>(0x1p-500);
}

/// Between two times, by f alone, with |n| followed: f - d |n| is positive where the coefficients of f exceed d times those of
/// sum_i B_i |n_i|, of degree 2 raised to 3. Where the primitives approach face to vertex or edge across edge, their distance is |f| / |n|,
/// so this holds until shortly before they come within d, however fast n turns. `extents`: of the whole motion.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> farther_between(const Vector3<L> (&a)[3], const Vector3<L> (&b)[3], const Extents<L>& extents, double distance,
                                           const SeparationBounds& bounds)
{
    const QuadraticVector<L> n = normal_between<kind>(a, b);
    const CoplanarityCubic<L> f = coplanarity_cubic(RelativeMotion<L>{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}}, n);  // n . r3
    const L at_a = length_from_above(n.start), at_b = length_from_above(n.end), twice_middle = length_from_above(n.twice_middle);
    const Scales<L> scale = scales(extents);
    const L d = broadcast<L>(distance), three = broadcast<L>(3.0);
    const L bound = broadcast<L>(bounds.volume_between()) * scale.volume + (d * broadcast<L>(bounds.normal_between())) * largest_area(scale);
    const auto beyond = [&](L coefficient, L lengths) FASTCCD_INLINE_LAMBDA { return less(d * lengths + bound, times_sign(coefficient, f.start)); };
    return beyond(three * f.start, three * at_a) & beyond(f.thrice_second, at_a + twice_middle) &
           beyond(f.thrice_third, twice_middle + at_b) & beyond(three * f.end, three * at_b);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
