// The rounding error bounds of cubic, edge functions and areas, derived, in multiples of u = 2^-53. Those of distances are in separation_bound.hpp
// and feature_directions.hpp, of looks at one time in meeting.hpp, of parts of the interval in restriction.hpp, of extents in magnitudes.hpp.
//
// Notation. X, Y, Z: the extents of the pair (relative_motion.hpp), V = X Y Z. A computed
// component of r_i differs from the exact one by at most rho u X (Y, Z): rho = 1 where r_i is one
// rounded difference (t_max = 1). For t_max != 1, r_i(t_max) = (1-t) p + t q with t = t_max and
// p, q rounded differences; |(1-t) p| <= X and |t q| <= |r_i(t_max)| + |(1-t) p| <= 2 X, so the
// error is at most u (4 |(1-t) p| + 3 |t q|) <= 10 u X, that is 1 + 1 + 1 + 1 roundings on the
// first term (1-t, p, product, sum) and 3 on the second: rho = 10.
//
// First-order terms are added up below; terms in u^2 and the rounding of the bounds themselves (a
// few products, each u) are covered by `slack`, which is added to each constant: every constant is
// below 2^14, so u^2 terms are below 2^-39 of it, and 3 products round by 3u < 2^-51.
#pragma once

#include <cfloat>

#include <lane.hpp>

// Each operation is rounded to its own type: as with SSE2 and NEON, and not in registers of x87.
static_assert(FLT_EVAL_METHOD == 0, "compile with -msse2 -mfpmath=sse");

namespace fastccd {

/// What the three certificates compare with; see the functions of the same names in ErrorBounds. Evaluated once
/// per tile rather than in every batch. On halves nothing asks for `linear`, which is 0 there.
struct CertificateBounds {
    double cubic, quadratic, quadratic_sum, linear;
};

/// Pairs whose coordinates differ by more along an axis are scaled down by the certified search (scalar/scaling.hpp).
inline constexpr double largest_extent = 0x1p100;

/// The same for what lanes of single precision decide: 72 V, the largest value on halves, does not overflow there.
inline constexpr double smallest_single_extent = 0x1p-30, largest_single_extent = 0x1p40;

/// What screening compares with in one precision: certificates on the whole interval, on both halves, and on a part at its start; and
/// between which limits the largest extent of a pair is to be.
struct ScreeningBounds {
    CertificateBounds whole, halves, part;
    double smallest_extent, largest_extent;
};

/// Bounds of one call; they depend on t_max alone. All are factors that multiply u times a product
/// of extents, u included: |computed - exact| <= bound * product.
struct ErrorBounds {
    static constexpr double u = 0x1p-53;
    static constexpr double slack = 2.0;

    FASTCCD_INLINE explicit constexpr ErrorBounds(double t_max)
        : rho{t_max == 1.0 ? 1.0 : 10.0}, largest_lane_extent{t_max == 1.0 ? largest_extent : 0.25 * largest_extent * t_max}
    {
    }

    /// Error of a component of r_i at an end of the interval, in units of u X.
    double rho;

    /// Pairs with larger extents are left to the certified search. It scales pairs down whose coordinates differ by more than
    /// largest_extent, and a gap that underflows then is no gap for it, while lanes would see it. The differences p and q
    /// at both ends of the step are to be below: with t_max != 1 extents E bound p and r(t_max) = (1 - t_max) p + t_max q, so
    /// |q| <= 2 E / t_max; a quarter of it covers roundings. So with t_max below 2^-98 of their size no pairs are left to lanes.
    double largest_lane_extent;

    // ---- Bernstein coefficients over the whole interval -----------------------------------------

    /// Coefficients of a component of r_i x r_j, the middle one doubled; times Y Z.
    /// A product of two components errs by (2 rho + 1) u Y Z. An end coefficient is a difference of
    /// two: 2 (2 rho + 1) + 2 = 4 rho + 4, and is at most 2 Y Z. The doubled middle one has four
    /// products, two differences of size 2 and one sum of size 4:
    /// 4 (2 rho + 1) + 2 + 2 + 4 = 8 rho + 12, and is at most 4 Y Z.
    [[nodiscard]] FASTCCD_INLINE constexpr double quadratic() const { return (8 * rho + 12 + slack) * u; }

