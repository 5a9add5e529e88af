// What a leaf holds in which contact is not proven: contact at the very side or end of a primitive, of edges that stay parallel, of pairs
// that stay in one plane, or next to the end of a leaf, as of meshes whose vertices lie on the same grid, or in scenes of two dimensions;
// and near misses.
//
// Certificates may lead through such a leaf, each from the end of the last one. Or they end, and where the pair meets right after that, as
// far as rounding can tell, no part that contains this time has one of the three certificates (nor eq. 7, but for rounding): halved down to
// the spacing of doubles, the leaf would still be reported, and if the shape does not amplify rounding, or directions show no distance either
// (no_distance.hpp), hardly any other search would clear it. So it is reported at once, by the search and, with the same bits, by lanes; with
// the end of the certificates as lower bound.
// All this is asked of the leaf's own polynomials (restriction.hpp): their rounding is so small that hardly any pair is neither cleared nor
// found to meet.
#pragma once

#include <last_certificate.hpp>
#include <no_distance.hpp>
#include <restriction.hpp>
#include <search_parameters.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// A time of a leaf to look at, and one not after it, until when the pair is apart in the leaf, or its start; guesses both, in shares of
/// it. Expected: what lies between them, mostly what rounding hides, is less than half of the leaf.
template <class L>
struct LikelyTouch {
    L time, before;
    LaneMask<L> expected;
};

template <class L>
FASTCCD_INLINE LikelyTouch<L> likely_touch(L time, L before)
{
    const L zero = broadcast<L>(0.0), within = max(before, zero);
    return {time, within, less_equal(zero, time) & less_equal(time, broadcast<L>(1.0)) & less(time - within, broadcast<L>(0.5))};
}

/// At the zero of the cubic, if that is beyond its bound at the start, by its chord and two corrections.
template <class L>
FASTCCD_INLINE LikelyTouch<L> touch_by_cubic(const PolynomialsOf<L>& leaf)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0), slope = leaf.cubic[0] - leaf.cubic[3];
    L time = max(min(leaf.cubic[0] / slope, one), zero);
    for (int k = 0; k < 2; ++k) time = max(min(time + coplanarity_on(leaf, time, time).c0 / slope, one), zero);
    LikelyTouch<L> likely = likely_touch(time, time - broadcast<L>(4.0) * leaf.cubic_bound / abs(slope));
    likely.expected = likely.expected & less(leaf.cubic_bound, abs(leaf.cubic[0]));
    return likely;
}

/// Until when certificates hold in a leaf, each from the end of the last one: 1 if throughout.
template <class L>
struct CertifiedUntil {
    L end, last_start;  ///< last_start: of the last one of them.
};

/// How many are followed.
inline constexpr int most_certificates_in_leaf = 6;
/// Where a certificate still holds, however its values are rounded, and where it does not any more.
inline constexpr CertificateLevel still_certain{1.0, 1.0}, just_lost{1.0, -1.5};

/// Of the lanes in `asked`.
template <PairKind kind, class L>
FASTCCD_INLINE CertifiedUntil<L> certified_until(const PolynomialsOf<L>& leaf, LaneMask<L> asked)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    CertifiedUntil<L> found{zero, zero};
    LaneMask<L> open = asked;
    for (int k = 0; k < most_certificates_in_leaf; ++k) {
        const L end = last_certificate<kind>(leaf, found.end, one, still_certain, open);
        open = open & less(found.end, end);
        if (Lane<L>::bits(open) == 0) break;
        open = open & apart_on<kind>(leaf, found.end, end);
        found = {select<L>(open, end, found.end), select<L>(open, found.end, found.last_start)};
        open = open & less(end, one);
    }
    return found;
}

/// Right after the last certificate, whether what it is of goes on to zero or not: as between surfaces that glide along one another with less
/// between them than rounding hides.
template <PairKind kind, class L>
FASTCCD_INLINE LikelyTouch<L> touch_by_certificates(const PolynomialsOf<L>& leaf, const CertifiedUntil<L>& until, LaneMask<L> asked)
{
    const L one = broadcast<L>(1.0);
    return likely_touch(max(last_certificate<kind>(leaf, until.last_start, one, just_lost, asked), until.end), until.end);
}

