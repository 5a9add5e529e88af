// All polynomials of one pair over the searched interval, and the certificates on parts of it.
#pragma once

#include <fastccd/options.hpp>

#include <area_inclusion.hpp>
#include <bernstein.hpp>
#include <certificates.hpp>
#include <magnitudes.hpp>
#include <scaling.hpp>
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
    /// `coordinates`: 24 finite ones, in the order of PairView.
    PairPolynomials(const double* coordinates, const SearchParameters& parameters)
        : r{scaled_relative_motion(coordinates, parameters.t_max)}, bounds{parameters.bounds}
    {
        const CertificateBounds whole = bounds.certificates();
        const LaneMask<double> separated = linear_certificate<kind>(r, whole, extents);
        scale = scales(extents);
        const CoplanarityCubic<double> f = coplanarity_cubic(r, cross_product(r, 0, 1));
        cubic = bernstein(f);
        coplanarity_bound = scalar::cubic_bound(r, bounds.cubic_on_interval() * scale.volume, bounds);
        visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) {
            apart_throughout = (separated | cubic_certificate(f, scale.volume, whole) |
                                quadratic_certificate<kind>(p, q, t, s, scale, whole)).value;
            set_edge(0, p, cross_product_magnitude(r, 0, 1), scale);
            set_edge(1, q, cross_product_magnitude(r, 1, 2), scale);
            set_edge(2, t, cross_product_magnitude(r, 2, 0), scale);
        });
        if constexpr (kind == PairKind::edge_edge) {
            // s = (r3 - r2) x (r1 - r2) is (x2 - x1) x (x3 - x1): from differences to x1 it has a third of the
            // rounding of the sum that the lanes form.
            const RelativeMotion<double> from_x1 = scaled_relative_motion(coordinates, parameters.t_max, 1);
            Extents<double> extents_from_x1;
            linear_certificate<kind>(from_x1, whole, extents_from_x1);
            set_edge(3, cross_product(from_x1, 1, 2), cross_product_magnitude(from_x1, 1, 2), scales(extents_from_x1));
        }
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
    [[nodiscard]] double cubic_bound() const { return coplanarity_bound; }

    /// True if every coplanar time of the interval is a contact: proper inclusion in some projection.
    [[nodiscard]] bool included(Interval i) const
    {
        for (int axis = 0; axis < 3; ++axis) {
            const int p = sign(edges[0][axis], i), q = sign(edges[1][axis], i), t = sign(edges[2][axis], i);
            if constexpr (kind == PairKind::vertex_face) {
                if (p != 0 && p == q && q == t) return true;
            } else {
                if (p * t == -1 && q * sign(edges[3][axis], i) == -1) return true;
            }
        }
        return false;
    }

private:
    /// One component of an edge function and the bound of its coefficients on any interval.
    struct EdgeFunction {
        Quadratic<double> coefficients;
        double bound;
    };

    void set_edge(int edge, const QuadraticVector<double>& v, const QuadraticVector<double>& m, const Scales<double>& s)
    {
        const auto component = [&](double start, double twice_middle, double end, double m0, double m1, double m2,
                                   double area) -> EdgeFunction {
            return {{start, 0.5 * twice_middle, end},
                    quadratic_bound(m0, m1, m2, bounds.quadratic_on_interval() * area, bounds)};
        };
        edges[edge][0] = component(v.start.x, v.twice_middle.x, v.end.x, m.start.x, m.twice_middle.x, m.end.x, s.yz);
        edges[edge][1] = component(v.start.y, v.twice_middle.y, v.end.y, m.start.y, m.twice_middle.y, m.end.y, s.zx);
        edges[edge][2] = component(v.start.z, v.twice_middle.z, v.end.z, m.start.z, m.twice_middle.z, m.end.z, s.xy);
    }

    /// Strict sign throughout the interval; 0 if there is none beyond the bound.
    static int sign(const EdgeFunction& e, Interval i)
    {
        const Quadratic<double> c = on_interval(e.coefficients, i.a, i.b);
        return smallest(c) > e.bound ? 1 : largest(c) < -e.bound ? -1 : 0;
    }

    [[nodiscard]] bool never_coplanar(const Cubic<double>& f) const
    {
        return smallest(f) > cubic_bound() || largest(f) < -cubic_bound();
    }

    /// The strict signs decide as in apart_in_projection.
    [[nodiscard]] bool apart_in_some_projection(Interval i) const
    {
        for (int axis = 0; axis < 3; ++axis) {
            const int p = sign(edges[0][axis], i), t = sign(edges[2][axis], i);
            if constexpr (kind == PairKind::vertex_face) {
                const int q = sign(edges[1][axis], i);
                if (p * q == -1 || q * t == -1 || t * p == -1) return true;
            } else {
                if (p * t == 1) return true;
                if (const int q = sign(edges[1][axis], i); q != 0 && q == sign(edges[3][axis], i)) return true;
            }
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
    double coplanarity_bound;
    EdgeFunction edges[4][3];  ///< p, q, t, s of visit_edge_functions per axis; s for edge-edge alone.
    bool apart_throughout;
};

}  // namespace fastccd::scalar
