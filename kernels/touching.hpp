// Contact at the very side or end of a primitive, of edges that stay parallel, of pairs that stay in one plane, or next to the end of a leaf:
// as of meshes whose vertices lie on the same grid, or in scenes of two dimensions.
//
// There nothing proves contact within a leaf, and no part of it, however narrow, does. But where the pair meets, as far as rounding can tell,
// at some time of the leaf, no part that contains this time has one of the three certificates either (nor eq. 7, but for rounding): halved
// down to the spacing of doubles, the leaf would still be reported, and if the shape does not amplify rounding, hardly any other search
// would clear it either. So it is reported at once, by the search and, with the same bits, by lanes; with a lower bound as close to that time
// as a certificate on what is before it allows, or the leaf's start, if that is as close.
#pragma once

#include <last_certificate.hpp>
#include <search_parameters.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// A time of [a, b] to look at, and one not after it, until when the pair is apart on [a, b], or a; guesses both. Expected: what lies between
/// them, mostly what rounding hides, is less than half of [a, b].
template <class L>
struct LikelyTouch {
    L time, before;
    LaneMask<L> expected;
};

template <class L>
FASTCCD_INLINE LikelyTouch<L> likely_touch(L time, L before, L a, L b)
{
    const L within = max(before, a);
    return {time, within, less_equal(a, time) & less_equal(time, b) & less(time - within, broadcast<L>(0.5) * (b - a))};
}

/// At the zero of the cubic, if that is beyond its bound at a, by its chord and two corrections.
template <class L>
FASTCCD_INLINE LikelyTouch<L> touch_by_cubic(const PairCoefficientsOf<L>& pair, L a, L b)
{
    const Cubic<L> whole{pair.cubic[0], pair.cubic[1], pair.cubic[2], pair.cubic[3]}, f = on_interval(whole, a, b);
    const L slope = f.c0 - f.c3, width = b - a;
    L time = max(min(a + width * (f.c0 / slope), b), a);
    for (int k = 0; k < 2; ++k) time = max(min(time + width * (on_interval(whole, time, time).c0 / slope), b), a);
    LikelyTouch<L> likely = likely_touch(time, time - width * (broadcast<L>(4.0) * pair.cubic_bound / abs(slope)), a, b);
    likely.expected = likely.expected & less(pair.cubic_bound, abs(f.c0));
    return likely;
}

/// At an end of certificates on [a, b]: `end(room)` as last_certificate. Of the lanes in `asked`.
template <class L, class End>
FASTCCD_INLINE LikelyTouch<L> touch_at_end(End end, L a, L b, LaneMask<L> asked)
{
    const L time = end(broadcast<L>(0.0));
    const LaneMask<L> inside = asked & less(a, time) & less_equal(time, b);
    L before = a;  // where none holds at a
    if (Lane<L>::bits(inside) != 0) before = select<L>(inside, end(broadcast<L>(beyond_rounding)), a);
    return likely_touch(time, before, a, b);
}

/// When gaps end: told better than by the cubic for edges that are nearly parallel.
template <PairKind kind, class L>
FASTCCD_INLINE LikelyTouch<L> touch_by_gaps(const PairCoefficientsOf<L>& pair, L a, L b, LaneMask<L> asked)
{
    return touch_at_end([&](L room) FASTCCD_INLINE_LAMBDA { return last_gap<kind>(pair, a, b, room); }, a, b, asked);
}

/// When the last certificate ends, told better by edge functions for pairs that stay in one plane.
template <PairKind kind, class L>
FASTCCD_INLINE LikelyTouch<L> touch_by_certificates(const PairCoefficientsOf<L>& pair, L a, L b, LaneMask<L> asked)
{
    return touch_at_end([&](L room) FASTCCD_INLINE_LAMBDA { return last_certificate<kind>(pair, a, b, room); }, a, b, asked);
}

/// Where the last certificate is lost though nothing comes to zero, as between surfaces that glide along one another with less between them
/// than rounding hides: shares of [a, b] before and after it at which it very probably holds, and does not. A choice, but in sum they are to
/// be less than likely_touch expects.
inline constexpr double held_before_loss = 0x1p-4, lost_after_loss = 0x1p-2;
static_assert(held_before_loss + lost_after_loss < 0.5);
/// In narrower leaves, of which rounding may hide many in a row where thin shapes meet, asking takes longer than it spares: measured at 1e-12,
/// whose leaves have 2^-40 (bench/LIMITS.md), not at each width.
inline constexpr double narrowest_lost = 0x1p-36;

