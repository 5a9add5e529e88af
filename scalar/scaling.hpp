// Exact scaling of each axis by a power of two.
//
// Contact and its time do not change under an invertible affine map. A pair with an axis whose extent could make products overflow or
// underflow is multiplied by one power of two on all axes, if that brings all extents into the range: lengths and areas keep their
// proportions, so the result has the bits of the pair there. If no one power does, axes within the range stay as they are and those below
// it are brought near 1; only if the largest is beyond it, all are first scaled down by that one. No axis is scaled down that lanes would take
// as it is (error_bound.hpp, largest_lane_extent). Other pairs are left alone, so that they have the same bits as in the lanes.
#pragma once

#include <relative_motion.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

/// True if none of the coordinates of a pair (24) is NaN or infinite.
bool all_finite(const double* coordinates);

/// Motion of a pair of finite coordinates (24, in the order of PairView) relative to point `origin`, which is
/// exchanged with x0; axes scaled where needed, by the differences to x0 whatever the origin: all functions of a pair are in one scale.
RelativeMotion<double> scaled_relative_motion(const double* coordinates, double t_max, int origin = 0);

/// Coordinates of x1, x2, x3 along one axis relative to x0, at t = 0 and t = 1, with exponents that reach beyond those of double.
class AxisDifferences {
public:
    /// Of finite coordinates (24, in the order of PairView). Differences come before scaling, which keeps the digits of small
    /// differences of large coordinates.
    AxisDifferences(const double* coordinates, int axis);

    /// All are zero: the axis has no extent.
    [[nodiscard]] bool zero() const { return largest_[0] == 0.0 && largest_[1] == 0.0; }

    /// Of the largest |component| over [0, t_max], to within 2: (1 - t) p + t q at t = t_max is at most |p| + t |q|, and where it
    /// cancels there is p. Not if zero().
    [[nodiscard]] int exponent(double t_max) const;

    /// Components of the motion over [0, t_max], multiplied by 2^power, by the formula of relative_motion(); t_max q is
    /// formed without underflow. `power` at most 1000 above -exponent(t_max), so that nothing overflows; what underflows errs by
    /// some 2^-1074.
    void put(double (&start)[3], double (&end)[3], double t_max, int power) const;

private:
    double value_[2][3];  ///< To be multiplied by 2^shift.
    int shift_[2];
    double largest_[2] = {0.0, 0.0};  ///< Of the absolute values.
};

}  // namespace fastccd::scalar
