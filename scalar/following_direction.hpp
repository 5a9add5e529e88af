// A certificate of a distance above d over a time interval, by a direction that follows the primitives exactly.
//
// The vector between two primitives is, while the same features are nearest, along a polynomial of the time: the normal of
// the face or of both edges (degree 2), e x (r x e) from a side e to a point at r from it, or from a point to a side (3),
// or r between two vertices (1). With n(s) such a vector, of Bernstein coefficients n_0 ... n_3 on the interval, the heights
// n(s) . (b(s) - a(s)) of the vertices b of the second primitive over those of the first, a, are of degree 4, and
//
//     |n(s)| <= sum_i B_i(s) |n_i|,
//
// so the pair is farther than d where each height minus d times this sum has positive coefficients. Nothing in this depends on
// which n is taken or how n_i was rounded; a good one decides how long an interval may be. A direction that is linear
// between two unit vectors (kernels/separation_certificate.hpp) is off by its curvature times the size of the primitives, which must
// not exceed the excess of the distance over d, however small both are; here only d grows, by the square of the angle that
// n turns by on the interval: d and its excess alone say how many intervals are needed, not the size.
#pragma once

#include <algorithm>
#include <cmath>

#include <coplanarity.hpp>
#include <farther_certificates.hpp>
#include <separation_certificate.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

template <PairKind kind>
class FollowingDirection {
public:
    /// On [a, b]. Of all vectors between features the one that shows the largest distance at the middle.
    FollowingDirection(const RelativeMotion<double>& motion, double a, double b)
    {
        for (int i = 0; i < 3; ++i) {
            r_[i] = {position(motion, i, a), position(motion, i, b)};
            middle_[i] = scaled(add(r_[i].start, r_[i].end), 0.5);
        }
        if constexpr (kind == PairKind::vertex_face) {
            const Linear side[3] = {r_[1] - r_[0], r_[2] - r_[1], r_[0] - r_[2]};
            consider(elevated(cross_product(side[0], side[1])));
            for (int i = 0; i < 3; ++i) {
                consider(perpendicular(side[i], r_[i]));
                consider(elevated(r_[i]));
            }
        } else {
            const Linear first = r_[0], second = r_[2] - r_[1];
            consider(elevated(cross_product(first, second)));
            for (int i = 1; i < 3; ++i) {
                consider(perpendicular(first, r_[i]));
                consider(elevated(r_[i]));
                consider(elevated(r_[i] - first));
            }
            consider(perpendicular(second, r_[1]));
            consider(perpendicular(second, r_[1] - first));
        }
    }

    /// True if it proves a distance above d throughout; `extents`: of the pair.
    [[nodiscard]] bool farther(const Extents<double>& extents, const SeparationParameters& parameters, const SeparationBounds& bounds) const
    {
        double threshold[4];
        for (int i = 0; i < 4; ++i) {
            const Vector3<double>& v = n_[i];
            const double spread = (std::abs(v.x) * extents.x + std::abs(v.y) * extents.y) + std::abs(v.z) * extents.z;
            const double length = length_from_above(v);
            // What may underflow by 2^-1074 are components, and a height is off by that times |v| then, which is 1 elsewhere.
            threshold[i] = (parameters.threshold * length + bounds.height_following(kind) * spread) + separation_floor * std::max(length, 1.0);
        }
        const Coefficients needed = times_linear([&](int i, int) { return threshold[i]; });
        bool all = true;
        visit_heights([&](const Coefficients& height) {
            for (int k = 0; k < 5; ++k) all = all && needed.c[k] < height.c[k];
        });
        return all;
    }

    /// Bernstein coefficients of degree 4 on [a, b].
    struct Coefficients {
        double c[5];

        friend Coefficients operator-(const Coefficients& p, const Coefficients& q)
        {
            Coefficients difference{};
            for (int k = 0; k < 5; ++k) difference.c[k] = p.c[k] - q.c[k];
            return difference;
        }
    };

    /// Calls visit(coefficients of a height) for each pair of vertices, in the order of for_each_height.
    template <class Visit>
    void visit_heights(Visit visit) const
    {
        for_each_height<kind>(
            [&](int i) { return times_linear([&](int k, int end) { return dot(n_[k], end == 0 ? r_[i].start : r_[i].end); }); }, visit);
    }

    /// Of a cubic n times a linear r: ((4 - k) n_k r_0 + k n_(k-1) r_1) / 4; product(i, end): n_i r_end.
    template <class Product>
    static Coefficients times_linear(Product product)
    {
        return {{product(0, 0), 0.25 * (product(0, 1) + 3.0 * product(1, 0)), 0.5 * (product(1, 1) + product(2, 0)),
                 0.25 * (3.0 * product(2, 1) + product(3, 0)), product(3, 1)}};
    }

    /// n_i; all 0 if no vector shows that the primitives are apart at the middle.
    [[nodiscard]] const Vector3<double>& coefficient(int i) const { return n_[i]; }

private:
    /// Vectors over [a, b], in Bernstein form: linear, cubic.
    struct Linear {
        Vector3<double> start, end;

        friend Linear operator-(const Linear& p, const Linear& q) { return {subtract(p.start, q.start), subtract(p.end, q.end)}; }
    };
    struct Cubic {
        Vector3<double> n[4];
    };

    static QuadraticVector<double> cross_product(const Linear& p, const Linear& q)
    {
        return {cross(p.start, q.start), add(cross(p.start, q.end), cross(p.end, q.start)), cross(p.end, q.end)};
    }

    /// (p + 2 q) / 3 with twice q.
    static Vector3<double> third(const Vector3<double>& p, const Vector3<double>& twice_q) { return scaled(add(p, twice_q), 1.0 / 3.0); }

    static Cubic elevated(const Linear& v)
    {
        return {{v.start, third(v.end, add(v.start, v.start)), third(v.start, add(v.end, v.end)), v.end}};
    }

    static Cubic elevated(const QuadraticVector<double>& v)
    {
        return {{v.start, third(v.start, v.twice_middle), third(v.end, v.twice_middle), v.end}};
    }

    /// e x (p x e) = (e . e) p - (e . p) e, along the part of p that is perpendicular to e.
    static Cubic perpendicular(const Linear& e, const Linear& p)
    {
        const QuadraticVector<double> q = cross_product(p, e);
        return {{cross(e.start, q.start), third(cross(e.end, q.start), cross(e.start, q.twice_middle)),
                 third(cross(e.start, q.end), cross(e.end, q.twice_middle)), cross(e.end, q.end)}};
    }

    void consider(const Cubic& v)
    {
        const Vector3<double> at_middle = scaled(add(add(v.n[0], v.n[3]), scaled(add(v.n[1], v.n[2]), 3.0)), 0.125);
        const Gaps<double> gap = gaps<kind>(at_middle, middle_);
        const double distance = std::max(gap.along, gap.against) / length_from_above(at_middle);
        if (!(largest_distance_ < distance)) return;
        largest_distance_ = distance;
        for (int i = 0; i < 4; ++i) n_[i] = gap.along < gap.against ? subtract({0.0, 0.0, 0.0}, v.n[i]) : v.n[i];
    }

    Linear r_[3];
    Vector3<double> middle_[3];
    Vector3<double> n_[4]{};
    double largest_distance_ = 0.0;
};

}  // namespace fastccd::scalar
