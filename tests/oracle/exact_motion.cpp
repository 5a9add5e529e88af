#include "exact_motion.hpp"

#include <algorithm>
#include <cmath>

namespace fastccd::oracle {
namespace {

// Whether point p is on the closed segment from a to b: collinear in all projections, and between them on every axis.
bool on_segment(const ExactMotion& motion, int p, int a, int b, AlgebraicNumber& time) {
    for (int axis = 0; axis < 3; ++axis) {
        if (time.sign_of(motion.area(p, a, b, axis)) != 0) return false;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int to_a = time.sign_of(motion.difference(p, a, axis));
        if (to_a != 0 && to_a == time.sign_of(motion.difference(p, b, axis))) return false;
    }
    return true;
}

// A plane seen along an axis in which its normal has a component is seen one-to-one, so a planar problem may be
// solved in that projection. Without such an axis the face has collapsed to its edges.
StaticContact vertex_face_contact(const ExactMotion& motion, AlgebraicNumber& time) {
    for (int axis = 0; axis < 3; ++axis) {
        if (time.sign_of(motion.area(1, 2, 3, axis)) == 0) continue;
        const int a = time.sign_of(motion.area(0, 1, 2, axis));
        const int b = time.sign_of(motion.area(0, 2, 3, axis));
        if (a * b < 0) return {false, false};
        const int c = time.sign_of(motion.area(0, 3, 1, axis));
        return {a * c >= 0 && b * c >= 0, false};
    }
    return {on_segment(motion, 0, 1, 2, time) || on_segment(motion, 0, 2, 3, time) ||
                on_segment(motion, 0, 3, 1, time),
            true};
}

// Lines that are not parallel cross in one point; it is in both closed segments if each one's end points are not
// strictly on the same side of the other. Parallel segments, points among them, touch only if an end point of one
// is on the other.
StaticContact edge_edge_contact(const ExactMotion& motion, AlgebraicNumber& time) {
    for (int axis = 0; axis < 3; ++axis) {
        if (time.sign_of(motion.cross(0, 1, 2, 3, axis)) == 0) continue;
        const int x2_side = time.sign_of(motion.area(0, 1, 2, axis));
        if (x2_side != 0 && x2_side == time.sign_of(motion.area(0, 1, 3, axis))) return {false, false};
        const int x0_side = time.sign_of(motion.area(2, 3, 0, axis));
        return {x0_side == 0 || x0_side != time.sign_of(motion.area(2, 3, 1, axis)), false};
    }
    return {on_segment(motion, 0, 2, 3, time) || on_segment(motion, 1, 2, 3, time) ||
                on_segment(motion, 2, 0, 1, time) || on_segment(motion, 3, 0, 1, time),
            true};
}

}  // namespace

ExactMotion::ExactMotion(const Pair& pair, double t_max) {
    if (t_max > 0.0) {
        std::frexp(t_max, &time_exponent_);  // t_max = [1/2, 1) 2^e; an exact power of two may end at 1 itself
        if (std::ldexp(0.5, time_exponent_) == t_max) --time_exponent_;
    }
    end_ = to_dyadic(t_max, time_exponent_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<double, 8> values;
        for (std::size_t i = 0; i < 8; ++i) values[i] = pair[i][axis];
        std::array<mpz_class, 8> x;
        to_common_integers(values, x);
        // x(t) = x0 + 2^e u (x1 - x0); for e < 0 the whole axis is multiplied by 2^-e instead.
        for (std::size_t i = 0; i < 4; ++i) {
            auto& c = point_[i][axis].coefficient;
            c[0] = x[i];
            c[1] = x[i + 4] - x[i];
            if (time_exponent_ >= 0) {
                c[1] <<= static_cast<mp_bitcnt_t>(time_exponent_);
            } else {
                c[0] <<= static_cast<mp_bitcnt_t>(-time_exponent_);
            }
        }
    }
}

Polynomial ExactMotion::difference(int i, int j, int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    return point_[static_cast<std::size_t>(j)][a] - point_[static_cast<std::size_t>(i)][a];
}

Polynomial ExactMotion::cross(int i, int j, int k, int l, int axis) const {
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    return difference(i, j, y) * difference(k, l, z) - difference(i, j, z) * difference(k, l, y);
}

Polynomial ExactMotion::volume() const {
    return difference(0, 1, 0) * area(0, 2, 3, 0) + difference(0, 1, 1) * area(0, 2, 3, 1) +
           difference(0, 1, 2) * area(0, 2, 3, 2);
}

std::vector<Polynomial> ExactMotion::planar_events() const {
    std::vector<Polynomial> events;
    const auto add = [&](const Polynomial& p) {
        if (p.degree() < 1) return;  // a constant's sign never changes
        const Polynomial event = primitive_part(p);
        if (std::ranges::find(events, event) == events.end()) events.push_back(event);
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 4; ++i) {
            for (int j = i + 1; j < 4; ++j) {
                add(difference(i, j, axis));
                for (int k = j + 1; k < 4; ++k) add(area(i, j, k, axis));
            }
        }
        add(cross(0, 1, 2, 3, axis));
    }
    return events;
}

StaticContact contact_at(Kind kind, const ExactMotion& motion, AlgebraicNumber& time) {
    return kind == Kind::vertex_face ? vertex_face_contact(motion, time) : edge_edge_contact(motion, time);
}

}  // namespace fastccd::oracle