/// Contact for certain within a part: a strict change of sign, and strict inclusion throughout.
template <PairKind kind, template <class> class Part, class L>
FASTCCD_INLINE LaneMask<L> contact_proven_on(const PolynomialsOf<L>& pair, const Part<L>& part)
{
    const LaneMask<L> changes = changes_sign_on(pair, part);
    return Lane<L>::bits(changes) == 0 ? changes : changes & included_on<kind>(pair, part);
}

/// Within less of a time, rounding hides every change of sign; within more, inclusion rarely lasts.
inline constexpr double narrowest_proof = 0x1p-48, widest_proof = 0x1p-6;

/// Contact for certain in some interval around s.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> contact_proven_near(const PolynomialsOf<L>& pair, L s)
{
    LaneMask<L> proven = no_lanes<L>(), open = all_lanes<L>();
    for (double reach = narrowest_proof; reach <= widest_proof && Lane<L>::bits(open) != 0; reach *= 8) {
        const Between<L> around{max(s - broadcast<L>(reach), broadcast<L>(0.0)), min(s + broadcast<L>(reach), broadcast<L>(1.0))};
        open = open & included_on<kind>(pair, around);  // if not, nor, but for rounding, in anything wider
        if (Lane<L>::bits(open) == 0) break;
        const LaneMask<L> changes = changes_sign_on(pair, around);
        proven = proven | (open & changes);
        open = open & !changes;
    }
    return proven;
}

/// Of what is computed from the pair at one time: how much smaller lengths may be than the longest one, and areas than the largest one of
/// the step, for a pair that counts as well shaped. A choice, not a bound: who is well shaped is spared a look along a direction.
inline constexpr double least_share = 0x1p-5;

/// Whether the area of the face, or of the parallelogram of both edges, is no small part of the terms of edge functions, in some projection
/// at s: 2^49 times their bound, some 13 u (magnitudes.hpp; 31 u with t_max != 1), is as large as any at any time of the step. A height is
/// a volume over an area, so what is degenerate amplifies rounding by the reciprocal of that. With area, little: it is 1/39 of the terms m
/// of an edge function, or more. A volume that is all rounding, 23 u of three such m times an extent, is a height of 39 x 3 x 23 u, some
/// 2,700 u of the extents; an edge function that is, 13 u m, over the length of its edge another 39 x 13 u of them. In sum 3,200 u s (where
/// the m of the other projections are no larger), and README says 2^12; with t_max != 1 the share of m is 31/512, and 31 u and 50 u come to
/// 3,000 u s; hill climbing came to 2,707 u s, random pairs stay within 2^10
/// (nothing_invented_test.cpp). Parts of a leaf have 7.7 u and 5.2 u of its coefficients more in their bounds: what is next to zero in it
/// changes by w v times an area or length there, so that adds 39 x (3 x 7.7 + 5.2) u < 2^-42 of E_tol v, which README has beside.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> has_area_at(const PolynomialsOf<L>& pair, L s)
{
    const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
        // p + q + t is twice the area; of two edges, r1 x (r3 - r2) is t - p
        const auto& edges = pair.edges[axis];
        const L rest = broadcast<L>(1.0) - s;
        L area = broadcast<L>(0.0), bound = area;
        for (int edge = 0; edge < edge_function_count(kind); ++edge) {
            const auto& f = edges[edge];
            const L value = (rest * f.start + broadcast<L>(2.0) * s * f.middle) * rest + s * s * f.end;
            if (kind == PairKind::vertex_face || edge == 2) area = area + value;
            if (kind == PairKind::edge_edge && edge == 0) area = area - value;
            bound = max(bound, f.bound);
        }
        return less(broadcast<L>(0x1p49 * least_share) * bound, abs(area));
    };
    return along(0) | along(1) | along(2);
}

/// Whether two edges, neither much shorter than the pair is large, lie on one line at s, to within this share of what the bounds of edge functions
/// allow: an end's distance from the other edge's line is an area over a length, and the shortest length allows the area to be as large as its bound.
template <class L>
FASTCCD_INLINE LaneMask<L> are_in_line_at(const PairCoefficientsOf<L>& pair, L s, L share)
{
    const RelativeMotion<L> r = motion_of<L>(pair);
    const Vector3<L> r1 = position(r, 0, s), second = subtract(position(r, 2, s), position(r, 1, s));
    const L least = broadcast<L>(least_share) * pair.edge;
    const L shorter = min(max(abs(r1.x), abs(r1.y), abs(r1.z)), max(abs(second.x), abs(second.y), abs(second.z)));
    LaneMask<L> in_line = less(least, shorter);
    const L allowed = share * (shorter / least);
    for (const auto& edges : pair.edges) {
        if (Lane<L>::bits(in_line) == 0) return in_line;
        for (const auto& f : edges)
            in_line = in_line & less_equal(abs(on_interval(quadratic_of(f), s, s).c0), allowed * f.bound);
    }
    return in_line;
}

