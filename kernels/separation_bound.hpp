// Rounding of the search with a minimum separation d (separation_certificate.hpp), in multiples of u = 2^-53, and what
// a call asks of it.
//
// Notation as in error_bound.hpp: X, Y, Z are the extents of the pair, and a computed component of r_i along x errs by
// at most rho u X at an end of the searched interval. n is whatever vector was computed, taken as exact, because every
// vector gives a valid certificate; S = |n_x| X + |n_y| Y + |n_z| Z. Bounds are multiples of u S. S itself is computed
// within 3 u and multiplied twice; this and terms in u^2 are covered by `slack`, since every constant is below 2^7.
#pragma once

#include <fastccd/options.hpp>

#include <error_bound.hpp>

namespace fastccd {

/// Added to a bound against products that underflow. Directions are unit vectors and the largest extent is at least 2^-60
/// (smallest_separation_extent), so this is below 2^-900 of anything that counts; a height is a sum of three products,
/// each off by 2^-1075 at most, of components that scaling to the lanes' range may have moved by as much.
inline constexpr double separation_floor = 0x1p-1020;

/// Extents for which no product below leaves the range of double: the largest is the square of a height along a
/// normal, the product of two sides, times the square of a distance, below 2^(8 60 + 20). Pairs beyond are scaled by a
/// power of two, the same on all axes and for d, by the scalar search; lanes leave them to it.
inline constexpr double smallest_separation_extent = 0x1p-60;
inline constexpr double largest_separation_extent = 0x1p60;

/// What a call asks for. All distances are in units of the coordinates.
struct SeparationParameters {
    double distance;   ///< d; 0: contact itself, which is another search.
    double tolerance;  ///< Relative.
    double threshold;  ///< A gap along a computed unit vector above this proves a distance above d.
    double stop;       ///< Closer than this is close enough to be reported.
    double aim;        ///< Halfway to there.
    double certain;    ///< A computed distance up to this is certainly at most d.

    /// Computed unit vectors are longer than 1 by at most 5 u: the square errs by 3 u, its root by 2.5 u, the
    /// reciprocal and the product with it add 2 u. The multiplication here, and sums of a threshold and a bound, add 3 u.
    /// Where a vector is no unit vector (scalar/following_direction.hpp), its computed length is short by 4 u at most, and the
    /// product with it and sums of such thresholds add 5 u.
    FASTCCD_INLINE constexpr explicit SeparationParameters(double d = 0.0, double distance_tolerance = 0.0)
        : distance{d}, tolerance{distance_tolerance}, threshold{d * (1.0 + 0x1p-49)}, stop{d + d * tolerance},
          aim{d + d * (0.5 * tolerance)}, certain{d * (1.0 - 0x1p-49)}
    {
    }

    /// A pair is also reported where its computed distance exceeds d by this times X + Y + Z, so that no search goes on
    /// where rounding decides.
    static constexpr double resolution = 128 * ErrorBounds::u;
};

/// What the certificates of farther_certificates.hpp compare with in one precision; see SeparationBounds::certificates().
struct FartherBounds {
    double distance;           ///< d, rounded up.
    double gap, gap_floor;     ///< Of a gap along an axis: the first one times its extent.
    double volume_on_whole;    ///< Of 3 times a coefficient of the cubic; times V.
    double normal;             ///< Of a component of n; times the largest product of two extents, sqrt(3) included.
    CertificateBounds halves;  ///< Of 12 times a coefficient of the cubic and 4 times one of an edge function.
    double smallest_extent, largest_extent;  ///< For single precision, as in ScreeningBounds.
};

struct SeparationBounds {
    static constexpr double u = ErrorBounds::u;
    static constexpr double slack = 2.0;

    FASTCCD_INLINE explicit constexpr SeparationBounds(double rho_) : rho{rho_} {}

    double rho;

    /// A height n . r_i at an end, or, edge-edge, the difference of two; times S. A product with a component errs by
    /// (rho + 1) u, the two sums by 2 u more: rho + 3. A difference of two doubles that and rounds, by u 2 S: 2 rho + 8.
    [[nodiscard]] FASTCCD_INLINE constexpr double height(PairKind kind) const
    {
        return ((kind == PairKind::vertex_face ? rho + 3 : 2 * rho + 8) + slack) * u;
    }

