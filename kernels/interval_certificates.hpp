// The certificates of absence on parts of the interval, as the certified search asks for them.
//
// Coefficients come from blossoms (bernstein.hpp), and bounds from the magnitudes of the pair's own products, so they are
// tighter than those of certificates.hpp. Lanes are intervals of one pair (T is double), or one interval each of several pairs (T is L).
#pragma once

#include <type_traits>

#include <area_inclusion.hpp>
#include <bernstein.hpp>
#include <pair_coefficients.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// What belongs to a pair, in the lanes of its intervals.
template <class L, class T>
FASTCCD_INLINE L in_lanes(const T& of_pair)
{
    if constexpr (std::is_same_v<L, T>)
        return of_pair;
    else
        return broadcast<L>(of_pair);
}

template <class L, class T>
FASTCCD_INLINE RelativeMotion<L> motion_of(const PairCoefficientsOf<T>& pair)
{
    const auto vector = [](const T* v) FASTCCD_INLINE_LAMBDA -> Vector3<L> {
        return {in_lanes<L>(v[0]), in_lanes<L>(v[1]), in_lanes<L>(v[2])};
    };
    return {{vector(pair.start[0]), vector(pair.start[1]), vector(pair.start[2])},
            {vector(pair.end[0]), vector(pair.end[1]), vector(pair.end[2])}};
}

/// s of [0, 1] over the interval of the pair's coefficients as a time of the step, rounded to one.
template <class T, class L>
FASTCCD_INLINE L time_in_step(const PolynomialsOf<T>& pair, L s)
{
    return in_lanes<L>(pair.origin) + in_lanes<L>(pair.duration) * s;
}

/// A part [a, b] of the interval of the pair's coefficients; or all of it.
template <class L>
struct Between {
    L a, b;
};
template <class L>
struct Throughout {
};

template <class Polynomial, class L>
FASTCCD_INLINE Polynomial on_part(const Polynomial& f, const Between<L>& part)
{
    return on_interval(f, part.a, part.b);
}
template <class Polynomial, class L>
FASTCCD_INLINE Polynomial on_part(const Polynomial& f, const Throughout<L>&)
{
    return f;
}

// Polynomials of a pair whose coefficients are in lanes already.

template <class L>
FASTCCD_INLINE Cubic<L> cubic_of(const PolynomialsOf<L>& pair)
{
    return {pair.cubic[0], pair.cubic[1], pair.cubic[2], pair.cubic[3]};
}
template <class EdgeFunction>
FASTCCD_INLINE auto quadratic_of(const EdgeFunction& e)
{
    return Quadratic<decltype(EdgeFunction::start)>{e.start, e.middle, e.end};
}
template <class Gap>
FASTCCD_INLINE auto linear_of(const Gap& gap)
{
    return Linear<decltype(Gap::start)>{gap.start, gap.end};
}

/// Bernstein coefficients of the coplanarity cubic on a part, each within cubic_bound.
template <class T, template <class> class Part, class L>
FASTCCD_INLINE Cubic<L> coplanarity_on(const PolynomialsOf<T>& pair, const Part<L>& part)
{
    const auto& c = pair.cubic;
    return on_part(Cubic<L>{in_lanes<L>(c[0]), in_lanes<L>(c[1]), in_lanes<L>(c[2]), in_lanes<L>(c[3])}, part);
}
template <class T, class L>
FASTCCD_INLINE Cubic<L> coplanarity_on(const PolynomialsOf<T>& pair, L a, L b)
{
    return coplanarity_on(pair, Between<L>{a, b});
}

/// Where a function has one strict sign, beyond its bound, throughout a part.
template <class L>
struct StrictSign {
    LaneMask<L> positive, negative;
};

/// Of the three edge functions of a face: signs that they cannot all share, so the vertex is not inside of the face in this projection.
template <class L>
FASTCCD_INLINE LaneMask<L> not_inside(const StrictSign<L>& p, const StrictSign<L>& q, const StrictSign<L>& t)
{
    return (p.positive | q.positive | t.positive) & (p.negative | q.negative | t.negative);
}

/// Of both ends of an edge, seen from the other edge: in this projection they are on one side of its line.
template <class L>
FASTCCD_INLINE LaneMask<L> on_one_side(const StrictSign<L>& p, const StrictSign<L>& t)
{
    return (p.positive & t.positive) | (p.negative & t.negative);
}

template <class EdgeFunction, template <class> class Part, class L>
FASTCCD_INLINE StrictSign<L> strict_sign(const EdgeFunction& e, const Part<L>& part)
{
    const Quadratic<L> q = on_part(Quadratic<L>{in_lanes<L>(e.start), in_lanes<L>(e.middle), in_lanes<L>(e.end)}, part);
    const L bound = in_lanes<L>(e.bound);
    return {less(bound, smallest(q)), less(largest(q), negated(bound))};
}

