// The cubic and quadratic certificates on both halves of the interval, by one step of de Casteljau's algorithm.
//
// On a half, coefficients lie closer to the function than on the whole interval, and another projection may decide than on the
// other half: of random pairs without a certificate on the whole, 53 % (vertex-face) and 42 % (edge-edge) have one on either
// half, before any root is sought. They include those on the whole interval, but for their larger margins. The certified
// search examines the same two halves next, so what is concluded here with a margin (ErrorBounds::halves) it concludes too.
#pragma once

#include <certificates.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Bernstein coefficients of a quadratic on both halves, as multiples that need no division.
template <class L>
struct HalvedQuadratic {
    L start, first;  ///< On the first half: the coefficient at 0, and twice the inner one.
    L middle;        ///< 4 times the value at 1/2, which both halves share.
    L second, end;   ///< On the second half: twice the inner one, and the coefficient at 1.
};

template <class L>
FASTCCD_INLINE HalvedQuadratic<L> halved(L start, L twice_middle, L end)
{
    const L inner = broadcast<L>(0.5) * twice_middle;
    const L first = start + inner, second = inner + end;
    return {start, first, first + second, second, end};
}

/// Bernstein coefficients of a cubic on both halves, as multiples too.
template <class L>
struct HalvedCubic {
    L first[4];   ///< 1, 6, 12 and 8 times those on the first half ...
    L second[4];  ///< ... 8, 12, 6 and 1 times those on the second.
};

template <class L>
FASTCCD_INLINE HalvedCubic<L> halved(const CoplanarityCubic<L>& f)
{
    const L three = broadcast<L>(3.0);
    const L a = three * f.start + f.thrice_second, b = f.thrice_second + f.thrice_third, c = f.thrice_third + three * f.end;
    const L middle = (f.start + f.end) + b;
    return {{f.start, a, a + b, middle}, {middle, b + c, c, f.end}};
}

/// Apart on the first half of the interval, and on the second.
template <class L>
struct ApartOnHalves {
    LaneMask<L> first, second;
};

/// On either half in one coordinate projection.
template <PairKind kind, class L>
FASTCCD_INLINE ApartOnHalves<L> apart_on_halves_in_projection(const HalvedQuadratic<L>& p, const HalvedQuadratic<L>& q, const HalvedQuadratic<L>& t,
                                                              const HalvedQuadratic<L>& s, L bound, L bound_sum)
{
    // The value in the middle first: its sign, which both halves share, is the one that others are compared with.
    const auto on_first = [](const HalvedQuadratic<L>& h) FASTCCD_INLINE_LAMBDA -> EdgeCoefficients<L> { return {h.middle, h.first, h.start}; };
    const auto on_second = [](const HalvedQuadratic<L>& h) FASTCCD_INLINE_LAMBDA -> EdgeCoefficients<L> { return {h.middle, h.second, h.end}; };
    return {apart_in_projection<kind, L>(on_first(p), on_first(q), on_first(t), on_first(s), bound, bound_sum),
            apart_in_projection<kind, L>(on_second(p), on_second(q), on_second(t), on_second(s), bound, bound_sum)};
}

/// Bounds of edge functions and of sums of two, in one coordinate projection.
template <class L>
struct ProjectionBounds {
    L single, sum;
};

/// On either half by the cubic, or in at least one coordinate projection. multiple(h): the multiples of a HalvedQuadratic that are compared;
/// bounds(area, a, b): of the projection whose scale is `area` and whose axes are number a and b.
template <PairKind kind, class L, class Multiple, class Bounds>
FASTCCD_INLINE ApartOnHalves<L> apart_on_halves(const HalvedCubic<L>& cubic, L volume_bound, const QuadraticVector<L>& p,
                                                const QuadraticVector<L>& q, const QuadraticVector<L>& t, const QuadraticVector<L>& s,
                                                const Scales<L>& scale, Multiple multiple, Bounds bounds)
{
    const auto never_coplanar = [&](const L(&c)[4]) FASTCCD_INLINE_LAMBDA { return one_sign(volume_bound, c[0], c[1], c[2], c[3]); };
    LaneMask<L> first = never_coplanar(cubic.first), second = never_coplanar(cubic.second);
    const auto along = [&](auto component, const ProjectionBounds<L>& bound) FASTCCD_INLINE_LAMBDA {
        const auto halves_of = [&](const QuadraticVector<L>& v) FASTCCD_INLINE_LAMBDA {
            return multiple(halved(component(v.start), component(v.twice_middle), component(v.end)));
        };
        const ApartOnHalves<L> apart =
            apart_on_halves_in_projection<kind, L>(halves_of(p), halves_of(q), halves_of(t), halves_of(s), bound.single, bound.sum);
        first = first | apart.first;
        second = second | apart.second;
    };
    along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.x; }, bounds(scale.yz, 1, 2));
    along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.y; }, bounds(scale.zx, 2, 0));
    along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.z; }, bounds(scale.xy, 0, 1));
    return {first, second};
}

/// On either half by the cubic certificate, or by the quadratic one in at least one coordinate projection. `bounds` are ErrorBounds::halves().
template <PairKind kind, class L>
FASTCCD_INLINE ApartOnHalves<L> halves_certificate(const CoplanarityCubic<L>& f, const QuadraticVector<L>& p,
                                                   const QuadraticVector<L>& q, const QuadraticVector<L>& t,
                                                   const QuadraticVector<L>& s, const Scales<L>& scale,
                                                   const CertificateBounds& bounds)
{
    return apart_on_halves<kind>(
        halved(f), broadcast<L>(bounds.cubic) * scale.volume, p, q, t, s, scale,
        [](const HalvedQuadratic<L>& h) FASTCCD_INLINE_LAMBDA { return h; },
        [&](L area, int, int) FASTCCD_INLINE_LAMBDA -> ProjectionBounds<L> {
            return {broadcast<L>(bounds.quadratic) * area, broadcast<L>(bounds.quadratic_sum) * area};
        });
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