/// Whether a vertex of one is where a vertex of the other is, at s, to within this share of 8 bounds of gaps: whatever their shapes, they
/// are as close, some 8 x 12 u (8 x 30 u with t_max != 1) along each axis of its extent; with t_max = 1 that is within the 2^8 u of the sum
/// of extents beyond which distances along directions tell them apart (apart_until).
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> share_vertex_at(const PolynomialsOf<L>& pair, L s, L share)
{
    LaneMask<L> any = no_lanes<L>();
    for (int k = 0; k < gap_count(kind); ++k) {
        LaneMask<L> same = all_lanes<L>();
        for (int axis = 0; axis < 3; ++axis) {
            const auto& gap = pair.gaps[axis][k];
            same = same & less_equal(abs(lerp(gap.start, gap.end, s)), broadcast<L>(8.0) * share * gap.bound);
        }
        any = any | same;
    }
    return any;
}

/// Whether rounding is not amplified by the pair's shape, for a pair that meets at s. `share`: of their bounds, within which what is zero where
/// they share a vertex or lie in line is told from what is not.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> well_shaped_at(const PairCoefficientsOf<L>& pair, L s, L share)
{
    LaneMask<L> shaped = has_area_at<kind>(pair, s);
    if (Lane<L>::bits(!shaped) != 0) shaped = shaped | share_vertex_at<kind>(pair, s, share);
    if constexpr (kind == PairKind::edge_edge)
        if (Lane<L>::bits(!shaped) != 0) shaped = shaped | are_in_line_at(pair, s, share);
    return shaped;
}

/// Those of `asked`, pairs that meet at s as far as certificates tell, that do so for all that computed positions tell. If the shape amplifies
/// rounding, eq. 7 and directions may still tell: at s, and at `before`, from where a search along directions would go on.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> counts_as_contact_at(const PairCoefficientsOf<L>& pair, L s, L before, const ErrorBounds& bounds, LaneMask<L> asked)
{
    const LaneMask<L> shaped = asked & well_shaped_at<kind>(pair, s, broadcast<L>(1.0));
    LaneMask<L> thin = asked & !shaped;
    if (Lane<L>::bits(thin) != 0) thin = thin & !apart_by_area_on<kind>(pair, s, s);
    for (const L& time : {s, before})
        if (Lane<L>::bits(thin) != 0) thin = thin & no_distance_at<kind>(motion_of<L>(pair), time, bounds);
    return shaped | thin;
}

/// The same of pairs in contact at time 0 (in_contact_at_start). Their vertices are where they were given then, so what is zero may be asked to
/// be just that: distances along directions tell apart what is not.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> counts_as_contact_at_start(const PairCoefficientsOf<L>& pair, const ErrorBounds& bounds, LaneMask<L> asked)
{
    const L zero = broadcast<L>(0.0);
    const LaneMask<L> shaped = asked & well_shaped_at<kind>(pair, zero, zero), thin = asked & !shaped;
    return Lane<L>::bits(thin) == 0 ? shaped : shaped | (thin & no_distance_at<kind>(motion_of<L>(pair), zero, bounds));
}

/// The start of the interval of this width, one of those that the step is halved to, that holds `time`.
template <class L>
FASTCCD_INLINE L interval_start(L time, double width)
{
    // floor(time / w), by adding and subtracting 2^52 (exact for 0 <= time / w <= 2^50).
    const L scaled = time * broadcast<L>(1.0 / width);
    const L nearest = (scaled + broadcast<L>(0x1p52)) - broadcast<L>(0x1p52);
    return select<L>(less(scaled, nearest), nearest - broadcast<L>(1.0), nearest) * broadcast<L>(width);
}

/// In narrower leaves too few pairs are told so for all to be looked at: what rounding hides is too large a part of them.
inline constexpr double narrowest_touched = 0x1p-44;