    /// The same for (q - t) + p of three cross products (the fourth edge function of an edge-edge
    /// pair): 3 (8 rho + 12), and sums of size 8 and 12.
    [[nodiscard]] FASTCCD_INLINE constexpr double quadratic_sum() const { return (24 * rho + 56 + slack) * u; }

    /// Coefficients f0, 3 f1, 3 f2, f3 of the coplanarity cubic; times V.
    /// f0 = q . c: each of three terms errs by (4 rho + 4) + 2 rho + 2, is at most 2 V; sums of size
    /// 4 and 6: 18 rho + 28, |f0| <= 6 V. 3 f1: terms with the doubled middle coefficient err by
    /// (8 rho + 12) + 4 rho + 4, sums of size 8 and 12; plus the terms as in f0; plus a sum of size
    /// 18: 3 (12 rho + 16) + 20 + 18 rho + 28 + 18 = 54 rho + 114, |3 f1| <= 18 V. The larger one serves both.
    [[nodiscard]] FASTCCD_INLINE constexpr double cubic() const { return (54 * rho + 114 + slack) * u; }

    /// A coordinate difference of two points of the pair at an end of the interval; times X.
    /// With t_max = 1 rounding is monotone: the computed difference has the exact sign (or is zero),
    /// so any positive value is a proof and the bound is 0. Otherwise 2 rho, plus u 2 X for the
    /// difference of two computed values.
    [[nodiscard]] FASTCCD_INLINE constexpr double linear() const { return rho == 1.0 ? 0.0 : (2 * rho + 2 + slack) * u; }

    // ---- Values and coefficients over part of the interval (blossoms, bernstein.hpp) ------------

    // One lerp errs by 3 u M, M the larger magnitude of its operands (1-s, product, sum; and product,
    // sum), so n levels on coefficients of size M add 3 n u M. (By 2.5 u M at most, as meeting.hpp counts it.)

    /// Blossom levels of the cubic: 3 levels, |f_k| <= 6 V.
    static constexpr double cubic_blossom_levels = 54.0;
    /// Blossom levels of a cross product: 2 levels, size 2 Y Z.
    static constexpr double quadratic_blossom_levels = 12.0;

    /// Bernstein coefficients of f on [a, b]; times V. f1 is (54 rho + 114) / 3 and the
    /// multiplication by the rounded 1/3 (2 u of 6 V): 18 rho + 38 + 12, then the blossom.
    [[nodiscard]] FASTCCD_INLINE constexpr double cubic_on_interval() const
    {
        return (18 * rho + 50 + cubic_blossom_levels + slack) * u;
    }
    /// Times Y Z: (8 rho + 12) / 2, then the blossom. End coefficients (4 rho + 4) are smaller.
    [[nodiscard]] FASTCCD_INLINE constexpr double quadratic_on_interval() const
    {
        return (4 * rho + 6 + quadratic_blossom_levels + slack) * u;
    }
    /// Difference of two coordinates at a time; times X: each errs by rho + 3, and the difference by 2. Where differences at both ends, which
    /// err by 2 rho + 2 and are at most 2 X in size, are interpolated instead, the same: a lerp adds 6.
    [[nodiscard]] FASTCCD_INLINE constexpr double linear_on_interval() const { return (2 * rho + 8 + slack) * u; }

    // ---- Margins with which lanes decide (CONTRIBUTING, What decides a result) -----------

    // A hull certificate found by lanes on [a, b] with these bounds implies that the certified search
    // finds it on every [a', b'] inside [a, b]: exact coefficients on a part are convex combinations
    // of those on the whole, and each of the two computations errs by at most the blossom levels.

