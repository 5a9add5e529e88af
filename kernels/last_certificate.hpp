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

/// A cubic whose coefficients are this near to a line, in shares of the first one, is not corrected: over a leaf of 2^-30 they are nearer
/// still, and the hull's end is as good. A choice.
inline constexpr double straight = 0x1p-20;

/// A cubic at s, less e.
template <class L>
struct CubicAt {
    L value, slope, half_curvature;
};
template <class L>
FASTCCD_INLINE CubicAt<L> cubic_at(L c0, L c1, L c2, L c3, L s, L e)
{
    const L p = lerp(c0, c1, s), q = lerp(c1, c2, s), r = lerp(c2, c3, s), a = lerp(p, q, s), b = lerp(q, r, s), three = broadcast<L>(3.0);
    return {lerp(a, b, s) - e, three * (b - a), three * ((r - q) - (q - p))};
}

/// Steps that follow a bent cubic beyond its hull: of those that graze zero, each leaves a fraction of the way.
inline constexpr int steps_beyond_hull = 3;

/// Until the hull of its coefficients comes down to e, along a line between two of them, at least: those on an interval up to there stay above.
/// Where they are not in line, on to where the cubic itself comes down: by its quadratic Taylor polynomial, which is close where the cubic only
/// grazes zero and Newton's method would halve the way; if that leads too far, by Newton's where it is convex, along the secant where it is
/// concave: neither passes the zero unless the cubic bends the other way in between. But no farther than the inner coefficients on [0, s] are
/// above e, too: the second one is the line from c0 to c1 at s, the third the quadratic of the first three.
template <class L>
FASTCCD_INLINE L above_until(const Cubic<L>& f, L e)
{
    constexpr double first = 1.0 / 3.0, second = 2.0 / 3.0;
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0), two = broadcast<L>(2.0);
    const L c0 = abs(f.c0), c1 = times_sign(f.c1, f.c0), c2 = times_sign(f.c2, f.c0), c3 = times_sign(f.c3, f.c0);
    const L to_second = down_at(c0, 0.0, c1, first, e);
    const L inner = min(to_second, down_at(c0, 0.0, c2, second, e), down_at(c1, first, c2, second, e));
    const L hull = min(inner, min(down_at(c0, 0.0, c3, 1.0, e), down_at(c1, first, c3, 1.0, e), down_at(c2, second, c3, 1.0, e)));
    L until = select<L>(less(e, c0), hull, zero);
    const L bend = max(abs((c2 - c1) - (c1 - c0)), abs((c3 - c2) - (c2 - c1)));
    LaneMask<L> bent = less(broadcast<L>(straight) * c0, bend) & less(zero, until) & less(until, one);
    if (Lane<L>::bits(bent) == 0) return until;

    const L most = min(min(broadcast<L>(3.0) * to_second, one), above_until(Quadratic<L>{c0, c1, c2}, e));
    for (int k = 0; k < steps_beyond_hull; ++k) {
        const CubicAt<L> here = cubic_at(c0, c1, c2, c3, until, e);
        bent = bent & less(zero, here.value) & less(here.slope, zero) & less(until, most);
        if (Lane<L>::bits(bent) == 0) break;
        const L discriminant = here.slope * here.slope - broadcast<L>(4.0) * here.half_curvature * here.value;
        const L step = (two * here.value) / (sqrt(max(discriminant, zero)) - here.slope);
        const L there = cubic_at(c0, c1, c2, c3, until + step, e).value;
        const L safe = select<L>(less(here.half_curvature, zero), step * (here.value / (here.value - there)), negated(here.value / here.slope));
        until = select<L>(bent, min(until + select<L>(less(zero, there), step, safe), most), until);
    }
    return until;
}

/// The time from a to b that lies at this share of the way, 0 at a.
template <class L>
FASTCCD_INLINE L time_at_share(L share, L a, L b)
{
    return min(max(a + (b - a) * share, a), b);
}

/// The strict sign that Bernstein coefficients begin with.
template <class Polynomial, class L>
FASTCCD_INLINE StrictSign<L> sign_at_start(const Polynomial& f, L bound)
{
    return {less(bound, f.c0), less(f.c0, negated(bound))};
}

