// A class with the calls of IPC Toolkit's ipc::NarrowPhaseCCD, answered by fastccd. Derive from ipc::NarrowPhaseCCD and
// forward to it, or use it in its place. What differs:
//
// - toi is the certified lower bound itself: no conservative rescaling. Whoever wants a margin multiplies.
// - With a `min_distance`, toi = 0 means that the pair is within it at the start. One that is negative, a tmax outside [0, 1],
//   points of other than 2 or 3 coordinates, a tolerance that is not positive, and coordinates that are not finite are
//   std::invalid_argument.
#pragma once

#include <fastccd/adapters/distance_tolerance.hpp>

namespace fastccd {

/// A vector of 2 or 3 coordinates.
using VectorMax3d = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;

/// Every call: true if the two touch in [0, tmax]; toi is then a lower bound of the first time, otherwise +infinity.
class NarrowPhaseCCD {
public:
    NarrowPhaseCCD() = default;
    virtual ~NarrowPhaseCCD() = default;

    virtual bool point_point_ccd(const VectorMax3d& p0_t0, const VectorMax3d& p1_t0, const VectorMax3d& p0_t1, const VectorMax3d& p1_t1,
                                 double& toi, const double min_distance = 0.0, const double tmax = 1.0) const
    {
        // As edges without length.
        const Eigen::Vector3d a0 = to_3d(p0_t0), b0 = to_3d(p1_t0), a1 = to_3d(p0_t1), b1 = to_3d(p1_t1);
        return edge_edge_ccd(a0, a0, b0, b0, a1, a1, b1, b1, toi, min_distance, tmax);
    }

    virtual bool point_edge_ccd(const VectorMax3d& p_t0, const VectorMax3d& e0_t0, const VectorMax3d& e1_t0, const VectorMax3d& p_t1,
                                const VectorMax3d& e0_t1, const VectorMax3d& e1_t1, double& toi, const double min_distance = 0.0,
                                const double tmax = 1.0) const
    {
        const Eigen::Vector3d p0 = to_3d(p_t0), p1 = to_3d(p_t1);
        return edge_edge_ccd(p0, p0, to_3d(e0_t0), to_3d(e1_t0), p1, p1, to_3d(e0_t1), to_3d(e1_t1), toi, min_distance, tmax);
    }

    virtual bool point_triangle_ccd(const Eigen::Vector3d& p_t0, const Eigen::Vector3d& t0_t0, const Eigen::Vector3d& t1_t0,
                                    const Eigen::Vector3d& t2_t0, const Eigen::Vector3d& p_t1, const Eigen::Vector3d& t0_t1,
                                    const Eigen::Vector3d& t1_t1, const Eigen::Vector3d& t2_t1, double& toi,
                                    const double min_distance = 0.0, const double tmax = 1.0) const
    {
        return adapters::touches(PairKind::vertex_face, {p_t0, t0_t0, t1_t0, t2_t0, p_t1, t0_t1, t1_t1, t2_t1}, min_distance, tolerance,
                                 tmax, toi);
    }

    virtual bool edge_edge_ccd(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0, const Eigen::Vector3d& eb0_t0,
                               const Eigen::Vector3d& eb1_t0, const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                               const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1, double& toi, const double min_distance = 0.0,
                               const double tmax = 1.0) const
    {
        return adapters::touches(PairKind::edge_edge, {ea0_t0, ea1_t0, eb0_t0, eb1_t0, ea0_t1, ea1_t1, eb0_t1, eb1_t1}, min_distance,
                                 tolerance, tmax, toi);
    }

    /// A distance: how much farther than min_distance the two may still be apart at toi, rounding and a cap on the work (README) aside.
    double tolerance = 1e-6;

private:
    /// Points of the plane lie at z = 0.
    static Eigen::Vector3d to_3d(const VectorMax3d& x)
    {
        if (x.size() != 2 && x.size() != 3) throw std::invalid_argument("fastccd: a point has 2 or 3 coordinates");
        return {x[0], x[1], x.size() == 3 ? x[2] : 0.0};
    }
};

}  // namespace fastccd
