// The certificates of absence on parts of the interval, as the certified search asks for them.
//
// Coefficients come from blossoms (bernstein.hpp), and bounds from the magnitudes of the pair's own products, so they are
// tighter than those of certificates.hpp. Lanes are intervals of one pair.
#pragma once

#include <area_inclusion.hpp>
#include <bernstein.hpp>
#include <pair_coefficients.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Bernstein coefficients of the coplanarity cubic on [a, b], each within cubic_bound.
template <class L>
FASTCCD_INLINE Cubic<L> coplanarity_on(const PairCoefficients& pair, L a, L b)
{
    const auto& c = pair.cubic;
    return on_interval(Cubic<L>{broadcast<L>(c[0]), broadcast<L>(c[1]), broadcast<L>(c[2]), broadcast<L>(c[3])}, a, b);
}

/// Where a function has one strict sign, beyond its bound, throughout an interval.
template <class L>
struct StrictSign {
    LaneMask<L> positive, negative;
};

template <class L>
FASTCCD_INLINE StrictSign<L> strict_sign(const PairCoefficients::EdgeFunction& e, L a, L b)
{
    const Quadratic<L> q = on_interval(Quadratic<L>{broadcast<L>(e.start), broadcast<L>(e.middle), broadcast<L>(e.end)}, a, b);
    return {less(broadcast<L>(e.bound), smallest(q)), less(largest(q), broadcast<L>(-e.bound))};
}

/// The cubic certificate on [a, b].
template <class L>
FASTCCD_INLINE LaneMask<L> never_coplanar(const PairCoefficients& pair, L a, L b)
{
    const Cubic<L> f = coplanarity_on(pair, a, b);
    return less(broadcast<L>(pair.cubic_bound), smallest(f)) | less(largest(f), broadcast<L>(-pair.cubic_bound));
}

/// The quadratic certificate on [a, b] in the projection along one axis: strict signs decide as in apart_in_projection.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> apart_along(const PairCoefficients::EdgeFunction* edges, L a, L b)
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
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> separated_on(const PairCoefficients& pair, L a, L b)
{
    const auto gap = [&](int axis, L s) FASTCCD_INLINE_LAMBDA {
        const auto at = [&](int i) FASTCCD_INLINE_LAMBDA {
            return lerp(broadcast<L>(pair.start[i][axis]), broadcast<L>(pair.end[i][axis]), s);
        };
        return axis_gap<kind, L>({at(0), at(1), at(2)});
    };
    const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
        return separated(gap(axis, a), gap(axis, b), broadcast<L>(pair.gap_bound[axis]));
    };
    return along(0) | along(1) | along(2);
}

/// True if one of the three proves absence on [a, b]. `met`: bits of lanes that do not matter.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> apart_on(const PairCoefficients& pair, L a, L b, unsigned met = 0)
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
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> apart_by_area_on(const PairCoefficients& pair, L a, L b)
{
    const auto vector = [](const double* v) FASTCCD_INLINE_LAMBDA -> Vector3<L> {
        return {broadcast<L>(v[0]), broadcast<L>(v[1]), broadcast<L>(v[2])};
    };
    const RelativeMotion<L> r{{vector(pair.start[0]), vector(pair.start[1]), vector(pair.start[2])},
                              {vector(pair.end[0]), vector(pair.end[1]), vector(pair.end[2])}};
    const L half = broadcast<L>(0.5) * (b - a);
    return area_certificate<kind>(r, {broadcast<L>(pair.edge), broadcast<L>(pair.speed)}, broadcast<L>(pair.area_rounding),
                                  a + half, half);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
