// What the adapters for other interfaces share. Their tolerance is a distance, and minimum separation an argument.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include <fastccd/eigen.hpp>
#include <fastccd/single_pair.hpp>

namespace fastccd::adapters {

using Vector = Eigen::Ref<const Eigen::Vector3d>;

// By their bits, because this is compiled with the options of whoever includes it: with -ffast-math, compilers take it for granted that
// there are no infinities and no NaN, and std::isfinite(+infinity), which is the answer for a pair that is apart, is true. And by reference, as
// clang 19 takes that for granted of arguments, too.

inline bool is_nan(const double& x) { return std::bit_cast<std::uint64_t>(x) << 1 > std::uint64_t{0x7ff} << 53; }
inline bool is_finite(const double& x) { return std::bit_cast<std::uint64_t>(x) << 1 < std::uint64_t{0x7ff} << 53; }

/// Four points of a pair at both ends of the step.
struct MovingPair {
    Point x0[4], x1[4];

    MovingPair(const Vector& a0, const Vector& b0, const Vector& c0, const Vector& d0, const Vector& a1, const Vector& b1,
               const Vector& c1, const Vector& d1)
        : x0{eigen_detail::point(a0), eigen_detail::point(b0), eigen_detail::point(c0), eigen_detail::point(d0)},
          x1{eigen_detail::point(a1), eigen_detail::point(b1), eigen_detail::point(c1), eigen_detail::point(d1)}
    {
    }

    /// The largest distance that a point of the one primitive can move relative to one of the other during the step, to
    /// within rounding: relative displacements are convex combinations of those of end points.
    [[nodiscard]] double largest_displacement(PairKind kind) const
    {
        const int first_points = kind == PairKind::vertex_face ? 1 : 2;
        double largest = 0.0;
        for (int i = 0; i < first_points; ++i)
            for (int j = first_points; j < 4; ++j) largest = std::max(largest, displacement(i, j));
        return largest;
    }

private:
    /// From quarters, of which four add up without overflow, and to no NaN.
    [[nodiscard]] double displacement(int i, int j) const
    {
        double d[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            d[axis] = (0.25 * x1[i][axis] - 0.25 * x1[j][axis]) - (0.25 * x0[i][axis] - 0.25 * x0[j][axis]);
        return 4.0 * std::hypot(d[0], d[1], d[2]);
    }
};

/// True if the pair touches within [0, t_max], or comes within the minimum separation; toi is then a lower bound of the first
/// time, otherwise +infinity. At toi the two are apart by less than the minimum separation plus `distance`, to within
/// rounding, unless the pair reaches the cap on the work (README, Minimum separation and Accuracy). These interfaces have no other
/// way to name what cannot be answered: throws std::invalid_argument for a minimum separation that is negative or not finite, t_max
/// outside [0, 1], a distance that is not positive, coordinates that are not finite, and whatever else the library refuses.
inline bool touches(PairKind kind, const MovingPair& pair, double minimum_separation, double distance, double t_max, double& toi)
{
    if (!is_finite(minimum_separation) || minimum_separation < 0.0)
        throw std::invalid_argument("fastccd: the minimum separation must be finite and at least 0");
    if (is_nan(t_max) || t_max < 0.0 || t_max > 1.0) throw std::invalid_argument("fastccd: t_max must be in [0, 1]");
    if (is_nan(distance) || distance <= 0.0) throw std::invalid_argument("fastccd: the tolerance must be positive");
    if (!is_finite(distance)) distance = std::numeric_limits<double>::max();  // infinite over infinite would be no number
    Options options;
    options.minimum_separation = minimum_separation;
    // No coarser than by default, so that a pair a little farther apart than that at the start is let go. Where a quotient would be beyond 1, it
    // is that of the distance and itself: the caller may trap divisions by zero and overflow.
    options.distance_tolerance = std::min(options.distance_tolerance, distance / std::max(distance, minimum_separation));
    const double displacement = pair.largest_displacement(kind);
    options.tolerance = std::max(distance / std::max(distance, displacement), std::numeric_limits<double>::min());
    // At t_max = 0 the question is about the start alone: a pair at rest there.
    if (t_max > 0.0) options.t_max = t_max;
    const Point(&x1)[4] = t_max > 0.0 ? pair.x1 : pair.x0;
    const PairToi found = kind == PairKind::vertex_face ? vertex_face_toi(pair.x0, x1, options) : edge_edge_toi(pair.x0, x1, options);
    if (!found.status.ok()) throw std::invalid_argument(std::string("fastccd: ") + message(found.status.error));
    if (is_nan(found.toi)) throw std::invalid_argument("fastccd: coordinates must be finite");
    toi = found.toi;
    return is_finite(toi);
}

}  // namespace fastccd::adapters
