// The polynomials of a pair over the whole step and their bounds, as the certified search computes them: for one pair, or for as many as
// there are lanes (touching.hpp).
#pragma once

#include <area_inclusion.hpp>
#include <bernstein.hpp>
#include <magnitudes.hpp>
#include <pair_coefficients.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// An edge function along all three axes, with cross_product_magnitude() of the same vectors.
template <class L>
FASTCCD_INLINE void set_edge(PairCoefficientsOf<L>& pair, int edge, const QuadraticVector<L>& v, const QuadraticVector<L>& m,
                             const Scales<L>& scale, const ErrorBounds& bounds)
{
    const auto along = [&](int axis, auto component, L area) FASTCCD_INLINE_LAMBDA {
        pair.edges[axis][edge] = {component(v.start), broadcast<L>(0.5) * component(v.twice_middle), component(v.end),
                                  quadratic_bound(component(m.start), component(m.twice_middle), component(m.end),
                                                  broadcast<L>(bounds.quadratic_on_interval()) * area, bounds)};
    };
    along(0, [](const Vector3<L>& w) FASTCCD_INLINE_LAMBDA { return w.x; }, scale.yz);
    along(1, [](const Vector3<L>& w) FASTCCD_INLINE_LAMBDA { return w.y; }, scale.zx);
    along(2, [](const Vector3<L>& w) FASTCCD_INLINE_LAMBDA { return w.z; }, scale.xy);
}

/// From the motion that is set.
template <PairKind kind, class L>
FASTCCD_INLINE void set_gaps(PairCoefficientsOf<L>& pair, int axis, L bound)
{
    auto& gaps = pair.gaps[axis];
    const auto set = [&](int k, int i) FASTCCD_INLINE_LAMBDA { gaps[k] = {pair.start[i][axis], pair.end[i][axis], bound}; };
    if constexpr (kind == PairKind::vertex_face) {
        for (int k = 0; k < 3; ++k) set(k, k);
        gaps[3] = {broadcast<L>(0.0), broadcast<L>(0.0), broadcast<L>(0.0)};  // there is none
    } else {
        for (int k = 0; k < 2; ++k) {
            set(k, k + 1);
            gaps[k + 2] = {gaps[k].start - pair.start[0][axis], gaps[k].end - pair.end[0][axis], bound};
        }
    }
}

/// Of the motion `r`; `from_x1`, the motion relative to x1 with x0 in its place, is needed for two edges alone. Returns where the
/// certificates on [0, 1], by the bounds of screening, prove the pair apart.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> find_coefficients(const RelativeMotion<L>& r, const RelativeMotion<L>& from_x1, const ErrorBounds& bounds,
                                             PairCoefficientsOf<L>& pair)
{
    const CertificateBounds whole = bounds.certificates();
    Extents<L> extents;
    const LaneMask<L> separated = linear_certificate<kind>(r, whole, extents);
    const Scales<L> scale = scales(extents);
    const CoplanarityCubic<L> f = coplanarity_cubic(r, cross_product(r, 0, 1));
    const LaneMask<L> apart = visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) FASTCCD_INLINE_LAMBDA {
        set_edge(pair, 0, p, cross_product_magnitude(r, 0, 1), scale, bounds);
        set_edge(pair, 1, q, cross_product_magnitude(r, 1, 2), scale, bounds);
        set_edge(pair, 2, t, cross_product_magnitude(r, 2, 0), scale, bounds);
        return separated | cubic_certificate(f, scale.volume, whole) | quadratic_certificate<kind>(p, q, t, s, scale, whole);
    });
    if constexpr (kind == PairKind::edge_edge) {
        // s = (r3 - r2) x (r1 - r2) is (x2 - x1) x (x3 - x1): from differences to x1 it has a third of the
        // rounding of the sum that is compared with its bound above.
        const Scales<L> from_extents = scales(FASTCCD_KERNEL_NAMESPACE::extents(from_x1));
        set_edge(pair, 3, cross_product(from_x1, 1, 2), cross_product_magnitude(from_x1, 1, 2), from_extents, bounds);
    } else {
        const L zero = broadcast<L>(0.0);
        for (auto& edges : pair.edges) edges[3] = {zero, zero, zero, zero};  // a vertex and a face have none
    }

    const auto set_vector = [](L (&to)[3], const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { to[0] = v.x, to[1] = v.y, to[2] = v.z; };
    pair.kind = kind;
    for (int i = 0; i < 3; ++i) {
        set_vector(pair.start[i], r.start[i]);
        set_vector(pair.end[i], r.end[i]);
    }
    const L per_extent = broadcast<L>(bounds.linear_on_interval());
    set_gaps<kind>(pair, 0, per_extent * extents.x);
    set_gaps<kind>(pair, 1, per_extent * extents.y);
    set_gaps<kind>(pair, 2, per_extent * extents.z);
    const Cubic<L> cubic = bernstein(f);
    pair.cubic[0] = cubic.c0, pair.cubic[1] = cubic.c1, pair.cubic[2] = cubic.c2, pair.cubic[3] = cubic.c3;
    pair.cubic_bound = cubic_bound(r, broadcast<L>(bounds.cubic_on_interval()) * scale.volume, bounds);
    const MotionBounds<L> motion = motion_bounds(r);
    pair.edge = motion.edge, pair.speed = motion.speed;
    pair.area_rounding = area_rounding(scale, bounds);
    pair.origin = broadcast<L>(0.0), pair.duration = broadcast<L>(1.0);
    return apart;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
