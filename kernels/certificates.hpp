// The three certificates of absence on the whole interval: cubic (volume), quadratic (projected areas), linear (lengths).
//
// A contact at a time s needs f(s) = 0 (coplanar), a contact in each coordinate projection, and an
// overlap along each axis. Each is refuted by the strict sign of Bernstein coefficients beyond their
// error bounds (the paper's dimension reduction, section 4.2, turned into sign tests). Any one proves
// absence, whatever the degeneracy: flat triangles, points, parallel or no motion, the zero cubic.
#pragma once

#include <fastccd/options.hpp>

#include <coplanarity.hpp>
#include <separation_bound.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Products of extents, floored against underflow (error_bound.hpp).
template <class L>
struct Scales {
    L yz, zx, xy;  ///< For the projections along x, y and z.
    L volume;
};

template <class L>
FASTCCD_INLINE Scales<L> scales(const Extents<L>& e)
{
    const L floor = broadcast<L>(extent_floor(Lane<L>::is_single));
    const L x = max(e.x, floor), y = max(e.y, floor), z = max(e.z, floor);
    const L xy = x * y;
    return {y * z, z * x, xy, xy * z};
}

/// Components of r1, r2, r3 along one axis at one end of an interval.
template <class L>
struct AxisComponents {
    L r1, r2, r3;
};

/// Signed gap between the two primitives along one axis, at one time. The pair is apart along the
/// axis, in one and the same order over a whole interval, if `above` is positive at both ends or
/// `below` negative at both ends (each is a difference of linear functions of time per pair of points).
template <class L>
struct AxisGap {
    L above;    ///< Smallest coordinate of the second primitive minus the largest of the first.
    L below;    ///< Largest coordinate of the second primitive minus the smallest of the first.
    L largest;  ///< Largest and smallest component, for the extent.
    L smallest;
};

template <PairKind kind, class L>
FASTCCD_INLINE AxisGap<L> axis_gap(const AxisComponents<L>& c)
{
    if constexpr (kind == PairKind::vertex_face) {  // the origin against r1 r2 r3
        const L low = min(c.r1, c.r2, c.r3);
        const L high = max(c.r1, c.r2, c.r3);
        return {low, high, high, low};
    } else {  // 0 r1 against r2 r3
        const L zero = broadcast<L>(0.0);
        const L low_first = min(zero, c.r1), high_first = max(zero, c.r1);
        const L low_second = min(c.r2, c.r3), high_second = max(c.r2, c.r3);
        return {low_second - high_first, high_second - low_first, max(high_first, high_second),
                min(low_first, low_second)};
    }
}

/// Strictly apart along an axis, in one order, over an interval with these gaps at its ends.
template <class L>
FASTCCD_INLINE LaneMask<L> separated(const AxisGap<L>& start, const AxisGap<L>& end, L bound)
{
    return less(bound, min(start.above, end.above)) | less(max(start.below, end.below), negated(bound));
}

/// Of a gap, for components with this extent. What is interpolated errs by some 2^-1074 as well, where products underflow; not so
/// over the whole of a step with t_max = 1: there nothing is, and the bound is 0 whatever the extent.
template <class L>
FASTCCD_INLINE L gap_bound(const CertificateBounds& bounds, L extent)
{
    return broadcast<L>(bounds.linear) * max(extent, broadcast<L>(extent_floor(Lane<L>::is_single)));
}

/// Of a gap that is to exceed d.
template <class L>
FASTCCD_INLINE L gap_bound(const FartherBounds& bounds, L extent)
{
    return (broadcast<L>(bounds.distance) + broadcast<L>(bounds.gap) * extent) + broadcast<L>(bounds.gap_floor);
}

template <class L>
struct LinearCertificate {
    LaneMask<L> apart;
    L extent;
};

/// Strict separation along one axis over the whole interval; by more than d with FartherBounds.
template <PairKind kind, class L, class Bounds>
FASTCCD_INLINE LinearCertificate<L> separated_along_axis(const AxisComponents<L>& start, const AxisComponents<L>& end, const Bounds& bounds)
{
    const AxisGap<L> s = axis_gap<kind>(start), e = axis_gap<kind>(end);
    const L extent = max(max(s.largest, e.largest), negated(min(s.smallest, e.smallest)));
    return {separated(s, e, gap_bound(bounds, extent)), extent};
}

/// All axes at once; the extents come with it for free.
template <PairKind kind, class L, class Bounds>
FASTCCD_INLINE LaneMask<L> linear_certificate(const RelativeMotion<L>& r, const Bounds& bounds, Extents<L>& extents)
{
    const auto along = [&](auto component) FASTCCD_INLINE_LAMBDA {
        return separated_along_axis<kind, L>({component(r.start[0]), component(r.start[1]), component(r.start[2])},
                                             {component(r.end[0]), component(r.end[1]), component(r.end[2])}, bounds);
    };
    const auto x = along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.x; });
    const auto y = along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.y; });
    const auto z = along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.z; });
    extents = {x.extent, y.extent, z.extent};
    return x.apart | y.apart | z.apart;
}

template <class L>
FASTCCD_INLINE L smallest_of(L a, L b)
{
    return min(a, b);
}
/// In pairs, so that few of the minima wait for others.
template <class L, class... More>
FASTCCD_INLINE L smallest_of(L a, L b, L c, More... more)
{
    if constexpr (sizeof...(more) == 0)
        return min(min(a, b), c);
    else
        return min(min(a, b), smallest_of(c, more...));
}

