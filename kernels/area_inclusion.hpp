// The area inclusion test (paper, eq. 6, 7 and Lemma 4.1; for two edges E-E 2^ of section 5), with
// rounding, as a proof of absence within delta of a time.
//
// If there is contact at some s with |s - c| <= delta, then at c
//     vertex-face:  |r1 x r2| + |r2 x r3| + |r3 x r1| - |w|     <= 2 sum E,
//     edge-edge:  | |r1 x r2| + |r1 x r3| - |r2 x r3| - |w| |   <= 2 sum E
// in doubled areas, w = r1 x r2 + r2 x r3 + r3 x r1 that of x1 x2 x3, with E = delta C1 C2 + delta^2 C2^2 / 2 for each of the four
// triangles (eq. 6) and C1, C2 the largest edge and the largest velocity difference. Both are bounded from above here, once for all four
// triangles: C1 by the largest edge over both ends of the interval (an edge is a convex function of time), so that the same constants
// serve every time c.
#pragma once

#include <certificates.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class L>
FASTCCD_INLINE L norm(const Vector3<L>& v)
{
    return sqrt(dot(v, v));
}

/// C1 and C2 of eq. 6 over the whole motion of r as computed, with velocities as computed, but for a dozen roundings.
template <class L>
struct MotionBounds {
    L edge, speed;
};

template <class L>
FASTCCD_INLINE MotionBounds<L> motion_bounds(const RelativeMotion<L>& r)
{
    // Squares first, one square root each: the six differences of the four points.
    const auto largest_square = [](const Vector3<L>& a, const Vector3<L>& b, const Vector3<L>& c) FASTCCD_INLINE_LAMBDA {
        const Vector3<L> ab = subtract(b, a), ac = subtract(c, a), bc = subtract(c, b);
        return max(max(dot(a, a), dot(b, b), dot(c, c)), max(dot(ab, ab), dot(ac, ac), dot(bc, bc)));
    };
    return {sqrt(max(largest_square(r.start[0], r.start[1], r.start[2]),
                     largest_square(r.end[0], r.end[1], r.end[2]))),
            sqrt(largest_square(subtract(r.end[0], r.start[0]), subtract(r.end[1], r.start[1]),
                                subtract(r.end[2], r.start[2])))};
}

/// For a pair with these bounds of its motion and this rounding of areas (area_rounding).
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> area_certificate(const RelativeMotion<L>& r, const MotionBounds<L>& motion_bound, L rounding, L centre,
                                            L delta)
{
    // The roundings of squares, sums, roots and products below, a dozen u, rounded up; that of the velocities
    // themselves is in bounds.area().
    const L inflate = broadcast<L>(1.0 + 0x1p-30);
    // 2 sum E = 2 * 4 * (delta C1 C2 + delta^2 C2^2 / 2)
    const L motion = delta * motion_bound.speed;
    const L change = broadcast<L>(8.0) * motion * (motion_bound.edge + broadcast<L>(0.5) * motion) * inflate;

    const Vector3<L> r1 = position(r, 0, centre), r2 = position(r, 1, centre), r3 = position(r, 2, centre);
    const Vector3<L> p = cross(r1, r2), q = cross(r2, r3), t = cross(r3, r1);
    const L whole = norm(add(add(q, t), p));
    const L excess = kind == PairKind::vertex_face ? ((norm(p) + norm(q)) + norm(t)) - whole
                                                   : abs(((norm(p) + norm(t)) - norm(q)) - whole);
    return less(change + rounding, excess);
}

template <class L>
FASTCCD_INLINE L area_rounding(const Scales<L>& scale, const ErrorBounds& bounds)
{
    return broadcast<L>(bounds.area()) * ((scale.yz + scale.zx) + scale.xy);
}

template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> area_certificate(const RelativeMotion<L>& r, const Scales<L>& scale, L centre, L delta,
                                            const ErrorBounds& bounds)
{
    return area_certificate<kind>(r, motion_bounds(r), area_rounding(scale, bounds), centre, delta);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
