// How long the certificates that hold at one time go on to hold: where a pair that they keep apart may touch first. Guesses all of them, from
// which nothing follows that is not looked at again.
#pragma once

#include <meeting.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Down to what a certificate is followed: so many of the bounds that it has to exceed, and margins (value_margin) beyond that.
struct CertificateLevel {
    double bounds, margins;

    template <class L>
    [[nodiscard]] FASTCCD_INLINE L operator()(L bound, L margin) const
    {
        return max(broadcast<L>(bounds) * bound + broadcast<L>(margins) * margin, broadcast<L>(0.0));
    }
};
/// About where the pair may meet; and where values are probably beyond their bounds, however they are rounded.
inline constexpr CertificateLevel zero_level{0.0, 0.0}, beyond_rounding{3.0, 0.0};

/// From the coefficient c of abscissa x to the one d of abscissa y a line comes down to e at x + (c - e) (y - x) / (c - d); 1 if it does not.
template <class L>
FASTCCD_INLINE L down_at(L c, double x, L d, double y, L e)
{
    const L at = broadcast<L>(x) + (c - e) * (broadcast<L>(y - x) / (c - d));
    return select<L>(less(d, e) & less(e, c), at, broadcast<L>(1.0));
}

/// How long a function, times the sign of its first coefficient, is above e >= 0 from the start of an interval on, in shares of it; 1 if to its
/// end, 0 if not at all.
template <class L>
FASTCCD_INLINE L above_until(const Linear<L>& f, L e)
{
    const L c0 = abs(f.c0);
    return select<L>(less(e, c0), down_at(c0, 0.0, times_sign(f.c1, f.c0), 1.0, e), broadcast<L>(0.0));
}

/// With c_k the coefficients less e: c0 (1 - s)^2 + 2 c1 s (1 - s) + c2 s^2 = 0 first for s = c0 / (c0 - c1 + root), root =
/// sqrt(c1^2 - c0 c2), or, which does not cancel where it begins to rise, (c1 - c0 + root) / ((c1 - c0) + (c1 - c2)). If it has no zero though
/// c1 < 0, its coefficients up to where the chord to c1 is zero are positive.
template <class L>
FASTCCD_INLINE L above_until(const Quadratic<L>& f, L e)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    const L c0 = abs(f.c0) - e, c1 = times_sign(f.c1, f.c0) - e, c2 = times_sign(f.c2, f.c0) - e;
    const L discriminant = c1 * c1 - c0 * c2, rise = c1 - c0;
    const L root = select<L>(less(discriminant, zero), negated(rise), sqrt(discriminant));
    const LaneMask<L> rises = less(zero, rise);
    const L first = select<L>(rises, rise + root, c0) / select<L>(rises, rise + (c1 - c2), root - rise);
    return select<L>(less(min(c1, c2), zero), select<L>(less(zero, c0), first, zero), one);
}

/// Until the hull of its coefficients comes down to e, along a line between two of them, at least: so do those on an interval up to there.
/// Where they are not in line about, somewhat on: to where Newton's method leads if that is above e, as where it is convex, else along the
/// secant, which is below it where it is concave. The third of the coefficients on [0, s] is the quadratic of the first three at s, whose
/// hull is that of these three, stretched by 3/2; the second one stays above e for longer.
template <class L>
FASTCCD_INLINE L above_until(const Cubic<L>& f, L e)
{
    constexpr double first = 1.0 / 3.0, second = 2.0 / 3.0;
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    const L c0 = abs(f.c0), c1 = times_sign(f.c1, f.c0), c2 = times_sign(f.c2, f.c0), c3 = times_sign(f.c3, f.c0);
    const L inner = min(down_at(c0, 0.0, c1, first, e), down_at(c0, 0.0, c2, second, e), down_at(c1, first, c2, second, e));
    const L hull = min(inner, min(down_at(c0, 0.0, c3, 1.0, e), down_at(c1, first, c3, 1.0, e), down_at(c2, second, c3, 1.0, e)));
    const L until = select<L>(less(e, c0), hull, zero), bend = max(abs((c2 - c1) - (c1 - c0)), abs((c3 - c2) - (c2 - c1)));
    const LaneMask<L> bent = less(broadcast<L>(0x1p-20) * c0, bend) & less(zero, until) & less(until, one);
    if (Lane<L>::bits(bent) == 0) return until;

    struct Value {
        L f, slope;
    };
    const auto at = [&](L s) FASTCCD_INLINE_LAMBDA -> Value {
        const L p = lerp(c0, c1, s), q = lerp(c1, c2, s), r = lerp(c2, c3, s), a = lerp(p, q, s), b = lerp(q, r, s);
        return {lerp(a, b, s) - e, broadcast<L>(3.0) * (b - a)};
    };
    const Value here = at(until);
    const L newton = min(max(until - here.f / here.slope, until), min(broadcast<L>(1.5) * inner, one));
    const L there = at(newton).f, secant = until + (newton - until) * (here.f / (here.f - there));
    const LaneMask<L> comes_down = bent & less(zero, here.f) & less(here.slope, zero);
    return select<L>(comes_down, select<L>(less(there, zero), secant, newton), until);
}