/// All values beyond the bound (not negative) on one side. Their signs are compared as bits, so that minima are enough: where
/// comparisons, minima and sums share units, those have the most to do, and operations on bits go anywhere.
template <class L, class... More>
FASTCCD_INLINE LaneMask<L> one_sign(L bound, L first, More... others)
{
    return less(bound, smallest_of(abs(first), times_sign(others, first)...));
}

/// Never coplanar: all four coefficients beyond the bound on one side.
template <class L>
FASTCCD_INLINE LaneMask<L> cubic_certificate(const CoplanarityCubic<L>& f, L volume, const CertificateBounds& bounds)
{
    return one_sign(broadcast<L>(bounds.cubic) * volume, f.start, f.thrice_second, f.thrice_third, f.end);
}

/// Bernstein coefficients of an edge function over an interval, in any order, or positive multiples of them.
template <class L>
struct EdgeCoefficients {
    L a, b, c;
};

/// Edge functions of one coordinate projection over an interval.
/// Vertex-face: p, q, t are the orientations of the vertex against the face's edges r1 r2, r2 r3, r3 r1;
/// the vertex is outside if one is strictly positive and another strictly negative throughout.
/// Edge-edge: p, t are the orientations of r2, r3 against the first edge, q, s those of 0, r1 against
/// the second; the edges are apart if both of one couple are strictly on one side throughout.
/// `bound_sum` is for s, which is a sum of three cross products; q, compared together with it, could do with less.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> apart_in_projection(const EdgeCoefficients<L>& p, const EdgeCoefficients<L>& q, const EdgeCoefficients<L>& t,
                                               const EdgeCoefficients<L>& s, L bound, L bound_sum)
{
    if constexpr (kind == PairKind::vertex_face) {
        const auto smallest = [](const EdgeCoefficients<L>& e) FASTCCD_INLINE_LAMBDA { return min(e.a, e.b, e.c); };
        const auto largest = [](const EdgeCoefficients<L>& e) FASTCCD_INLINE_LAMBDA { return max(e.a, e.b, e.c); };
        return less(bound, max(smallest(p), smallest(q), smallest(t))) & less(min(largest(p), largest(q), largest(t)), negated(bound));
    } else {
        return one_sign(bound, p.a, p.b, p.c, t.a, t.b, t.c) | one_sign(bound_sum, q.a, q.b, q.c, s.a, s.b, s.c);
    }
}

/// Calls visit(p, q, t, s) with the four vector-valued edge functions of a pair: p = r1 x r2, q = r2 x r3, and
/// vertex-face: t = r3 x r1, s unused; edge-edge: t = r1 x r3, s = (r3 - r2) x (r1 - r2) = (q - t) + p.
/// By reference: compilers copy structures of wide registers through memory, in pieces.
template <PairKind kind, class L, class Visit>
FASTCCD_INLINE auto visit_edge_functions(const RelativeMotion<L>& r, Visit visit)
{
    const QuadraticVector<L> p = cross_product(r, 0, 1), q = cross_product(r, 1, 2);
    if constexpr (kind == PairKind::vertex_face) {
        const QuadraticVector<L> t = cross_product(r, 2, 0);
        return visit(p, q, t, t);
    } else {
        const QuadraticVector<L> t = cross_product(r, 0, 2);
        const QuadraticVector<L> s = subtract_then_add(q, t, p);
        return visit(p, q, t, s);
    }
}

/// Apart in at least one coordinate projection over the whole interval (paper, eq. 9 and 10).
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> quadratic_certificate(const QuadraticVector<L>& p, const QuadraticVector<L>& q,
                                                 const QuadraticVector<L>& t, const QuadraticVector<L>& s,
                                                 const Scales<L>& scale, const CertificateBounds& bounds)
{
    const auto along = [&](auto component, L area) FASTCCD_INLINE_LAMBDA {
        const auto of = [&](const QuadraticVector<L>& v) FASTCCD_INLINE_LAMBDA -> EdgeCoefficients<L> {
            return {component(v.start), component(v.twice_middle), component(v.end)};
        };
        return apart_in_projection<kind, L>(of(p), of(q), of(t), of(s),
                                            broadcast<L>(bounds.quadratic) * area,
                                            broadcast<L>(bounds.quadratic_sum) * area);
    };
    return along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.x; }, scale.yz) |
           along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.y; }, scale.zx) |
           along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.z; }, scale.xy);
}

/// True where the coordinates are finite and their differences within the lanes' range. Extents in
/// that range are of finite r_i, unless one is NaN, which maxima may lose; but every component of every r_i
/// is a factor of f0 or f3, and then their sum is NaN, the only number not at most itself. In single precision not too small either.
template <class L, class Bounds>
FASTCCD_INLINE LaneMask<L> in_lane_range(const CoplanarityCubic<L>& f, const Extents<L>& e, const Bounds& bounds)
{
    const L sum = f.start + f.end, largest = max(e.x, e.y, e.z);
    const LaneMask<L> in_range = less_equal(sum, sum) & less(largest, broadcast<L>(bounds.largest_extent));
    if constexpr (Lane<L>::is_single) return in_range & less(broadcast<L>(bounds.smallest_extent), largest);
    return in_range;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