    /// Times V.
    [[nodiscard]] FASTCCD_INLINE constexpr double cubic_on_interval_lanes() const
    {
        return cubic_on_interval() + (2 * cubic_blossom_levels + slack) * u;
    }

    /// Bounds for certificates on a part [a, b] alone (earliest contact, quarters), by which lanes may conclude that the certified
    /// search finds every interval in [a, b] apart. The ends of the motion are interpolated: their components err by rho + 3
    /// times u X where X bounds both ends of the whole motion. Added is what the search's coefficients err by and its bound, together
    /// twice its bound; for the sum of three cross products the search's bound refers to at most four times the area. A gap
    /// errs by linear_on_interval() in the lanes as it does in the search; with the search's bound, which is that too, three times.
    [[nodiscard]] FASTCCD_INLINE constexpr CertificateBounds on_part() const
    {
        const double end_rho = rho + 3;
        // Coefficients 3 f1 and the doubled middle ones are compared, so the search's share counts 3 and 2 times.
        return {(54 * end_rho + 114 + slack) * u + 3 * 2 * cubic_on_interval(),
                (8 * end_rho + 12 + slack) * u + 2 * 2 * quadratic_on_interval(),
                (24 * end_rho + 56 + slack) * u + 2 * 2 * 4 * quadratic_on_interval(), 3 * linear_on_interval()};
    }

    /// Bounds for certificates on both halves of the interval (halves_certificate.hpp), each for the largest multiple of
    /// a coefficient there and so more than enough for the others. Added, as in on_part(), is twice the search's bound.
    /// Quadratic: twice an inner coefficient errs by (4 rho + 4) + (8 rho + 12) / 2 + 4, its size; 4 times the value in
    /// the middle is a sum of two such, of size 8: 16 rho + 36. Sum of three: (12 rho + 22) + (24 rho + 56) / 2 + 12, and
    /// 48 rho + 148. Cubic: 3 f0 errs by 3 (18 rho + 28) + 18, 3 f0 + 3 f1 by 108 rho + 252, 3 f1 + 3 f2 by
    /// 108 rho + 264 (sizes 36), their sum, of size 72, by 216 rho + 588; the value in the middle by less.
    [[nodiscard]] FASTCCD_INLINE constexpr CertificateBounds halves() const
    {
        return {(216 * rho + 588 + slack) * u + 12 * (2 * cubic_on_interval()),
                (16 * rho + 36 + slack) * u + 4 * (2 * quadratic_on_interval()),
                (48 * rho + 148 + slack) * u + 4 * (2 * 4 * quadratic_on_interval()), 0.0};
    }

    /// The bounds of the certificates on the whole interval.
    [[nodiscard]] FASTCCD_INLINE constexpr CertificateBounds certificates() const
    {
        return {cubic(), quadratic(), quadratic_sum(), linear()};
    }

    /// For screening in the precision of all else.
    [[nodiscard]] FASTCCD_INLINE constexpr ScreeningBounds screening() const
    {
        return {certificates(), halves(), on_part(), 0.0, largest_lane_extent};
    }

    /// Of single precision.
    static constexpr double single_u = 0x1p-24;

    /// For screening in single precision, by the same text. Components of r_i are those of double precision, rounded once more: rho
    /// = 1 in units of single_u. What is left of the bounds above is what computing adds, and the slack, 2 single_u: that is 2^30 u, and
    /// covers all that is counted there in multiples of u, below 2^14 in each bound (the error of the r_i before they are rounded,
    /// the search's coefficients and bounds, by which "apart" here is "apart" there), with terms in single_u^2, below
    /// 2^10 single_u of the constants, some twenty deep. Rounding is monotone here too: t_max = 1 leaves 0 for gaps.
    [[nodiscard]] FASTCCD_INLINE constexpr ScreeningBounds screening_in_single() const
    {
        constexpr double end_rho = 1.0 + 3.0;  // as in on_part()
        const double gap = rho == 1.0 ? 0.0 : (2 + 2 + slack) * single_u;
        return {{(54 + 114 + slack) * single_u, (8 + 12 + slack) * single_u, (24 + 56 + slack) * single_u, gap},
                {(216 + 588 + slack) * single_u, (16 + 36 + slack) * single_u, (48 + 148 + slack) * single_u, 0.0},
                {(54 * end_rho + 114 + slack) * single_u, (8 * end_rho + 12 + slack) * single_u, (24 * end_rho + 56 + slack) * single_u,
                 (2 * end_rho + 2 + slack) * single_u},
                smallest_single_extent, largest_lane_extent < largest_single_extent ? largest_lane_extent : largest_single_extent};
    }