    /// The same at a time in between, where components are interpolated (rho + 3): rho + 6 and 2 rho + 14. For the sum of
    /// two, of n at one time and r at another, times S + S': the rounding of the sum adds 1, or 2 for differences.
    [[nodiscard]] FASTCCD_INLINE constexpr double height_at(PairKind kind) const
    {
        return ((kind == PairKind::vertex_face ? rho + 7 : 2 * rho + 16) + slack) * u;
    }

    /// A coefficient of a height n(s) . r_i(s), n of degree 3 and taken as exact (scalar/following_direction.hpp); times the same
    /// coefficient of S(s). A product as in height_at: rho + 6; three times it, and the sum of two: rho + 8. Differences: 2 rho + 18.
    [[nodiscard]] FASTCCD_INLINE constexpr double height_following(PairKind kind) const
    {
        return ((kind == PairKind::vertex_face ? rho + 8 : 2 * rho + 18) + slack) * u;
    }

    /// A gap along a coordinate axis at an end; times the extent along it. Two components, and their difference: 2 rho + 2.
    [[nodiscard]] FASTCCD_INLINE constexpr double axis() const { return (2 * rho + 2 + slack) * u; }

    /// The length of a computed vector between two points, one of each primitive, over the distance of the primitives;
    /// times X + Y + Z. Interpolated components err by rho + 3. Edge-edge, r2 + t (r3 - r2) - s r1: a side by
    /// 2 (rho + 3) + 2, its multiple by 2 more, the sums by 3 and 4, the multiple of r1 by rho + 4:
    /// (rho + 3) + (2 rho + 10) + (rho + 4) + 7 = 4 rho + 24. A point on a side of a face takes less; one inside, the
    /// mean of the corners with weights whose sum is within 4 u of 1: (rho + 3) + 4 + 4. The length errs by 3 u more of
    /// at most 3 (X + Y + Z): + 9.
    [[nodiscard]] FASTCCD_INLINE constexpr double distance() const { return (4 * rho + 33 + slack) * u; }

    /// How much more than d a gap at some time is to be for reach() to be certified from there on, for more than 2^-50 of the time, surely; times
    /// the sum of the extents. height() of the threshold, and once more for heights at both ends: 4 rho + 20. The end of a reach is where a height's
    /// excess at one end, at most 2 S, has come to zero, and errs by 2^-50 and 4 u, 12 u of the time, with the 2^-50 after it 20 u: 40. The gap, of
    /// positions that err by rho + 3, of differences by twice that, and of sums and products, by 2 (rho + 3) + 12: 6 rho + 78, 138 with rho <= 10.
    [[nodiscard]] static constexpr double surely_certified() { return 160 * u; }

    /// A pair also counts as close where a gap above d by no more than this is all that is shown: features have been asked then
    /// (feature_directions.hpp), or the computed distance is within surely_certified(). A choice below that: the more, the fewer looks at
    /// edges that glide along one line (bench/LIMITS_SEARCH.md).
    [[nodiscard]] static constexpr double close_gap() { return 96 * u; }

    /// How far a pair may be beyond d, or (1 + tolerance) d, at the time at which a search ends, but for a cap on looks; times the sum S of the
    /// extents. With 8 more where t_max != 1, as SearchParameters::time is early by 4 u of the step, in which components move by 8 u of their
    /// extents; and with what thresholds exceed d by, 16 u of it or, `stop`, 2 u, of S at most: the first points of both are not farther
    /// apart than S, so with a greater d the pair is within it all along. One of these:
    /// - Its computed distance is within the resolution, 128 u, and errs by distance(), 75 u: with 2 and 8, 213.
    /// - It is within surely_certified(), 160 u, so that features need not be asked. Lengths there are S at most, not 3 S, and 3 u
    ///   of that are 6 less: with 16 and 8, 253.
    /// - Features show its distance but for 64 (feature_directions.hpp), for computed positions, of r_i or of differences of two, which err by
    ///   2 (rho + 3), as does a height for these: 4 rho + 12. What they show is a gap within close_gap(): 96 + 64 + 52, with 16 and 8 236.
    /// - It is not certified at the time, or not for 2^-50 of it, so the exact height is at most the threshold and height() twice, 4 rho + 20,
    ///   and 40, as above: 8 rho + 136, with 16 and 8 240.
    [[nodiscard]] static constexpr double beyond() { return 256 * u; }

    // ---- Certificates of contact, with room for d (farther_certificates.hpp) ------------------------
    //
    // V and areas as in error_bound.hpp, whose bounds of coefficients are continued here. What d adds to a bound is d times a sum of extents,
    // which err by rho <= 10, or a length with a bound of its own, and three more roundings: `threshold`, 16 u of d above it, covers them.