template <PairKind kind, class L>
FASTCCD_INLINE LikelyTouch<L> touch_by_loss(const PairCoefficientsOf<L>& pair, L a, L b)
{
    const L lost = last_certificate<kind>(pair, a, b, broadcast<L>(1.0)), width = b - a;
    return likely_touch(min(lost + broadcast<L>(lost_after_loss) * width, b), lost - broadcast<L>(held_before_loss) * width, a, b);
}

/// Contact for certain within [a, b]: a strict change of sign, and strict inclusion throughout.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> contact_proven_on(const PairCoefficientsOf<L>& pair, L a, L b)
{
    const LaneMask<L> changes = changes_sign_on(pair, a, b);
    return Lane<L>::bits(changes) == 0 ? changes : changes & included_on<kind>(pair, a, b);
}

/// Within less of a time, rounding hides every change of sign; within more, inclusion rarely lasts.
inline constexpr double narrowest_proof = 0x1p-48, widest_proof = 0x1p-6;

/// Contact for certain in some interval around s.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> contact_proven_near(const PairCoefficientsOf<L>& pair, L s)
{
    LaneMask<L> proven = less(s, s), open = !proven;
    for (double reach = narrowest_proof; reach <= widest_proof && Lane<L>::bits(open) != 0; reach *= 8) {
        const L a = max(s - broadcast<L>(reach), broadcast<L>(0.0)), b = min(s + broadcast<L>(reach), broadcast<L>(1.0));
        open = open & included_on<kind>(pair, a, b);  // if not, nor, but for rounding, in anything wider
        if (Lane<L>::bits(open) == 0) break;
        const LaneMask<L> changes = changes_sign_on(pair, a, b);
        proven = proven | (open & changes);
        open = open & !changes;
    }
    return proven;
}

/// Of what is computed from the pair at one time: how much smaller lengths may be than the longest one, and areas than the largest one of
/// the step, for a pair that counts as well shaped. A choice, not a bound: who is well shaped is spared a look.
inline constexpr double least_share = 0x1p-5;