    // ---- Edge functions at one time and over its neighbourhood (projected_inclusion.hpp) ----------

    /// A component of r_i(s) x r_j(s) from lerped vectors; times Y Z. Lerped components err by
    /// rho + 3, products by 2 (rho + 3) + 1, the difference adds 2: 4 rho + 16. The margin for the
    /// certified search is twice its own bound, so that the exact value, the search's coefficients and
    /// the search's threshold are all on the same side: + 2 (4 rho + 18 + slack).
    [[nodiscard]] FASTCCD_INLINE constexpr double edge_function() const
    {
        return (4 * rho + 16 + 2 * (4 * rho + 18 + slack) + slack) * u;
    }
    /// (q - t) + p of three such; sums of size 4 and 6. The certified search has a cross product of vectors
    /// relative to x1 instead, whose extents are at most twice as large: margin + 2 * 4 (4 rho + 18 + slack).
    [[nodiscard]] FASTCCD_INLINE constexpr double edge_function_sum() const
    {
        return (12 * rho + 58 + 8 * (4 * rho + 18 + slack) + slack) * u;
    }

    // ---- Monotone pieces (sign_change.hpp) --------------------------------------------------------

    // B = max |f_k| of the computed coefficients; f^ is the cubic that has exactly these. g = f^' / 3
    // has the Bernstein coefficients d_k = f_(k+1) - f_k, each <= 2 B, computed within 2 u B.
    // Power basis: C = d0 (2 u B); h = d1 - d0 (2 + 2 + 4 = 8 u B, |h| <= 4 B);
    // A = (d0 + d2) - 2 d1 (8 u B from the d_k, sums of size 4 and 8: 20 u B, |A| <= 8 B).
    //
    // (1) The roots computed from A, h, C are exact roots of a quadratic near A t^2 + 2 h t + C:
    // D = h^2 - A C is computed within u (h^2 + |A C| + |D|). If the computed D is negative, then
    // A C > 0 and exact D <= 4 u |A C|, so changing C by 4 u |C| <= 8 u B leaves no real root. Otherwise
    // q = -(h + sign(h) sqrt D) carries a relative error kappa <= 2 u, and
    //     E = q^2 + 2 h q + A C = (D^ - D) + 2 kappa q^2 + 2 kappa h q,   |E| <= 12 u q^2,
    // as h^2, D and |A C| are each at most q^2 up to O(u). x1 = q / A and x2 = C / q (one rounding each)
    // have product C / A (1 + 2u) and sum -2 h / A up to (|E / q| + u |q| + u |A C / q|) / |A|, so they
    // are the exact roots of a quadratic with the same A, C changed by 2 u |C| <= 4 u B, and 2 h changed
    // by 14 u |q| <= 136 u B since |q| <= |h| + sqrt(h^2 + |A C|) <= 9.7 B.
    // In sum: g differs from a quadratic with exactly the computed roots by
    // (2 + 2 * 8 + 20) + (136 + 4) = 178 u B on [0, 1].
    // (2) Integrated (f^' = 3 g): f^ differs by at most 3 * 178 = 534 u B on [0, 1] from a cubic f~ that is
    // exactly monotone between the computed roots. Splitting a monotone piece once more is harmless, so
    // any value may stand for a root that does not exist.
    static constexpr double monotone_shift = 536.0;
    // (3) Horner's rule in the power basis f0, 3 C, 3 h, A: coefficient errors 12 + 36 + 20 = 68 u B,
    // roundings 8 + 20 + 20 + 26 + 26 + 27 = 127 u B.
    static constexpr double power_basis_value = 196.0;