/// The end of the last gap along an axis, of those that are open at a, b at most; a if none is. It ends when it is down to `level`.
template <PairKind kind, class L>
FASTCCD_INLINE L last_gap(const PolynomialsOf<L>& pair, L a, L b, CertificateLevel level, LaneMask<L> asked)
{
    L last = a;
    for (int axis = 0; axis < 3; ++axis) {  // as separated_on: all gaps, the first to end
        const auto& gaps = pair.gaps[axis];
        Linear<L> rest[4];
        LaneMask<L> above = asked, below = asked;
        for (int k = 0; k < gap_count(kind); ++k) {
            rest[k] = on_interval(linear_of(gaps[k]), a, b);
            const StrictSign<L> sign = sign_at_start(rest[k], gaps[k].bound);
            above = above & sign.positive;
            below = below & sign.negative;
        }
        const LaneMask<L> open = above | below;
        if (Lane<L>::bits(open) == 0) continue;
        L until = broadcast<L>(1.0);
        for (int k = 0; k < gap_count(kind); ++k)
            until = min(until, above_until(rest[k], level(gaps[k].bound, value_margin(linear_of(gaps[k])))));
        last = max(last, select<L>(open, time_at_share(until, a, b), a));
    }
    return last;
}

/// How long edge functions keep the strict sign that they have at a time; until that time, if they have not that sign.
template <class L>
struct SignEnd {
    L positive, negative;
};

/// The end of the last certificate by edge functions in projections, as last_gap.
template <PairKind kind, class L>
FASTCCD_INLINE L last_in_projections(const PolynomialsOf<L>& pair, L a, L b, CertificateLevel level, LaneMask<L> asked)
{
    L last = a;
    for (const auto& edges : pair.edges) {  // as apart_along
        Quadratic<L> rest[4];
        StrictSign<L> sign[4];
        for (int k = 0; k < edge_function_count(kind); ++k) {
            rest[k] = on_interval(quadratic_of(edges[k]), a, b);
            sign[k] = sign_at_start(rest[k], edges[k].bound);
        }
        const auto until = [&](int k) FASTCCD_INLINE_LAMBDA -> SignEnd<L> {
            const auto& e = edges[k];
            const L end = time_at_share(above_until(rest[k], level(e.bound, value_margin(quadratic_of(e)))), a, b);
            return {select<L>(sign[k].positive, end, a), select<L>(sign[k].negative, end, a)};
        };
        if constexpr (kind == PairKind::vertex_face) {
            if (Lane<L>::bits(asked & not_inside(sign[0], sign[1], sign[2])) == 0) continue;
            const SignEnd<L> p = until(0), q = until(1), t = until(2);
            last = max(last, min(max(p.positive, q.positive, t.positive), max(p.negative, q.negative, t.negative)));
        } else {
            const auto along = [&](int k, int l) FASTCCD_INLINE_LAMBDA {
                if (Lane<L>::bits(asked & on_one_side(sign[k], sign[l])) == 0) return;
                const SignEnd<L> p = until(k), t = until(l);
                last = max(last, max(min(p.positive, t.positive), min(p.negative, t.negative)));
            };
            along(0, 2);
            along(1, 3);
        }
    }
    return last;
}

/// The end of the last certificate of those that hold at a, b at most; a if none does. It ends when what it compares with its bound has come
/// down to `level`. Of lanes that are not `asked`, any time from a to b. A function of its own: much code, seldom run.
template <PairKind kind, class L>
__attribute__((noinline)) L last_certificate(const PolynomialsOf<L>& pair, L a, L b, CertificateLevel level, LaneMask<L> asked)
{
    const Cubic<L> cubic = cubic_of(pair), rest = on_interval(cubic, a, b);
    const StrictSign<L> sign = sign_at_start(rest, pair.cubic_bound);
    const LaneMask<L> volume = sign.positive | sign.negative;
    L last = a;
    if (Lane<L>::bits(asked & volume) != 0)
        last = select<L>(volume, time_at_share(above_until(rest, level(pair.cubic_bound, value_margin(cubic))), a, b), a);
    last = max(last, last_gap<kind>(pair, a, b, level, asked & less(last, b)));
    return max(last, last_in_projections<kind>(pair, a, b, level, asked & less(last, b)));
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
