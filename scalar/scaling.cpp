#include <scaling.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <error_bound.hpp>
#include <fastccd/pair_view.hpp>

namespace fastccd::scalar {

namespace {

/// Extents beyond these make degree-3 products (and their squares) leave the range of double.
constexpr double smallest_unscaled = 0x1p-100;
constexpr double largest_unscaled = largest_extent;

/// Exponents of extents within that range: exponent() is that of a bound within a factor 2 of the extent (t_max != 1), and components of
/// r_i from x1 may be twice as large.
constexpr int smallest_exponent = -95, largest_exponent = 95;

bool within_range(double extent) { return extent >= smallest_unscaled && extent <= largest_unscaled; }

/// An axis of this extent over the step, and over the searched part of it, is left alone. Over a short part it may be far
/// smaller, where all begins close together.
bool is_unscaled(double step, double searched) { return step == 0.0 || (within_range(step) && within_range(searched)); }

bool all_unscaled(const Extents<double>& step, const Extents<double>& searched)
{
    return is_unscaled(step.x, searched.x) && is_unscaled(step.y, searched.y) && is_unscaled(step.z, searched.z);
}

}  // namespace

bool all_finite(const double* coordinates)
{
    return std::all_of(coordinates, coordinates + pair_coordinates, [](double x) { return std::isfinite(x); });
}

AxisDifferences::AxisDifferences(const double* coordinates, int axis)
{
    for (int end = 0; end < 2; ++end) {
        const auto x = [&](int point) { return coordinates[12 * end + 3 * point + axis]; };
        // A sixteenth where a difference could overflow; exact, but for coordinates that then have others 2^2000 times as large beside
        // them. Each end by itself: at the other one all may be tiny.
        const double coordinate = std::max({std::abs(x(0)), std::abs(x(1)), std::abs(x(2)), std::abs(x(3))});
        shift_[end] = coordinate > 0x1p1021 ? 4 : 0;
        const double factor = shift_[end] == 0 ? 1.0 : 0x1p-4;
        for (int i = 0; i < 3; ++i) {
            value_[end][i] = x(i + 1) * factor - x(0) * factor;
            largest_[end] = std::max(largest_[end], std::abs(value_[end][i]));
        }
    }
}

int AxisDifferences::exponent(double t_max) const
{
    const int from_start = largest_[0] > 0.0 ? std::ilogb(largest_[0]) + shift_[0] : std::numeric_limits<int>::min();
    const int from_end = largest_[1] > 0.0 ? std::ilogb(largest_[1]) + shift_[1] + std::ilogb(t_max) : std::numeric_limits<int>::min();
    return std::max(from_start, from_end);
}

void AxisDifferences::put(double (&start)[3], double (&end)[3], double t_max, int power) const
{
    const int exponent = std::ilogb(t_max);
    const double significand = std::scalbn(t_max, -exponent);
    for (int i = 0; i < 3; ++i) {
        start[i] = std::scalbn(value_[0][i], shift_[0] + power);
        const double q = std::scalbn(value_[1][i], shift_[1] + power + exponent);
        end[i] = t_max == 1.0 ? q : (1.0 - t_max) * start[i] + significand * q;
    }
}

RelativeMotion<double> scaled_relative_motion(const double* coordinates, double t_max, int origin)
{
    double exchanged[24];
    std::copy(coordinates, coordinates + 24, exchanged);
    for (int k = 0; k < 3; ++k) {
        std::swap(exchanged[k], exchanged[3 * origin + k]);
        std::swap(exchanged[12 + k], exchanged[12 + 3 * origin + k]);
    }

    // As for most pairs. Coordinates beyond 2^1021 have differences of 0 or far too large ones, a sixteenth or not.
    const Extents<double> step = extents(relative_motion<double>(coordinates, 1, 1.0));
    const RelativeMotion<double> from_x0 = relative_motion<double>(coordinates, 1, t_max);
    if (all_unscaled(step, t_max == 1.0 ? step : extents(from_x0)))
        return origin == 0 ? from_x0 : relative_motion<double>(exchanged, 1, t_max);

    // At least one axis has an extent, as all would have been left alone without.
    const AxisDifferences to_x0[] = {{coordinates, 0}, {coordinates, 1}, {coordinates, 2}};
    int largest = std::numeric_limits<int>::min(), smallest = std::numeric_limits<int>::max();
    for (const AxisDifferences& axis : to_x0)
        if (!axis.zero()) {
            largest = std::max(largest, axis.exponent(t_max));
            smallest = std::min(smallest, axis.exponent(t_max));
        }
    // Lanes take what is below largest_extent as it is: scaled down, a gap that they see might underflow. If all fit, `common` is not
    // negative for them: an axis is out of the range, so some extent is below 2^-99, and none beyond 2^92.
    const bool all_fit = largest - smallest <= largest_exponent - smallest_exponent;
    const int common = all_fit ? -((largest + smallest) / 2) : largest < std::ilogb(largest_unscaled) ? 0 : -largest;

    RelativeMotion<double> scaled;
    double Vector3<double>::*const component[] = {&Vector3<double>::x, &Vector3<double>::y, &Vector3<double>::z};
    for (int axis = 0; axis < 3; ++axis) {
        double start[3] = {}, end[3] = {};
        if (!to_x0[axis].zero()) {
            const int exponent = to_x0[axis].exponent(t_max);
            AxisDifferences{exchanged, axis}.put(start, end, t_max, exponent + common < smallest_exponent ? -exponent : common);
        }
        for (int i = 0; i < 3; ++i) {
            scaled.start[i].*component[axis] = start[i];
            scaled.end[i].*component[axis] = end[i];
        }
    }
    return scaled;
}

}  // namespace fastccd::scalar
