// How long the certificates that hold at one time go on to hold: where a pair that they keep apart may touch first. Guesses all of them, from
// which nothing follows that is not looked at again.
#pragma once

#include <meeting.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// When a certificate ends, and a time before that at which it very probably holds, rounding included.
template <class L>
struct CertificateEnd {
    L time, before;
};

template <class L>
FASTCCD_INLINE CertificateEnd<L> earlier(const CertificateEnd<L>& a, const CertificateEnd<L>& b)
{
    return {min(a.time, b.time), min(a.before, b.before)};
}
template <class L>
FASTCCD_INLINE CertificateEnd<L> later(const CertificateEnd<L>& a, const CertificateEnd<L>& b)
{
    return {max(a.time, b.time), max(a.before, b.before)};
}

/// Bernstein coefficients of a linear function.
template <class L>
struct Linear {
    L c0, c1;
};

/// How long a function, positive at the start of an interval, stays so, and beyond its bound, in shares of the interval; 1 if to its end.
template <class L>
struct PositiveUntil {
    L zero, bound;
};

/// A chord of the control polygon, from c0 to the coefficient c of this abscissa, is zero at abscissa c0 / (c0 - c), and three times the
/// bound, which leaves room for rounding, before that by 3 abscissa bound / (c0 - c).
template <class L>
FASTCCD_INLINE PositiveUntil<L> chord_positive_until(L c0, L c, double abscissa, L bound)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0), enough = broadcast<L>(3.0) * bound;
    const L share = broadcast<L>(abscissa) / (c0 - c);
    const L before = select<L>(less(enough, c0), (c0 - enough) * share, zero);
    return {select<L>(less(c, zero), c0 * share, one), select<L>(less(c, enough), before, one)};
}

template <class L>
FASTCCD_INLINE PositiveUntil<L> positive_until(const Linear<L>& f, L sign, L bound)
{
    return chord_positive_until(times_sign(f.c0, sign), times_sign(f.c1, sign), 1.0, bound);
}

/// c0 (1 - s)^2 + 2 c1 s (1 - s) + c2 s^2 = 0 for s = c0 / (c0 - c1 +- sqrt(c1^2 - c0 c2)), where its slope is 2 sqrt(c1^2 - c0 c2): four
/// times the bound, one more for its curvature, is 2 bound / sqrt(..) before. If it has no zero though c1 < 0, its coefficients up to where
/// the chord to c1 is zero are positive.
template <class L>
FASTCCD_INLINE PositiveUntil<L> positive_until(const Quadratic<L>& f, L sign, L bound)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    const L c0 = times_sign(f.c0, sign), c1 = times_sign(f.c1, sign), c2 = times_sign(f.c2, sign);
    const L discriminant = c1 * c1 - c0 * c2, fall = c0 - c1;
    const LaneMask<L> bends = less(discriminant, zero);
    const L root = select<L>(bends, fall, sqrt(discriminant));
    const L until = c0 / (fall + root), hidden = broadcast<L>(2.0) * bound / root, lowest = min(c1, c2);
    return {select<L>(less(lowest, zero), until, one), select<L>(less(lowest, broadcast<L>(3.0) * bound), until - hidden, one)};
}

/// Before any chord.
template <class L>
FASTCCD_INLINE PositiveUntil<L> positive_until(const Cubic<L>& f, L sign, L bound)
{
    const auto chord = [&](L c, double abscissa) FASTCCD_INLINE_LAMBDA {
        return chord_positive_until(times_sign(f.c0, sign), times_sign(c, sign), abscissa, bound);
    };
    const PositiveUntil<L> first = chord(f.c1, 1.0 / 3.0), second = chord(f.c2, 2.0 / 3.0), third = chord(f.c3, 1.0);
    return {min(first.zero, second.zero, third.zero), min(first.bound, second.bound, third.bound)};
}

template <class L>
FASTCCD_INLINE CertificateEnd<L> end_of(const PositiveUntil<L>& until, L a, L b)
{
    const L width = b - a;
    return {a + width * until.zero, min(max(a + width * until.bound, a), b)};
}

