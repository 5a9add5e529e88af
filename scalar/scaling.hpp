// Exact scaling of each axis by a power of two.
//
// Contact and its time do not change under an invertible affine map. Pairs whose extents could make
// products overflow or underflow are mapped so that every extent is near 1; the others are left alone, so
// that they have the same bits as in the lanes.
#pragma once

#include <relative_motion.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

/// Motion of a pair of finite coordinates (24, in the order of PairView) relative to point `origin`, which is
/// exchanged with x0; axes scaled where needed.
RelativeMotion<double> scaled_relative_motion(const double* coordinates, double t_max, int origin = 0);

}  // namespace fastccd::scalar
