// Bernstein coefficients on part of the interval, by blossoming.
//
// The blossom (polar form) of a polynomial p of degree n is the symmetric multi-affine F with
// F(s, ..., s) = p(s). Its coefficients on [a, b] are F(a, .., a, b, .., b), each n nested lerps from
// the coefficients on [0, 1]. Every interval is computed from the whole one, so errors do not add up
// as an interval is cut again and again (Ramshaw, "Blossoms are polar forms", 1989).
#pragma once

#include <coplanarity.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Bernstein coefficients of a linear function.
template <class L>
struct Linear {
    L c0, c1;
};

/// Bernstein coefficients of a quadratic.
template <class L>
struct Quadratic {
    L c0, c1, c2;
};

/// Bernstein coefficients of a cubic.
template <class L>
struct Cubic {
    L c0, c1, c2, c3;
};

template <class L>
FASTCCD_INLINE Cubic<L> bernstein(const CoplanarityCubic<L>& f)
{
    const L third = broadcast<L>(1.0 / 3.0);
    return {f.start, f.thrice_second * third, f.thrice_third * third, f.end};
}

/// Coefficients on [a, b], 0 <= a <= b <= 1.
template <class L>
FASTCCD_INLINE Cubic<L> on_interval(const Cubic<L>& f, L a, L b)
{
    const L a0 = lerp(f.c0, f.c1, a), a1 = lerp(f.c1, f.c2, a), a2 = lerp(f.c2, f.c3, a);
    const L b0 = lerp(f.c0, f.c1, b), b1 = lerp(f.c1, f.c2, b), b2 = lerp(f.c2, f.c3, b);
    const L aa0 = lerp(a0, a1, a), aa1 = lerp(a1, a2, a);
    const L ab0 = lerp(a0, a1, b), ab1 = lerp(a1, a2, b);
    const L bb0 = lerp(b0, b1, b), bb1 = lerp(b1, b2, b);
    return {lerp(aa0, aa1, a), lerp(aa0, aa1, b), lerp(ab0, ab1, b), lerp(bb0, bb1, b)};
}

template <class L>
FASTCCD_INLINE Quadratic<L> on_interval(const Quadratic<L>& q, L a, L b)
{
    const L a0 = lerp(q.c0, q.c1, a), a1 = lerp(q.c1, q.c2, a);
    const L b0 = lerp(q.c0, q.c1, b), b1 = lerp(q.c1, q.c2, b);
    return {lerp(a0, a1, a), lerp(a0, a1, b), lerp(b0, b1, b)};
}

template <class L>
FASTCCD_INLINE Linear<L> on_interval(const Linear<L>& f, L a, L b)
{
    return {lerp(f.c0, f.c1, a), lerp(f.c0, f.c1, b)};
}

template <class L>
FASTCCD_INLINE L smallest(const Cubic<L>& f)
{
    return min(min(f.c0, f.c1), min(f.c2, f.c3));
}
template <class L>
FASTCCD_INLINE L largest(const Cubic<L>& f)
{
    return max(max(f.c0, f.c1), max(f.c2, f.c3));
}
template <class L>
FASTCCD_INLINE L smallest(const Quadratic<L>& q)
{
    return min(q.c0, q.c1, q.c2);
}
template <class L>
FASTCCD_INLINE L largest(const Quadratic<L>& q)
{
    return max(q.c0, q.c1, q.c2);
}

template <class L>
FASTCCD_INLINE L largest_magnitude(const Cubic<L>& f)
{
    return max(max(abs(f.c0), abs(f.c1)), max(abs(f.c2), abs(f.c3)));
}
template <class L>
FASTCCD_INLINE L largest_magnitude(const Quadratic<L>& q)
{
    return max(abs(q.c0), abs(q.c1), abs(q.c2));
}
template <class L>
FASTCCD_INLINE L largest_magnitude(const Linear<L>& f)
{
    return max(abs(f.c0), abs(f.c1));
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
