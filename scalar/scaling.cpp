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

/// An axis of this extent is left alone.
bool is_unscaled(double extent) { return extent == 0.0 || (extent >= smallest_unscaled && extent <= largest_unscaled); }

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
    if (is_unscaled(extent)) return;

    // Differences are taken before scaling, so that a small difference of large coordinates keeps all its
    // digits; then x0 = 0 and x_i = r_i, which is the same relative motion.
    const int exponent = std::ilogb(extent);
    for (int end = 0; end < 8; end += 4) {
        for (int point = 1; point < 4; ++point) x[end + point] = std::scalbn(x[end + point] - x[end], -exponent);
        x[end] = 0.0;
    }
}

}  // namespace

RelativeMotion<double> scaled_relative_motion(const double* coordinates, double t_max, int origin)
{
    double exchanged[24];
    std::copy(coordinates, coordinates + 24, exchanged);
    for (int k = 0; k < 3; ++k) {
        std::swap(exchanged[k], exchanged[3 * origin + k]);
        std::swap(exchanged[12 + k], exchanged[12 + 3 * origin + k]);
    }

    // As for most pairs. Coordinates beyond 2^1021 have differences of 0 or far too large ones, halved or not.
    const Extents<double> e = extents(relative_motion<double>(exchanged, 1, 1.0));
    if (is_unscaled(e.x) && is_unscaled(e.y) && is_unscaled(e.z)) return relative_motion<double>(exchanged, 1, t_max);

    double scaled[24];
    for (int axis = 0; axis < 3; ++axis) {
        double x[8];
        for (int k = 0; k < 8; ++k) x[k] = exchanged[3 * k + axis];
        scale_axis(x);
        for (int k = 0; k < 8; ++k) scaled[3 * k + axis] = x[k];
    }
    return relative_motion<double>(scaled, 1, t_max);
}

}  // namespace fastccd::scalar