/// How long a function keeps the strict sign that it has at a time; until that time, if it has not that sign.
template <class L>
struct SignEnd {
    CertificateEnd<L> positive, negative;
};

/// Of Bernstein coefficients on [a, b].
template <class Polynomial, class L>
FASTCCD_INLINE SignEnd<L> sign_end(const Polynomial& f, L bound, L a, L b)
{
    const CertificateEnd<L> end = end_of(positive_until(f, f.c0, bound), a, b);
    const auto where = [&](LaneMask<L> has_sign) FASTCCD_INLINE_LAMBDA -> CertificateEnd<L> {
        return {select<L>(has_sign, end.time, a), select<L>(has_sign, end.before, a)};
    };
    return {where(less(bound, f.c0)), where(less(f.c0, negated(bound)))};
}

/// The end of the last gap along an axis, of those that are open at a, b at most; a if none is.
template <PairKind kind, class L>
FASTCCD_INLINE CertificateEnd<L> last_gap(const PairCoefficientsOf<L>& pair, L a, L b)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    CertificateEnd<L> last{a, a};
    for (int axis = 0; axis < 3; ++axis) {  // as separated_on: of all vertices of one to all of the other, the first to meet
        const auto motion = [&](int i) FASTCCD_INLINE_LAMBDA -> AxisMotion<L> { return {pair.start[i][axis], pair.end[i][axis]}; };
        const AxisMotion<L> first[] = {{zero, zero}, motion(0)};
        constexpr int vertices_of_first = kind == PairKind::vertex_face ? 1 : 2;
        const L bound = pair.gap_bound[axis];
        Linear<L> gaps[6];
        int count = 0;
        LaneMask<L> above = less_equal(zero, zero), below = above;
        for (int i = 0; i < vertices_of_first; ++i)
            for (int j = vertices_of_first - 1; j < 3; ++j, ++count) {
                const AxisMotion<L> second = motion(j);
                gaps[count] = {second.at(a) - first[i].at(a), second.at(b) - first[i].at(b)};
                above = above & less(bound, gaps[count].c0);
                below = below & less(gaps[count].c0, negated(bound));
            }
        const LaneMask<L> open = above | below;
        if (Lane<L>::bits(open) == 0) continue;
        PositiveUntil<L> until{one, one};
        for (int k = 0; k < count; ++k) {
            const PositiveUntil<L> gap = positive_until(gaps[k], gaps[k].c0, bound);
            until = {min(until.zero, gap.zero), min(until.bound, gap.bound)};
        }
        const CertificateEnd<L> end = end_of(until, a, b);
        last = later(last, CertificateEnd<L>{select<L>(open, end.time, a), select<L>(open, end.before, a)});
    }
    return last;
}

/// The end of the last certificate of those that hold at a, b at most; a if none does. A function of its own: much code, seldom run.
template <PairKind kind, class L>
__attribute__((noinline)) CertificateEnd<L> last_certificate(const PairCoefficientsOf<L>& pair, L a, L b)
{
    const SignEnd<L> volume = sign_end(coplanarity_on(pair, a, b), pair.cubic_bound, a, b);
    CertificateEnd<L> last = later(last_gap<kind>(pair, a, b), later(volume.positive, volume.negative));
    for (const auto& edges : pair.edges) {  // as apart_along
        const auto edge_function = [&](int edge) FASTCCD_INLINE_LAMBDA {
            const auto& e = edges[edge];
            return sign_end(on_interval(Quadratic<L>{e.start, e.middle, e.end}, a, b), e.bound, a, b);
        };
        const SignEnd<L> p = edge_function(0), q = edge_function(1), t = edge_function(2);
        if constexpr (kind == PairKind::vertex_face) {
            last = later(last, earlier(later(p.positive, later(q.positive, t.positive)), later(p.negative, later(q.negative, t.negative))));
        } else {
            const SignEnd<L> s = edge_function(3);
            last = later(last, later(earlier(p.positive, t.positive), earlier(p.negative, t.negative)));
            last = later(last, later(earlier(q.positive, s.positive), earlier(q.negative, s.negative)));
        }
    }
    return last;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