template <class L>
FASTCCD_INLINE L on_whole(L share, L a, L b)
{
    return min(max(a + (b - a) * share, a), b);
}

/// How long a function keeps the strict sign that it has at a time; until that time, if it has not that sign.
template <class L>
struct SignEnd {
    L positive, negative;
};

/// Until its size is down to `level`; of Bernstein coefficients on [a, b].
template <class Polynomial, class L>
FASTCCD_INLINE SignEnd<L> sign_end(const Polynomial& f, L bound, L level, L a, L b)
{
    const L end = on_whole(above_until(f, level), a, b);
    return {select<L>(less(bound, f.c0), end, a), select<L>(less(f.c0, negated(bound)), end, a)};
}

/// The end of the last gap along an axis, of those that are open at a, b at most; a if none is. It ends when it is down to `level`.
template <PairKind kind, class L>
FASTCCD_INLINE L last_gap(const PolynomialsOf<L>& pair, L a, L b, CertificateLevel level)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    L last = a;
    for (int axis = 0; axis < 3; ++axis) {  // as separated_on: all gaps, the first to end
        L until = one;
        LaneMask<L> above = less_equal(zero, zero), below = above;
        for (int k = 0; k < gap_count(kind); ++k) {
            const auto& gap = pair.gaps[axis][k];
            const Linear<L> whole{gap.start, gap.end}, g = on_interval(whole, a, b);
            above = above & less(gap.bound, g.c0);
            below = below & less(g.c0, negated(gap.bound));
            until = min(until, above_until(g, level(gap.bound, value_margin(whole))));
        }
        const LaneMask<L> open = above | below;
        last = max(last, select<L>(open, on_whole(until, a, b), a));
    }
    return last;
}

/// The end of the last certificate of those that hold at a, b at most; a if none does. It ends when what it compares with its bound has come
/// down to `level`. A function of its own: much code, seldom run.
template <PairKind kind, class L>
__attribute__((noinline)) L last_certificate(const PolynomialsOf<L>& pair, L a, L b, CertificateLevel level)
{
    const Cubic<L> cubic{pair.cubic[0], pair.cubic[1], pair.cubic[2], pair.cubic[3]};
    const SignEnd<L> volume = sign_end(on_interval(cubic, a, b), pair.cubic_bound, level(pair.cubic_bound, value_margin(cubic)), a, b);
    L last = max(last_gap<kind>(pair, a, b, level), max(volume.positive, volume.negative));
    for (const auto& edges : pair.edges) {  // as apart_along
        const auto edge_function = [&](int edge) FASTCCD_INLINE_LAMBDA {
            const auto& e = edges[edge];
            const Quadratic<L> whole{e.start, e.middle, e.end};
            return sign_end(on_interval(whole, a, b), e.bound, level(e.bound, value_margin(whole)), a, b);
        };
        const SignEnd<L> p = edge_function(0), q = edge_function(1), t = edge_function(2);
        if constexpr (kind == PairKind::vertex_face) {
            last = max(last, min(max(p.positive, q.positive, t.positive), max(p.negative, q.negative, t.negative)));
        } else {
            const SignEnd<L> s = edge_function(3);
            last = max(last, max(min(p.positive, t.positive), min(p.negative, t.negative)));
            last = max(last, max(min(q.positive, s.positive), min(q.negative, s.negative)));
        }
    }
    return last;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