/// Whether a pair is in contact in a leaf for all that rounding can tell, though nothing proves it, and until less than
/// half of the leaf before that apart for certain, or before its start. Not where the lower bound would be time 0.
template <class L>
struct Touch {
    LaneMask<L> present, apart;  ///< Apart: for certain, throughout the leaf.
    L time, lower_bound;         ///< When the pair meets; and until when it is apart in the leaf. Times of the step.
    L likely;                    ///< Where neither: when contact is likely all the same, in shares of the leaf.
};

/// In `leaf`, which is `pair` over it (restriction.hpp); of the lanes in `asked`. Shapes and areas are told from the whole step.
template <PairKind kind, class L>
FASTCCD_INLINE Touch<L> touch_in(const PolynomialsOf<L>& leaf, const PairCoefficientsOf<L>& pair, const ErrorBounds& bounds, LaneMask<L> asked)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    Touch<L> found{no_lanes<L>(), no_lanes<L>(), leaf.origin, leaf.origin, zero};
    const auto look_at = [&](const LikelyTouch<L>& likely, bool is_apart_before) FASTCCD_INLINE_LAMBDA {
        const L time = time_in_step(leaf, likely.time), until = earlier_in_step(leaf, likely.before);
        LaneMask<L> present = asked & likely.expected & less(zero, until);
        if (Lane<L>::bits(present) != 0) present = present & meets_at<kind>(leaf, likely.time);
        if (Lane<L>::bits(present) != 0) present = counts_as_contact_at<kind>(pair, time, until, bounds, present);
        if (Lane<L>::bits(present) != 0) present = present & !apart_by_area_on<kind>(pair, leaf.origin, leaf.origin + leaf.duration);
        if (Lane<L>::bits(present) != 0 && !is_apart_before)
            present = present & (less_equal(likely.before, zero) | apart_on<kind>(leaf, zero, likely.before));
        found.present = found.present | present;
        found.time = select<L>(present, time, found.time);
        found.lower_bound = select<L>(present, until, found.lower_bound);
        asked = asked & !present;
    };
    if (Lane<L>::bits(asked) != 0) look_at(touch_by_cubic(leaf), false);
    if (Lane<L>::bits(asked) != 0) {
        const CertifiedUntil<L> until = certified_until<kind>(leaf, asked);
        found.apart = asked & less_equal(one, until.end);
        asked = asked & !found.apart;
        if (Lane<L>::bits(asked) == 0) return found;
        const LikelyTouch<L> likely = touch_by_certificates<kind>(leaf, until, asked);
        found.likely = likely.time;
        found.lower_bound = select<L>(asked, earlier_in_step(leaf, until.end), found.lower_bound);
        look_at(likely, true);
    }
    return found;
}

/// The cubic at time 0 is zero to within its bound.
template <class L>
FASTCCD_INLINE LaneMask<L> zero_at_start(const PolynomialsOf<L>& pair)
{
    return less_equal(abs(pair.cubic[0]), pair.cubic_bound);
}

/// Next to time 0 parts of a leaf are halved to this absolute width.
inline constexpr double finest_at_zero = 0x1p-100;

/// Whether a walk over intervals, earliest first, would come down to time 0 and stop there, as for pairs that rest on one another: one look
/// instead of a hundred.
/// - Without eq. 7: certificates on [0, b] need strict signs at 0, too, and coefficients on [0, b] begin with the very values
///   at 0. Without one at 0 there is none on any [0, b].
/// - Eq. 7: between two centres the areas change by at most change(distance) (area_inclusion.hpp), and change(d) + change(e) <=
///   change(d + e). If it fails on the finest part, it fails on every wider one, but for rounding; the first leaf is asked for all the same.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> in_contact_at_start(const PairCoefficientsOf<L>& pair, L leaf_width)
{
    const L zero = broadcast<L>(0.0);
    LaneMask<L> present = zero_at_start(pair);  // as for few
    if (Lane<L>::bits(present) != 0) present = present & !apart_on<kind>(pair, zero, zero);
    const L ends[] = {zero, broadcast<L>(finest_at_zero), leaf_width};
    for (const L& end : ends)
        if (Lane<L>::bits(present) != 0) present = present & !apart_by_area_on<kind>(pair, zero, end);
    return present;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