/// Whether the area of the face, or of the parallelogram of both edges, is no small part of the terms of edge functions, in some
/// projection at s: 2^49 times their bound, some 13 u (magnitudes.hpp; 31 u with t_max != 1), is as large as any at any time of the step. A
/// height is a volume over an area, so what is degenerate amplifies rounding by the reciprocal of that. With area, little: it is 1/39 of
/// the terms m of an edge function, or more. A volume that is all rounding, 13 u of three such m times an extent, is a height of 39 x 3 x 13 u, some
/// 1,500 u of the extents; an edge function that is, 13 u m, over the length of its edge another 39 x 13 u of them. In sum 2^11 u s, and
/// README says 2^12; hill climbing came to 1,354 u s (nothing_invented_test.cpp).
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> has_area_at(const PairCoefficientsOf<L>& pair, L s)
{
    const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
        // p + q + t is twice the area; of two edges, r1 x (r3 - r2) is t - p
        const auto& edges = pair.edges[axis];
        const L rest = broadcast<L>(1.0) - s;
        L area = broadcast<L>(0.0), bound = area;
        for (int edge = 0; edge < (kind == PairKind::vertex_face ? 3 : 4); ++edge) {
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

/// Whether two edges, neither much shorter than the pair is large, lie on one line at s, to within this share of the bounds of edge functions:
/// an end's distance from the other edge's line is an area over a length.
template <class L>
FASTCCD_INLINE LaneMask<L> are_in_line_at(const PairCoefficientsOf<L>& pair, L s, L share)
{
    const RelativeMotion<L> r = motion_of<L>(pair);
    const Vector3<L> r1 = position(r, 0, s), second = subtract(position(r, 2, s), position(r, 1, s));
    const L least = broadcast<L>(least_share) * pair.edge;
    LaneMask<L> in_line = less(least, max(abs(r1.x), abs(r1.y), abs(r1.z))) & less(least, max(abs(second.x), abs(second.y), abs(second.z)));
    for (const auto& edges : pair.edges) {
        if (Lane<L>::bits(in_line) == 0) return in_line;
        for (const auto& f : edges)
            in_line = in_line & less_equal(abs(on_interval(Quadratic<L>{f.start, f.middle, f.end}, s, s).c0), share * f.bound);
    }
    return in_line;
}

/// Whether a vertex of one is where a vertex of the other is, at s, to within this share of the bound of gaps: whatever their shapes, they are
/// as close.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> share_vertex_at(const PairCoefficientsOf<L>& pair, L s, L share)
{
    const L zero = broadcast<L>(0.0);
    constexpr int vertices_of_first = kind == PairKind::vertex_face ? 1 : 2;
    LaneMask<L> any = less(zero, zero);
    for (int i = 0; i < vertices_of_first; ++i)
        for (int j = vertices_of_first - 1; j < 3; ++j) {
            LaneMask<L> same = less_equal(zero, zero);
            for (int axis = 0; axis < 3; ++axis) {
                const AxisMotion<L> first = i == 0 ? AxisMotion<L>{zero, zero} : AxisMotion<L>{pair.start[0][axis], pair.end[0][axis]};
                const AxisMotion<L> second{pair.start[j][axis], pair.end[j][axis]};
                same = same & less_equal(abs(second.at(s) - first.at(s)), share * pair.gap_bound[axis]);
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

/// Whether a pair in contact at time 0, as far as its certificates tell (in_contact_at_start), needs no other look. Its vertices are where they
/// were given then, so what is zero may be asked to be just that: distances along directions tell apart what is not.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> well_shaped_at_start(const PairCoefficientsOf<L>& pair)
{
    const L zero = broadcast<L>(0.0);
    return well_shaped_at<kind>(pair, zero, zero);
}

/// The start of the leaf that holds `time`.
template <class L>
FASTCCD_INLINE L leaf_start(L time, const SearchParameters& parameters)
{
    // floor(time / w), by adding and subtracting 2^52 (exact for 0 <= time / w <= 2^50).
    const L scaled = time * broadcast<L>(parameters.leaf_count);
    const L nearest = (scaled + broadcast<L>(0x1p52)) - broadcast<L>(0x1p52);
    return select<L>(less(scaled, nearest), nearest - broadcast<L>(1.0), nearest) * broadcast<L>(parameters.leaf_width);
}

/// In narrower leaves too few pairs touch for all to be looked at: what rounding hides is too large a part of them.
inline constexpr double narrowest_touched = 0x1p-44;

/// Whether a pair that is well shaped is in contact in [a, b] for all that rounding can tell, though nothing proves it, and until less than
/// half of [a, b] before that apart for certain, or before a.
template <class L>
struct Touch {
    LaneMask<L> present;
    L time, lower_bound;  ///< When the pair meets; and until when it is apart on [a, b].
};

/// Of the lanes in `asked`.
template <PairKind kind, class L>
FASTCCD_INLINE Touch<L> touch_on(const PairCoefficientsOf<L>& pair, L a, L b, LaneMask<L> asked)
{
    Touch<L> found{less(a, a), a, a};
    const auto look_at = [&](const LikelyTouch<L>& likely) FASTCCD_INLINE_LAMBDA {
        LaneMask<L> present = asked & likely.expected;
        if (Lane<L>::bits(present) != 0) present = present & meets_at<kind>(pair, likely.time);
        if (Lane<L>::bits(present) != 0) present = present & well_shaped_at<kind>(pair, likely.time, broadcast<L>(1.0));
        if (Lane<L>::bits(present) != 0) present = present & !apart_by_area_on<kind>(pair, a, b);
        if (Lane<L>::bits(present) != 0) present = present & (less_equal(likely.before, a) | apart_on<kind>(pair, a, likely.before));
        found = {found.present | present, select<L>(present, likely.time, found.time), select<L>(present, likely.before, found.lower_bound)};
        asked = asked & !present;
    };
    if (Lane<L>::bits(asked) != 0) look_at(touch_by_cubic(pair, a, b));
    if (Lane<L>::bits(asked) != 0) look_at(touch_by_gaps<kind>(pair, a, b, asked));
    // The others are for pairs whose volume tells nothing at a or, losses, ceases to in this leaf: twice its bound is ample for what it slowly
    // changes by there.
    const L volume = abs(coplanarity_on(pair, a, a).c0);
    const LaneMask<L> nearly_flat = asked & less_equal(volume, broadcast<L>(2.0) * pair.cubic_bound);
    asked = asked & less_equal(volume, pair.cubic_bound);
    if (Lane<L>::bits(asked) != 0) look_at(touch_by_certificates<kind>(pair, a, b, asked));
    // What is lost for good is lost at b, too: a look that spares most leaves the rest.
    asked = nearly_flat & !found.present & less_equal(broadcast<L>(narrowest_lost), b - a);
    if (Lane<L>::bits(asked) != 0) asked = asked & meets_at<kind>(pair, b);
    if (Lane<L>::bits(asked) != 0) asked = asked & well_shaped_at<kind>(pair, b, broadcast<L>(1.0));
    if (Lane<L>::bits(asked) != 0) look_at(touch_by_loss<kind>(pair, a, b));
    return found;
}

/// The cubic at time 0 is zero to within its bound.
template <class L>
FASTCCD_INLINE LaneMask<L> zero_at_start(const PairCoefficientsOf<L>& pair)
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
