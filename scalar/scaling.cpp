#include <scaling.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <error_bound.hpp>

namespace fastccd::scalar {

namespace {

/// Extents beyond these make degree-3 products (and their squares) leave the range of double.
constexpr double smallest_unscaled = 0x1p-100;
constexpr double largest_unscaled = largest_extent;

/// Multiplies the eight coordinates of one axis so that their differences have an extent near 1, if needed.
/// Scaling down may round tiny coordinates to multiples of 2^-1074. Rounding is monotone, so no difference
/// changes sign, and the error is far below u times the extent.
void scale_axis(double (&x)[8])
{
    // Halve first if a difference could overflow; exact, except as above.
    for (const double value : x)
        if (std::abs(value) > 0x1p1021) {
            for (double& each : x) each *= 0x1p-4;
            break;
        }
    double extent = 0.0;
    for (int end = 0; end < 8; end += 4)
        for (int point = 1; point < 4; ++point) extent = std::max(extent, std::abs(x[end + point] - x[end]));
    if (extent == 0.0 || (extent >= smallest_unscaled && extent <= largest_unscaled)) return;

    // Differences are taken before scaling, so that a small difference of large coordinates keeps all its
    // digits; then x0 = 0 and x_i = r_i, which is the same relative motion.
    const int exponent = std::ilogb(extent);
    for (int end = 0; end < 8; end += 4) {
        for (int point = 1; point < 4; ++point) x[end + point] = std::scalbn(x[end + point] - x[end], -exponent);
        x[end] = 0.0;
    }
}

/// With points 0 and `origin` exchanged.
RelativeMotion<double> unscaled_relative_motion(const double* coordinates, int origin)
{
    const auto point = [=](int i) { return coordinates + 3 * (i == 0 ? origin : i == origin ? 0 : i); };
    const double* const start = point(0);
    const auto relative = [&](int i, int end) {
        const double *p = point(i) + 12 * end, *p0 = start + 12 * end;
        return Vector3<double>{p[0] - p0[0], p[1] - p0[1], p[2] - p0[2]};
    };
    return {{relative(1, 0), relative(2, 0), relative(3, 0)}, {relative(1, 1), relative(2, 1), relative(3, 1)}};
}

}  // namespace

RelativeMotion<double> scaled_relative_motion(const double* coordinates, double t_max, int origin)
{
    if (t_max == 1.0) {
        const RelativeMotion<double> r = unscaled_relative_motion(coordinates, origin);
        const Extents<double> e = extents(r);
        const auto needs_none = [](double extent) {
            return extent == 0.0 || (extent >= smallest_unscaled && extent <= largest_unscaled);
        };
        if (needs_none(e.x) && needs_none(e.y) && needs_none(e.z)) return r;
    }
    double scaled[24];
    for (int axis = 0; axis < 3; ++axis) {
        double x[8];
        for (int k = 0; k < 8; ++k) x[k] = coordinates[3 * k + axis];
        std::swap(x[0], x[origin]);
        std::swap(x[4], x[4 + origin]);
        scale_axis(x);
        for (int k = 0; k < 8; ++k) scaled[3 * k + axis] = x[k];
    }
    return relative_motion<double>(scaled, 1, t_max);
}

}  // namespace fastccd::scalar
