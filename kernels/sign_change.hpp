// Sign-change intervals of the coplanarity cubic (paper, section 6).
//
// The roots of f' cut [0, 1], or a part of it, into at most three monotone pieces; a piece holds a root of f if and only
// if the signs at its ends differ. With rounding: error_bound.hpp (monotone_piece) shows that end values
// beyond +-threshold on one side prove that there is no root in the piece. Where a value is within the
// threshold, parts of the interval are asked about next (simd/root_stages.hpp), and then the certified search or its own text in lanes.
#pragma once

#include <bernstein.hpp>
#include <error_bound.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// f in the power basis: ((c3 s + c2) s + c1) s + c0.
template <class L>
struct PowerCubic {
    L c0, c1, c2, c3;
};

template <class L>
FASTCCD_INLINE L evaluate(const PowerCubic<L>& f, L s)
{
    return ((f.c3 * s + f.c2) * s + f.c1) * s + f.c0;
}

template <class L>
struct MonotonePieces {
    PowerCubic<L> f;
    L time[4];           ///< low, the extrema of f inside (low, high) in order (or low or high), high.
    L value[4];          ///< f there.
    L threshold;         ///< See sign_threshold.
    LaneMask<L> certain; ///< All four values are beyond the threshold.
};

/// A value of f certainly has its sign, with margin, if it is beyond this.
/// threshold = monotone_piece() B + hull_deviation w^2 B + (bounds of the certified search) V: with two end
/// values beyond it, f is far enough from zero in the whole piece that every interval of width
/// w = leaf_width, inside the piece or across its ends, passes the search's cubic certificate.
template <class L>
FASTCCD_INLINE L sign_threshold(const Cubic<L>& f, L volume, const ErrorBounds& bounds, double leaf_width)
{
    const L B = max(largest(f), broadcast<L>(0.0) - smallest(f));
    const double per_B = ErrorBounds::monotone_piece() + ErrorBounds::hull_deviation * leaf_width * leaf_width;
    const double per_V = bounds.cubic_on_interval_lanes();
    return broadcast<L>(per_B) * B + broadcast<L>(per_V) * volume;
}

/// f' / 3 = d0 + 2 h s + A s^2 from the Bernstein coefficients of f.
template <class L>
struct ThirdOfSlope {
    L d0, h, A;
};

template <class L>
FASTCCD_INLINE ThirdOfSlope<L> third_of_slope(const Cubic<L>& f)
{
    const L d0 = f.c1 - f.c0, d1 = f.c2 - f.c1, d2 = f.c3 - f.c2;
    return {d0, d1 - d0, (d0 + d2) - (d1 + d1)};
}

template <class L>
FASTCCD_INLINE PowerCubic<L> power_basis(const Cubic<L>& f)
{
    const L three = broadcast<L>(3.0);
    const ThirdOfSlope<L> g = third_of_slope(f);
    return {f.c0, three * g.d0, three * g.h, g.A};
}

/// Where f has its extrema within [0, 1], in order; ends of it in place of those that are not there.
template <class L>
struct Extrema {
    L first, second;
};

template <class L>
FASTCCD_INLINE Extrema<L> extrema(const Cubic<L>& f)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    // Stable roots of d0 + 2 h s + A s^2: q = -(h + sign(h) sqrt D), x1 = q / A, x2 = d0 / q.
    const auto [d0, h, A] = third_of_slope(f);
    const L D = h * h - A * d0;
    const L root = sqrt(max(D, zero));
    const L q = select<L>(less(h, zero), root - h, zero - (root + h));
    // MINPD's rule turns 0 / 0 into the second operand, and infinities are clipped: such a root does
    // not exist, and a cut anywhere is harmless.
    const L x1 = max(min(q / A, one), zero);
    const L x2 = max(min(d0 / q, one), zero);
    const LaneMask<L> none = less(D, zero);  // monotone throughout: both cuts at 0
    return {select<L>(none, zero, min(x1, x2)), select<L>(none, zero, max(x1, x2))};
}

/// Of [low, high], a part of [0, 1].
template <class L>
FASTCCD_INLINE MonotonePieces<L> monotone_pieces(const PowerCubic<L>& f, const Extrema<L>& cuts, L threshold, L low, L high)
{
    MonotonePieces<L> pieces;
    pieces.f = f;
    pieces.time[0] = low;
    pieces.time[1] = max(min(cuts.first, high), low);
    pieces.time[2] = max(min(cuts.second, high), low);
    pieces.time[3] = high;
    for (int i = 0; i < 4; ++i) pieces.value[i] = evaluate(f, pieces.time[i]);
    pieces.threshold = threshold;
    const L closest = min(min(abs(pieces.value[0]), abs(pieces.value[1])),
                          min(abs(pieces.value[2]), abs(pieces.value[3])));
    pieces.certain = less(threshold, closest);
    return pieces;
}

template <class L>
FASTCCD_INLINE MonotonePieces<L> monotone_pieces(const Cubic<L>& f, L volume, const ErrorBounds& bounds, double leaf_width, L low, L high)
{
    return monotone_pieces(power_basis(f), extrema(f), sign_threshold(f, volume, bounds, leaf_width), low, high);
}

/// True where the signs of a and b differ (neither is zero).
template <class L>
FASTCCD_INLINE LaneMask<L> opposite_signs(L a, L b)
{
    const L zero = broadcast<L>(0.0);
    return (less(a, zero) & less(zero, b)) | (less(zero, a) & less(b, zero));
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
