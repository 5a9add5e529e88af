// Calls as those of Tight-Inclusion (Wang et al. 2021), answered by fastccd. With
//
//     #include <fastccd/adapters/tight_inclusion.hpp>
//     namespace ticcd = fastccd::tight_inclusion;
//
// code that calls ticcd::vertexFaceCCD and ticcd::edgeEdgeCCD compiles unchanged. What differs:
//
// - Rounding needs no bounding box of the scene: `err` is not looked at. Work is bounded without `max_itr`, and the
//   tolerance is reached, to within rounding, but for pairs that reach the cap on the work (README, Minimum separation and
//   Accuracy): output_tolerance is the tolerance.
// - `no_zero_toi` needs no second search: a pair that is apart at t = 0, beyond rounding, has toi > 0 anyway. toi = 0 means
//   contact at the start, to within rounding.
// - With a minimum separation `ms`, toi = 0 means that the pair is within it at the start. One that is negative, a t_max
//   outside [0, 1], a tolerance that is not positive, and coordinates that are not finite are std::invalid_argument.
#pragma once

#include <fastccd/adapters/distance_tolerance.hpp>

namespace fastccd::tight_inclusion {

using Scalar = double;
using Vector3 = Eigen::Vector3d;
using Array3 = Eigen::Array3d;

inline constexpr bool DEFAULT_NO_ZERO_TOI = false;
inline constexpr Scalar DEFAULT_CCD_DISTANCE_TOL = 1e-6;

/// Accepted and without effect.
enum class CCDRootFindingMethod { DEPTH_FIRST_SEARCH, BREADTH_FIRST_SEARCH };

/// True if the edges a and b come within `ms` of each other in [0, t_max]. toi: lower bound of the first time, at which they are
/// apart by less than `ms` plus `tolerance`, a distance (see above); +infinity if they do not come so close.
inline bool edgeEdgeCCD(const Vector3& ea0_t0, const Vector3& ea1_t0, const Vector3& eb0_t0, const Vector3& eb1_t0, const Vector3& ea0_t1,
                        const Vector3& ea1_t1, const Vector3& eb0_t1, const Vector3& eb1_t1, const Array3& /*err*/, const Scalar ms,
                        Scalar& toi, const Scalar tolerance, const Scalar t_max, const long /*max_itr*/, Scalar& output_tolerance,
                        bool /*no_zero_toi*/ = DEFAULT_NO_ZERO_TOI,
                        const CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH)
{
    output_tolerance = tolerance;
    return adapters::touches(PairKind::edge_edge, {ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1}, ms, tolerance, t_max, toi);
}

/// The same for a vertex and a face.
inline bool vertexFaceCCD(const Vector3& v_t0, const Vector3& f0_t0, const Vector3& f1_t0, const Vector3& f2_t0, const Vector3& v_t1,
                          const Vector3& f0_t1, const Vector3& f1_t1, const Vector3& f2_t1, const Array3& /*err*/, const Scalar ms,
                          Scalar& toi, const Scalar tolerance, const Scalar t_max, const long /*max_itr*/, Scalar& output_tolerance,
                          bool /*no_zero_toi*/ = DEFAULT_NO_ZERO_TOI,
                          const CCDRootFindingMethod /*ccd_method*/ = CCDRootFindingMethod::BREADTH_FIRST_SEARCH)
{
    output_tolerance = tolerance;
    return adapters::touches(PairKind::vertex_face, {v_t0, f0_t0, f1_t0, f2_t0, v_t1, f0_t1, f1_t1, f2_t1}, ms, tolerance, t_max, toi);
}

}  // namespace fastccd::tight_inclusion
