// Cross products and the coplanarity cubic in Bernstein form (paper, eq. 5, 8, 10 and 12).
//
// With a(s) = (1-s) a0 + s a1 and b(s) likewise, a(s) x b(s) has the Bernstein coefficients
//     q0 = a0 x b0,   2 q1 = a0 x b1 + a1 x b0,   q2 = a1 x b1,
// and f(s) = det(r1, r2, r3) = (r1 x r2) . r3 has
//     f0 = q0 . c0,   3 f1 = 2 q1 . c0 + q0 . c1,   3 f2 = q2 . c0 + 2 q1 . c1,   f3 = q2 . c1.
// No velocities are formed, so large common motion does not cancel, and the hull property of the
// coefficients gives certificates for free.
#pragma once

#include <relative_motion.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Bernstein coefficients of a vector-valued quadratic; the middle one doubled.
template <class L>
struct QuadraticVector {
    Vector3<L> start, twice_middle, end;
};

/// Bernstein coefficients f0, 3 f1, 3 f2, f3 of the coplanarity cubic.
template <class L>
struct CoplanarityCubic {
    L start, thrice_second, thrice_third, end;
};

template <class L>
FASTCCD_INLINE Vector3<L> cross(const Vector3<L>& a, const Vector3<L>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class L>
FASTCCD_INLINE L dot(const Vector3<L>& a, const Vector3<L>& b)
{
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <class L>
FASTCCD_INLINE Vector3<L> add(const Vector3<L>& a, const Vector3<L>& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class L>
FASTCCD_INLINE Vector3<L> subtract(const Vector3<L>& a, const Vector3<L>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// r_i x r_j over the whole interval.
template <class L>
FASTCCD_INLINE QuadraticVector<L> cross_product(const RelativeMotion<L>& r, int i, int j)
{
    return {cross(r.start[i], r.start[j]), add(cross(r.start[i], r.end[j]), cross(r.end[i], r.start[j])),
            cross(r.end[i], r.end[j])};
}

/// (q - t) + p, coefficient by coefficient.
template <class L>
FASTCCD_INLINE QuadraticVector<L> subtract_then_add(const QuadraticVector<L>& q, const QuadraticVector<L>& t,
                                                    const QuadraticVector<L>& p)
{
    return {add(subtract(q.start, t.start), p.start), add(subtract(q.twice_middle, t.twice_middle), p.twice_middle),
            add(subtract(q.end, t.end), p.end)};
}

/// f = q . r3 with q = r1 x r2.
template <class L>
FASTCCD_INLINE CoplanarityCubic<L> coplanarity_cubic(const RelativeMotion<L>& r, const QuadraticVector<L>& q)
{
    const Vector3<L>& c0 = r.start[2];
    const Vector3<L>& c1 = r.end[2];
    return {dot(q.start, c0), dot(q.twice_middle, c0) + dot(q.start, c1), dot(q.end, c0) + dot(q.twice_middle, c1),
            dot(q.end, c1)};
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