    /// Halves: with all coefficients at the same multiple, 12 of the cubic's and 4 of edge functions', whose smaller ones are doubled
    /// exactly. 12 f0 errs by 12 (18 rho + 28) + 72, its size, and twice 3 f0 + 3 f1 by 216 rho + 504; 8 times the value in the middle is f0 + f3,
    /// 36 rho + 68, and 3 f1 + 3 f2, 108 rho + 264, with a sum of size 48; 3/2 of that 216 rho + 570, and 72 for the product: 216 rho + 642, the
    /// largest. Edge functions as in ErrorBounds::halves(). Nothing else has to come to the same conclusion, so no margin is added.
    ///
    /// On the whole, 3 f0 errs by 3 (18 rho + 28) + 18, 3 f1 by 54 rho + 114. What is concluded there is to be concluded on halves, too, whose
    /// exact coefficients are means of those on the whole: a quarter of twice the bound there is added, 108 rho + 321, and slack.
    ///
    /// A component of n is a sum of at most three cross products: an end coefficient errs by 12 rho + 22, half of the doubled middle one by
    /// (24 rho + 56) / 2, as in ErrorBounds::quadratic_sum(). |n| is at most sqrt(3) times its largest component: 21 rho + 49.
    [[nodiscard]] FASTCCD_INLINE constexpr FartherBounds certificates(const SeparationParameters& wanted) const
    {
        return {wanted.threshold,
                axis(),
                separation_floor,
                (162 * rho + 435 + 2 * slack) * u,
                (21 * rho + 49 + slack) * u,
                {(216 * rho + 642 + slack) * u, (16 * rho + 36 + slack) * u, (48 * rho + 148 + slack) * u, 0.0},
                smallest_separation_extent,
                largest_separation_extent};
    }

    /// 3 times a coefficient of f between two times (farther_between()), times V. Components there err by rho' = rho + 3, a side, of size 2,
    /// by 2 rho' + 2, a product of two by 8 rho' + 12, and of the vector product of two sides an end coefficient, of size 8, by 16 rho' + 32,
    /// the doubled middle one by 32 rho' + 80. n . r3: 72 rho' + 160 and 3 (48 rho' + 96) + 80, with sums of sizes 16, 24 and 32, 48; 3 f1 is
    /// the sum of both, of size 72: 216 rho' + 600, and 3 f0 errs by 216 rho' + 552. Of edges, r1 is no difference: less.
    [[nodiscard]] FASTCCD_INLINE constexpr double volume_between() const { return (216 * (rho + 3) + 600 + slack) * u; }
    /// 3 |n_0| or |n_0| + 2 |n_1| there; times the largest product of two extents: sqrt(3) times what components err by, above.
    [[nodiscard]] FASTCCD_INLINE constexpr double normal_between() const { return (84 * (rho + 3) + 195 + slack) * u; }

    /// certificates() in single precision, by which nothing is concluded that is not in double. As in ErrorBounds::screening_in_single(),
    /// rho = 1, and the slack, 2^30 u, covers the bounds above and what computed coefficients err by there, twice each. d is 16 single_u
    /// above what it is in double, by which what it adds is more. Where d is below 2^-126 it is off by 2^-150, and what it adds by some 2^-145
    /// of areas or lengths, or by some 2^-145 itself where that underflows: slack times V is 2^-63 of each area and 2^-143 at least, as extents
    /// of areas and volumes are 2^-40 at least, with edge functions and lengths alike, and gaps have their floor.
    [[nodiscard]] FASTCCD_INLINE constexpr FartherBounds certificates_in_single(const SeparationParameters& wanted) const
    {
        constexpr double single_u = ErrorBounds::single_u;
        // No pair of its range is as far apart as 2^100, which can be converted; what products with it overflow to, nothing exceeds.
        return {(wanted.threshold < 0x1p100 ? wanted.threshold : 0x1p100) * (1.0 + 0x1p-20),
                (2 + 2 + slack) * single_u,
                0x1p-100,
                (54 + 114 + slack) * single_u,
                (21 + 49 + slack) * single_u,
                {(216 + 642 + slack) * single_u, (16 + 36 + slack) * single_u, (48 + 148 + slack) * single_u, 0.0},
                smallest_single_extent,
                largest_single_extent};
    }
};

}  // namespace fastccd