    /// If f^, evaluated by Horner's rule, is beyond this times B on the same side at both ends of a
    /// piece, f^ has no root in the piece: at both ends f^ exceeds this less the error of the evaluation, so f~ exceeds
    /// that less one shift; f~ is monotone, so it does so in between, and f^ exceeds it less a second shift.
    [[nodiscard]] FASTCCD_INLINE static constexpr double monotone_piece() { return (2 * monotone_shift + power_basis_value + slack) * u; }

    /// On an interval of width w inside a piece, inner Bernstein coefficients of f^ differ from the
    /// chord by at most the local second differences, w^2 |f_k - 2 f_(k+1) + f_(k+2)| <= 4 B w^2.
    static constexpr double hull_deviation = 4.0;

    // ---- Area inclusion (area_inclusion.hpp) ------------------------------------------------------

    /// Sum of four doubled areas with signs; times N = X Y + Y Z + Z X. A component of a cross product
    /// errs by 4 rho + 16 (as edge_function), of the sum of three by 12 rho + 58. Norms are at most
    /// 2 N and 6 N; a norm errs by the components' errors plus 4 u of its size (squares, sums, root).
    /// Three single ones: 3 (4 rho + 16 + 8); the sum: 12 rho + 58 + 24; three additions of size at most
    /// 12 N: 36. Vertex-face and edge-edge alike: 24 rho + 190.
    /// rho is in there once already, as the difference of the computed r_i from the exact ones, at contact: points off by
    /// e u X move a component of a cross product by 4 e u Y Z, six times over (the sum counts three), 24 e in all; e = rho.
    /// The lemma is applied to r_i(c) + (s - c) v_i, v_i the computed velocity, of which C2 is a bound. It is rounded, by u
    /// times at most 2 X, so that at the time s of contact this motion is off by e = 2: 48 more. Its edges at c are those of
    /// r_i. And an interval as narrow as the spacing of doubles has no double in its middle: c is off by u / 2, within which
    /// points move by u X, e = 1: 24 more.
    [[nodiscard]] FASTCCD_INLINE constexpr double area() const { return (24 * rho + 262 + slack) * u; }
};

/// Absolute floor under extents, against what underflows; areas are 2^-532 and volumes 2^-798 at least, then. Lanes take pairs
/// whose coordinates differ by less than largest_extent. A product of two components that underflows errs by at most 2^-1075;
/// times a third component, below 2^100, that is less than 2^-975, some twenty times over: far below u 2^-798. Interpolated
/// components err by a few 2^-1074: far below u 2^-266. Pairs that the floor matters to are hardly ever certified by the lanes
/// and go to the scalar path, which scales axes by powers of two.
inline constexpr double length_floor = 0x1p-266;
/// The same for lanes of single precision, which screen pairs whose largest extent is between 2^-30 and 2^40. Areas are 2^-80 and volumes
/// 2^-120 at least. A product of two components that underflows errs by at most 2^-150, far below single_u 2^-80, and that times the third
/// component Z by 2^-150 Z, some thousand times over: far below single_u 2^-80 Z. Bounds of volumes, 2^-137 at least, are rounded by 2^-150.
/// Components below 2^-126 err by 2^-150 where they are rounded to single precision, and by a few times that where they are interpolated: more than rho
/// single_u times an extent that is as small, but far below single_u 2^-40, which every bound has of it.
inline constexpr double single_length_floor = 0x1p-40;
[[nodiscard]] FASTCCD_INLINE constexpr double extent_floor(bool single) { return single ? single_length_floor : length_floor; }
/// Smallest V for which discriminants (degree 2 in V) cannot underflow.
inline constexpr double smallest_volume = 0x1p-300;

}  // namespace fastccd
