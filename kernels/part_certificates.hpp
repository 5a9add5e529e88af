// Certificates on a part [a, b] of the interval, from the motion over that part.
//
// The ends of that motion may be interpolated: `bounds` are ErrorBounds::on_part(), and scale and extents are those of the whole
// motion, to which the bounds of the certified search refer. It finds each interval inside the part apart, too.
#pragma once

#include <certificates.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Cubic, or quadratic in at least one coordinate projection.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> part_certificate(const RelativeMotion<L>& r, const Scales<L>& scale, const CertificateBounds& bounds)
{
    const CoplanarityCubic<L> cubic = coplanarity_cubic(r, cross_product(r, 0, 1));
    const auto apart_in_projections = visit_edge_functions<kind>(
        r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
            return quadratic_certificate<kind>(p, q, t, s, scale, bounds);
        });
    return cubic_certificate(cubic, scale.volume, bounds) | apart_in_projections;
}

/// Linear: separated along an axis. A gap is the least of several linear functions of time, so it is nowhere less than at an end.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> separated_on_part(const RelativeMotion<L>& r, const Extents<L>& extents, const CertificateBounds& bounds)
{
    const auto along = [&](auto component, L extent) FASTCCD_INLINE_LAMBDA {
        const AxisGap<L> start = axis_gap<kind, L>({component(r.start[0]), component(r.start[1]), component(r.start[2])});
        const AxisGap<L> end = axis_gap<kind, L>({component(r.end[0]), component(r.end[1]), component(r.end[2])});
        return separated(start, end, gap_bound(bounds, extent));
    };
    return along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.x; }, extents.x) |
           along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.y; }, extents.y) |
           along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.z; }, extents.z);
}

/// Those of `lanes` that are apart, by any of the three on each quarter of [low, high]: of the whole interval or one of its halves.
template <PairKind kind, class L>
FASTCCD_INLINE unsigned apart_on_quarters(const RelativeMotion<L>& r, const Scales<L>& scale, const CertificateBounds& bounds, L low, L high,
                                          unsigned lanes)
{
    const Extents<L> whole = extents(r);
    RelativeMotion<L> quarter{{}, {position(r, 0, broadcast<L>(0.0)), position(r, 1, broadcast<L>(0.0)), position(r, 2, broadcast<L>(0.0))}};
    for (int k = 0; k < 4 && lanes != 0; ++k) {
        const L start = broadcast<L>(0.25 * k), end = broadcast<L>(0.25 * (k + 1));
        for (int i = 0; i < 3; ++i) {
            quarter.start[i] = quarter.end[i];
            quarter.end[i] = position(r, i, end);
        }
        const LaneMask<L> outside = less_equal(end, low) | less_equal(high, start);
        lanes &= Lane<L>::bits(outside | part_certificate<kind>(quarter, scale, bounds) | separated_on_part<kind>(quarter, whole, bounds));
    }
    return lanes;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
