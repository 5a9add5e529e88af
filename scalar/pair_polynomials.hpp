// All polynomials of one pair over the searched interval, and the certificates on parts of it.
#pragma once

#include <fastccd/options.hpp>

#include <area_inclusion.hpp>
#include <bernstein.hpp>
#include <certificates.hpp>
#include <search_parameters.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

/// A time interval [a, b] of the parameter s, 0 <= a <= b <= 1.
struct Interval {
    double a, b;
};

template <PairKind kind>
class PairPolynomials {
public:
    PairPolynomials(const RelativeMotion<double>& motion, const ErrorBounds& error_bounds)
        : r{motion}, bounds{error_bounds}
    {
        const LaneMask<double> separated = linear_certificate<kind>(r, bounds, extents);
        scale = scales(extents);
        const CoplanarityCubic<double> f = coplanarity_cubic(r, cross_product(r, 0, 1));
        cubic = bernstein(f);
        visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) {
            apart_throughout = (separated | cubic_certificate(f, scale.volume, bounds) |
                                quadratic_certificate<kind>(p, q, t, s, scale, bounds)).value;
            split(p, edges[0]);
            split(q, edges[1]);
            split(t, edges[2]);
            split(s, edges[3]);
        });
    }

    /// The certificates on [0, 1], as the lanes compute them.
    [[nodiscard]] bool apart() const { return apart_throughout; }

    /// True if one of the three certificates proves absence on the interval.
    [[nodiscard]] bool apart(Interval i) const
    {
        return never_coplanar(coplanarity(i)) || apart_in_some_projection(i) || separated_on(i);
    }

    /// Eq. 7 on the interval: its middle, with delta half its width.
    [[nodiscard]] bool apart_by_area(Interval i) const
    {
        const double half = 0.5 * (i.b - i.a);
        return area_certificate<kind>(r, scale, i.a + half, half, bounds).value;
    }

    /// Bernstein coefficients of the coplanarity cubic on the interval, each within cubic_bound().
    [[nodiscard]] Cubic<double> coplanarity(Interval i) const { return on_interval(cubic, i.a, i.b); }
    [[nodiscard]] double cubic_bound() const { return bounds.cubic_on_interval() * scale.volume; }

    /// True if every coplanar time of the interval is a contact: proper inclusion in some projection.
    [[nodiscard]] bool included(Interval i) const
    {
        for (int axis = 0; axis < 3; ++axis) {
            const double bound = bounds.quadratic_on_interval() * area(axis);
            const auto p = sign(edges[0][axis], i, bound), q = sign(edges[1][axis], i, bound),
                       t = sign(edges[2][axis], i, bound);
            if constexpr (kind == PairKind::vertex_face) {
                if (p != 0 && p == q && q == t) return true;
            } else {
                const auto s = sign(edges[3][axis], i, bounds.quadratic_sum_on_interval() * area(axis));
                if (p * t == -1 && q * s == -1) return true;
            }
        }
        return false;
    }

private:
    static void split(const QuadraticVector<double>& v, Quadratic<double> (&by_axis)[3])
    {
        by_axis[0] = {v.start.x, 0.5 * v.twice_middle.x, v.end.x};
        by_axis[1] = {v.start.y, 0.5 * v.twice_middle.y, v.end.y};
        by_axis[2] = {v.start.z, 0.5 * v.twice_middle.z, v.end.z};
    }

    /// Strict sign throughout the interval; 0 if there is none beyond the bound.
    static int sign(const Quadratic<double>& q, Interval i, double bound)
    {
        const Quadratic<double> c = on_interval(q, i.a, i.b);
        return smallest(c) > bound ? 1 : largest(c) < -bound ? -1 : 0;
    }

    [[nodiscard]] double area(int axis) const { return axis == 0 ? scale.yz : axis == 1 ? scale.zx : scale.xy; }

    [[nodiscard]] bool never_coplanar(const Cubic<double>& f) const
    {
        return smallest(f) > cubic_bound() || largest(f) < -cubic_bound();
    }

    [[nodiscard]] bool apart_in_some_projection(Interval i) const
    {
        for (int axis = 0; axis < 3; ++axis) {
            const auto range = [&](const Quadratic<double>& q) -> SignRange<double> {
                const Quadratic<double> c = on_interval(q, i.a, i.b);
                return {smallest(c), largest(c)};
            };
            const SignRange<double> t = range(edges[2][axis]);
            const SignRange<double> s = kind == PairKind::edge_edge ? range(edges[3][axis]) : t;
            if (apart_in_projection<kind>(range(edges[0][axis]), range(edges[1][axis]), t, s,
                                          bounds.quadratic_on_interval() * area(axis),
                                          bounds.quadratic_sum_on_interval() * area(axis)).value)
                return true;
        }
        return false;
    }

    [[nodiscard]] bool separated_on(Interval i) const
    {
        Vector3<double> start[3], end[3];
        for (int k = 0; k < 3; ++k) {
            start[k] = position(r, k, i.a);
            end[k] = position(r, k, i.b);
        }
        const auto along = [&](auto component, double extent) {
            const auto s = axis_gap<kind, double>({component(start[0]), component(start[1]), component(start[2])});
            const auto e = axis_gap<kind, double>({component(end[0]), component(end[1]), component(end[2])});
            const double bound = bounds.linear_on_interval() * extent;
            return (s.above > bound && e.above > bound) || (s.below < -bound && e.below < -bound);
        };
        return along([](const Vector3<double>& v) { return v.x; }, extents.x) ||
               along([](const Vector3<double>& v) { return v.y; }, extents.y) ||
               along([](const Vector3<double>& v) { return v.z; }, extents.z);
    }

    RelativeMotion<double> r;
    ErrorBounds bounds;
    Extents<double> extents;
    Scales<double> scale;
    Cubic<double> cubic;
    Quadratic<double> edges[4][3];  ///< p, q, t, s of EdgeFunctions per axis.
    bool apart_throughout;
};

}  // namespace fastccd::scalar
