// All polynomials of one pair over the searched interval, and the certificates on parts of it.
#pragma once

#include <algorithm>
#include <cmath>

#include <fastccd/options.hpp>

#include <interval_certificates.hpp>
#include <interval_stack.hpp>
#include <magnitudes.hpp>
#include <scaling.hpp>
#include <search_parameters.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

template <PairKind kind>
class PairPolynomials {
public:
    /// `coordinates`: 24 finite ones, in the order of PairView.
    PairPolynomials(const double* coordinates, const SearchParameters& parameters)
    {
        const ErrorBounds& bounds = parameters.bounds;
        const CertificateBounds whole = bounds.certificates();
        const RelativeMotion<double> r = scaled_relative_motion(coordinates, parameters.t_max);
        Extents<double> extents;
        const LaneMask<double> separated = linear_certificate<kind>(r, whole, extents);
        const Scales<double> scale = scales(extents);
        const CoplanarityCubic<double> f = coplanarity_cubic(r, cross_product(r, 0, 1));
        visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) {
            apart_throughout = (separated | cubic_certificate(f, scale.volume, whole) |
                                quadratic_certificate<kind>(p, q, t, s, scale, whole)).value;
            set_edge(0, p, cross_product_magnitude(r, 0, 1), scale, bounds);
            set_edge(1, q, cross_product_magnitude(r, 1, 2), scale, bounds);
            set_edge(2, t, cross_product_magnitude(r, 2, 0), scale, bounds);
        });
        if constexpr (kind == PairKind::edge_edge) {
            // s = (r3 - r2) x (r1 - r2) is (x2 - x1) x (x3 - x1): from differences to x1 it has a third of the
            // rounding of the sum that the lanes form.
            const RelativeMotion<double> from_x1 = scaled_relative_motion(coordinates, parameters.t_max, 1);
            Extents<double> extents_from_x1;
            linear_certificate<kind>(from_x1, whole, extents_from_x1);
            set_edge(3, cross_product(from_x1, 1, 2), cross_product_magnitude(from_x1, 1, 2), scales(extents_from_x1), bounds);
        }

        pair.kind = kind;
        for (int i = 0; i < 3; ++i) {
            set_vector(pair.start[i], r.start[i]);
            set_vector(pair.end[i], r.end[i]);
        }
        const double per_extent = bounds.linear_on_interval();
        set_vector(pair.gap_bound, {per_extent * extents.x, per_extent * extents.y, per_extent * extents.z});
        const Cubic<double> cubic = bernstein(f);
        pair.cubic[0] = cubic.c0, pair.cubic[1] = cubic.c1, pair.cubic[2] = cubic.c2, pair.cubic[3] = cubic.c3;
        pair.cubic_bound = FASTCCD_KERNEL_NAMESPACE::cubic_bound(r, bounds.cubic_on_interval() * scale.volume, bounds);
        const MotionBounds<double> motion = motion_bounds(r);
        pair.edge = motion.edge, pair.speed = motion.speed;
        pair.area_rounding = area_rounding(scale, bounds);
    }

    /// The certificates on [0, 1], as the lanes compute them.
    [[nodiscard]] bool apart() const { return apart_throughout; }

    /// True if one of the three certificates proves absence on the interval.
    [[nodiscard]] bool apart(Interval i) const { return apart_on<kind>(pair, i.a, i.b).value; }

    /// Eq. 7 on the interval.
    [[nodiscard]] bool apart_by_area(Interval i) const { return apart_by_area_on<kind>(pair, i.a, i.b).value; }

    /// Bernstein coefficients of the coplanarity cubic on the interval, each within cubic_bound().
    [[nodiscard]] Cubic<double> coplanarity(Interval i) const { return coplanarity_on(pair, i.a, i.b); }
    [[nodiscard]] double cubic_bound() const { return pair.cubic_bound; }

    /// True if every coplanar time of the interval is a contact: proper inclusion in some projection.
    [[nodiscard]] bool included(Interval i) const
    {
        for (const auto& edges : pair.edges) {
            const auto sign = [&](int edge) {
                const StrictSign<double> strict = strict_sign(edges[edge], i.a, i.b);
                return strict.positive.value ? 1 : strict.negative.value ? -1 : 0;
            };
            const int p = sign(0), q = sign(1), t = sign(2);
            if constexpr (kind == PairKind::vertex_face) {
                if (p != 0 && p == q && q == t) return true;
            } else {
                if (p * t == -1 && q * sign(3) == -1) return true;
            }
        }
        return false;
    }

    /// Whether the area of the face, or of the parallelogram of both edges, is no small part of the terms of edge functions, in some
    /// projection at s: 2^42 times their bound, some 13 u (magnitudes.hpp), is 2^-7 of the largest at any time of the step. A height
    /// is a volume over an area, so what is degenerate amplifies rounding by the reciprocal of that. A choice, not a bound: who is well
    /// shaped is spared a look.
    [[nodiscard]] bool well_shaped(double s) const
    {
        for (const auto& edges : pair.edges) {
            // p + q + t is twice the area; r1 x (r3 - r2) is -(t + p)
            double area = 0.0, bound = 0.0;
            for (int edge = 0; edge < (kind == PairKind::vertex_face ? 3 : 4); ++edge) {
                const PairCoefficients::EdgeFunction& f = edges[edge];
                if (kind == PairKind::vertex_face || edge % 2 == 0) area += ((1.0 - s) * f.start + 2.0 * s * f.middle) * (1.0 - s) + s * s * f.end;
                bound = std::max(bound, f.bound);
            }
            if (std::abs(area) > 0x1p42 * bound) return true;
        }
        return false;
    }

    /// For kernels that take several intervals at a time.
    [[nodiscard]] const PairCoefficients& coefficients() const { return pair; }

private:
    static void set_vector(double (&to)[3], const Vector3<double>& v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

    void set_edge(int edge, const QuadraticVector<double>& v, const QuadraticVector<double>& m, const Scales<double>& s,
                  const ErrorBounds& bounds)
    {
        const auto component = [&](double start, double twice_middle, double end, double m0, double m1, double m2,
                                   double area) -> PairCoefficients::EdgeFunction {
            return {start, 0.5 * twice_middle, end, quadratic_bound(m0, m1, m2, bounds.quadratic_on_interval() * area, bounds)};
        };
        pair.edges[0][edge] = component(v.start.x, v.twice_middle.x, v.end.x, m.start.x, m.twice_middle.x, m.end.x, s.yz);
        pair.edges[1][edge] = component(v.start.y, v.twice_middle.y, v.end.y, m.start.y, m.twice_middle.y, m.end.y, s.zx);
        pair.edges[2][edge] = component(v.start.z, v.twice_middle.z, v.end.z, m.start.z, m.twice_middle.z, m.end.z, s.xy);
    }

    PairCoefficients pair;
    bool apart_throughout;
};

}  // namespace fastccd::scalar