/// The cubic certificate.
template <class T, template <class> class Part, class L>
FASTCCD_INLINE LaneMask<L> never_coplanar(const PolynomialsOf<T>& pair, const Part<L>& part)
{
    const Cubic<L> f = coplanarity_on(pair, part);
    const L bound = in_lanes<L>(pair.cubic_bound);
    return less(bound, smallest(f)) | less(largest(f), negated(bound));
}

/// The quadratic certificate in the projection along one axis: strict signs decide as in apart_in_projection.
template <PairKind kind, class EdgeFunction, template <class> class Part, class L>
FASTCCD_INLINE LaneMask<L> apart_along(const EdgeFunction* edges, const Part<L>& part)
{
    const StrictSign<L> p = strict_sign(edges[0], part), q = strict_sign(edges[1], part), t = strict_sign(edges[2], part);
    if constexpr (kind == PairKind::vertex_face)
        return not_inside(p, q, t);
    else
        return on_one_side(p, t) | on_one_side(q, strict_sign(edges[3], part));
}

/// The linear certificate: a gap is nowhere less than at an end.
template <PairKind kind, class T, template <class> class Part, class L>
FASTCCD_INLINE LaneMask<L> separated_on(const PolynomialsOf<T>& pair, const Part<L>& part)
{
    const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
        const auto sign = [&](int k) FASTCCD_INLINE_LAMBDA -> StrictSign<L> {
            const auto& gap = pair.gaps[axis][k];
            const Linear<L> g = on_part(Linear<L>{in_lanes<L>(gap.start), in_lanes<L>(gap.end)}, part);
            const L bound = in_lanes<L>(gap.bound);
            return {less(bound, min(g.c0, g.c1)), less(max(g.c0, g.c1), negated(bound))};
        };
        StrictSign<L> all = sign(0);
        for (int k = 1; k < gap_count(kind); ++k) {
            const StrictSign<L> s = sign(k);
            all = {all.positive & s.positive, all.negative & s.negative};
        }
        return all.positive | all.negative;
    };
    return along(0) | along(1) | along(2);
}

/// True if one of the three proves absence on a part. `met`: bits of lanes that do not matter.
template <PairKind kind, class T, template <class> class Part, class L>
FASTCCD_INLINE LaneMask<L> apart_on(const PolynomialsOf<T>& pair, const Part<L>& part, unsigned met = 0)
{
    constexpr unsigned all = (1u << Lane<L>::width) - 1;
    LaneMask<L> apart = never_coplanar(pair, part);
    for (const auto& edges : pair.edges) {
        if ((Lane<L>::bits(apart) | met) == all) return apart;
        apart = apart | apart_along<kind>(edges, part);
    }
    return (Lane<L>::bits(apart) | met) == all ? apart : apart | separated_on<kind>(pair, part);
}
template <PairKind kind, class T, class L>
FASTCCD_INLINE LaneMask<L> apart_on(const PolynomialsOf<T>& pair, L a, L b, unsigned met = 0)
{
    return apart_on<kind>(pair, Between<L>{a, b}, met);
}

/// Eq. 7 on [a, b]: its middle, with delta half its width.
template <PairKind kind, class T, class L>
FASTCCD_INLINE LaneMask<L> apart_by_area_on(const PairCoefficientsOf<T>& pair, L a, L b)
{
    const L half = broadcast<L>(0.5) * (b - a);
    return area_certificate<kind>(motion_of<L>(pair), {in_lanes<L>(pair.edge), in_lanes<L>(pair.speed)}, in_lanes<L>(pair.area_rounding),
                                  time_in_step(pair, a + half), in_lanes<L>(pair.duration) * half);
}

/// The cubic has strict opposite signs at both ends of a part.
template <class T, template <class> class Part, class L>
FASTCCD_INLINE LaneMask<L> changes_sign_on(const PolynomialsOf<T>& pair, const Part<L>& part)
{
    const Cubic<L> f = coplanarity_on(pair, part);
    const L bound = in_lanes<L>(pair.cubic_bound);
    return (less(bound, f.c0) & less(f.c3, negated(bound))) | (less(f.c0, negated(bound)) & less(bound, f.c3));
}

/// Every coplanar time of a part is a contact: proper inclusion in some projection throughout.
template <PairKind kind, class T, template <class> class Part, class L>
FASTCCD_INLINE LaneMask<L> included_on(const PolynomialsOf<T>& pair, const Part<L>& part)
{
    constexpr unsigned all = (1u << Lane<L>::width) - 1;
    const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
        const auto& edges = pair.edges[axis];
        const StrictSign<L> p = strict_sign(edges[0], part), q = strict_sign(edges[1], part), t = strict_sign(edges[2], part);
        if constexpr (kind == PairKind::vertex_face) {
            return (p.positive & q.positive & t.positive) | (p.negative & q.negative & t.negative);
        } else {
            const StrictSign<L> s = strict_sign(edges[3], part);
            return ((p.positive & t.negative) | (p.negative & t.positive)) & ((q.positive & s.negative) | (q.negative & s.positive));
        }
    };
    LaneMask<L> included = along(0);
    for (int axis = 1; axis < 3 && Lane<L>::bits(included) != all; ++axis) included = included | along(axis);
    return included;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
