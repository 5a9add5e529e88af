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

/// Bernstein coefficients of the coplanarity cubic on [a, b], each within cubic_bound.
template <class T, class L>
FASTCCD_INLINE Cubic<L> coplanarity_on(const PairCoefficientsOf<T>& pair, L a, L b)
{
    const auto& c = pair.cubic;
    return on_interval(Cubic<L>{in_lanes<L>(c[0]), in_lanes<L>(c[1]), in_lanes<L>(c[2]), in_lanes<L>(c[3])}, a, b);
}

/// Where a function has one strict sign, beyond its bound, throughout an interval.
template <class L>
struct StrictSign {
    LaneMask<L> positive, negative;
};

template <class EdgeFunction, class L>
FASTCCD_INLINE StrictSign<L> strict_sign(const EdgeFunction& e, L a, L b)
{
    const Quadratic<L> q = on_interval(Quadratic<L>{in_lanes<L>(e.start), in_lanes<L>(e.middle), in_lanes<L>(e.end)}, a, b);
    const L bound = in_lanes<L>(e.bound);
    return {less(bound, smallest(q)), less(largest(q), negated(bound))};
}

/// The cubic certificate on [a, b].
template <class T, class L>
FASTCCD_INLINE LaneMask<L> never_coplanar(const PairCoefficientsOf<T>& pair, L a, L b)
{
    const Cubic<L> f = coplanarity_on(pair, a, b);
    const L bound = in_lanes<L>(pair.cubic_bound);
    return less(bound, smallest(f)) | less(largest(f), negated(bound));
}

/// The quadratic certificate on [a, b] in the projection along one axis: strict signs decide as in apart_in_projection.
template <PairKind kind, class EdgeFunction, class L>
FASTCCD_INLINE LaneMask<L> apart_along(const EdgeFunction* edges, L a, L b)
{
    const StrictSign<L> p = strict_sign(edges[0], a, b), q = strict_sign(edges[1], a, b), t = strict_sign(edges[2], a, b);
    if constexpr (kind == PairKind::vertex_face) {
        return (p.positive | q.positive | t.positive) & (p.negative | q.negative | t.negative);
    } else {
        const StrictSign<L> s = strict_sign(edges[3], a, b);
        return (p.positive & t.positive) | (p.negative & t.negative) | (q.positive & s.positive) | (q.negative & s.negative);
    }
}

/// The linear certificate on [a, b].
template <PairKind kind, class T, class L>
FASTCCD_INLINE LaneMask<L> separated_on(const PairCoefficientsOf<T>& pair, L a, L b)
{
    const auto gap = [&](int axis, L s) FASTCCD_INLINE_LAMBDA {
        const auto at = [&](int i) FASTCCD_INLINE_LAMBDA {
            return lerp(in_lanes<L>(pair.start[i][axis]), in_lanes<L>(pair.end[i][axis]), s);
        };
        return axis_gap<kind, L>({at(0), at(1), at(2)});
    };
    const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
        return separated(gap(axis, a), gap(axis, b), in_lanes<L>(pair.gap_bound[axis]));
    };
    return along(0) | along(1) | along(2);
}

/// True if one of the three proves absence on [a, b]. `met`: bits of lanes that do not matter.
template <PairKind kind, class T, class L>
FASTCCD_INLINE LaneMask<L> apart_on(const PairCoefficientsOf<T>& pair, L a, L b, unsigned met = 0)
{
    constexpr unsigned all = (1u << Lane<L>::width) - 1;
    LaneMask<L> apart = never_coplanar(pair, a, b);
    for (const auto& edges : pair.edges) {
        if ((Lane<L>::bits(apart) | met) == all) return apart;
        apart = apart | apart_along<kind>(edges, a, b);
    }
    return (Lane<L>::bits(apart) | met) == all ? apart : apart | separated_on<kind>(pair, a, b);
}

/// Eq. 7 on [a, b]: its middle, with delta half its width.
template <PairKind kind, class T, class L>
FASTCCD_INLINE LaneMask<L> apart_by_area_on(const PairCoefficientsOf<T>& pair, L a, L b)
{
    const L half = broadcast<L>(0.5) * (b - a);
    return area_certificate<kind>(motion_of<L>(pair), {in_lanes<L>(pair.edge), in_lanes<L>(pair.speed)}, in_lanes<L>(pair.area_rounding), a + half, half);
}

/// The cubic has strict opposite signs at both ends of [a, b].
template <class T, class L>
FASTCCD_INLINE LaneMask<L> changes_sign_on(const PairCoefficientsOf<T>& pair, L a, L b)
{
    const Cubic<L> f = coplanarity_on(pair, a, b);
    const L bound = in_lanes<L>(pair.cubic_bound);
    return (less(bound, f.c0) & less(f.c3, negated(bound))) | (less(f.c0, negated(bound)) & less(bound, f.c3));
}

/// Every coplanar time of [a, b] is a contact: proper inclusion in some projection throughout.
template <PairKind kind, class T, class L>
FASTCCD_INLINE LaneMask<L> included_on(const PairCoefficientsOf<T>& pair, L a, L b)
{
    constexpr unsigned all = (1u << Lane<L>::width) - 1;
    const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
        const auto& edges = pair.edges[axis];
        const StrictSign<L> p = strict_sign(edges[0], a, b), q = strict_sign(edges[1], a, b), t = strict_sign(edges[2], a, b);
        if constexpr (kind == PairKind::vertex_face) {
            return (p.positive & q.positive & t.positive) | (p.negative & q.negative & t.negative);
        } else {
            const StrictSign<L> s = strict_sign(edges[3], a, b);
            return ((p.positive & t.negative) | (p.negative & t.positive)) & ((q.positive & s.negative) | (q.negative & s.positive));
        }
    };
    LaneMask<L> included = along(0);
    for (int axis = 1; axis < 3 && Lane<L>::bits(included) != all; ++axis) included = included | along(axis);
    return included;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
