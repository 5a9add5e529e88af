// What the certified search knows of a pair. Plain numbers only: kernels of every instruction set read it.
#pragma once

#include <fastccd/options.hpp>

namespace fastccd {

/// Of any instruction set.
inline constexpr unsigned most_lanes = 8;

/// Bernstein coefficients over the whole interval [0, 1], or a leaf of it (restriction.hpp), of the pair as scaled by the search
/// (scalar/scaling.hpp). A `bound` is that of whatever is computed from such coefficients on any part of the interval; those of a leaf are at
/// first bounds of its coefficients alone, and hold on parts of it after add_rounding_on_parts(). T: double, or a lane type, for as many pairs
/// side by side.
template <class T>
struct PolynomialsOf {
    /// One component of an edge function (visit_edge_functions).
    struct EdgeFunction {
        T start, middle, end;
        T bound;
    };
    /// How far a vertex of the second primitive is above one of the first, along an axis.
    struct Gap {
        T start, end;
        T bound;
    };

    T cubic[4], cubic_bound;   ///< Of coplanarity.
    EdgeFunction edges[3][4];  ///< By axis of projection: p, q, t, and for two edges s.
    Gap gaps[3][4];            ///< By axis: the vertex to those of the face, three; or x0 to x2 and x3, x1 to x2 and x3.
    T origin, duration;        ///< In the step, of the interval that these are over: 0 and 1, or of a leaf.
};

/// With what does not depend on the interval.
template <class T>
struct PairCoefficientsOf : PolynomialsOf<T> {
    PairKind kind;
    T start[3][3], end[3][3];  ///< r_1, r_2, r_3 by axis, at both ends of the step.
    T edge, speed;             ///< C1 and C2 of eq. 6.
    T area_rounding;           ///< Of area inclusion (area_inclusion.hpp).
};
using PairCoefficients = PairCoefficientsOf<double>;

inline constexpr int gap_count(PairKind kind) { return kind == PairKind::vertex_face ? 3 : 4; }
inline constexpr int edge_function_count(PairKind kind) { return kind == PairKind::vertex_face ? 3 : 4; }

/// Bit i: the pair is certainly apart on [starts[i], ends[i]], one interval per lane. `by_area`: eq. 7 counts, too. `met`: bits of
/// intervals that are known to have no certificate but that.
using ApartOnIntervals = unsigned(const PairCoefficients&, const double* starts, const double* ends, unsigned met, bool by_area);

/// The same for the lanes of one instruction set, `lanes` intervals at a time, at least 4. Null: not for this one.
struct IntervalKernel {
    unsigned lanes;
    ApartOnIntervals* apart;
};

}  // namespace fastccd
