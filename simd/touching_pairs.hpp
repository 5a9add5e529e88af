// The last of the lanes' stages: of pairs whose contact is not proven, what the certified search says of the leaf in which it may be.
//
// From the pair's coordinates, by the search's own text and bounds, so what it says of a leaf needs no margin. That it comes to this leaf is
// either known from the stages before, or found out here, from one certificate to the next: those need margins, as the search asks for
// narrower intervals.
#pragma once

#include <kernel_table.hpp>
#include <search_coefficients.hpp>
#include <touching.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// The search leaves the axes of a pair alone if its differences have no extent along them, or one between these (scalar/scaling.hpp);
/// if it leaves all alone, it computes what lanes do. An inner part of that range will do here.
inline constexpr double smallest_touching = 0x1p-90, largest_touching = 0x1p90;

template <class L>
FASTCCD_INLINE LaneMask<L> is_unscaled(const RelativeMotion<L>& step, const RelativeMotion<L>& searched)
{
    const Extents<L> s = extents(step), e = extents(searched);
    const L smallest = broadcast<L>(smallest_touching), largest = broadcast<L>(largest_touching);
    const auto along = [&](L of_step, L of_searched) FASTCCD_INLINE_LAMBDA {
        return less_equal(of_step, broadcast<L>(0.0)) |
               (less(smallest, min(of_step, of_searched)) & less(max(of_step, of_searched), largest));
    };
    return along(s.x, e.x) & along(s.y, e.y) & along(s.z, e.z);
}

/// In terms of lanes: see TouchAnswers.
template <class L>
struct LeafContacts {
    LaneMask<L> reported, proven, elsewhere, apart;
    L time;
};

/// What the search finds in the leaves that start at `left`, for pairs that are in contact there, proven or as far as rounding can tell.
template <PairKind kind, class L>
__attribute__((noinline)) LeafContacts<L> answer_in_leaf(const PairCoefficientsOf<L>& pair, L left, L width, LaneMask<L> asked)
{
    const L right = left + width;
    const LaneMask<L> proven = asked & contact_proven_on<kind>(pair, left, right), none = less(left, left);
    const Touch<L> touch = touch_on<kind>(pair, left, right, asked & !proven);
    LeafContacts<L> found{proven | touch.present, proven, none, none, select<L>(proven, left, touch.lower_bound)};
    if (Lane<L>::bits(touch.present) != 0) found.proven = proven | (touch.present & contact_proven_near<kind>(pair, touch.time));
    return found;
}

/// Of a pair's certificates, such that one by these bounds on an interval is one for the search on each part of it (meeting.hpp).
template <PairKind kind, class L>
FASTCCD_INLINE PairCoefficientsOf<L> with_margins(const PairCoefficientsOf<L>& pair)
{
    PairCoefficientsOf<L> sure = pair;
    sure.cubic_bound = pair.cubic_bound + value_margin(Cubic<L>{pair.cubic[0], pair.cubic[1], pair.cubic[2], pair.cubic[3]});
    for (auto& edges : sure.edges)
        for (int edge = 0; edge < (kind == PairKind::vertex_face ? 3 : 4); ++edge) {
            auto& e = edges[edge];
            e.bound = e.bound + value_margin(Quadratic<L>{e.start, e.middle, e.end});
        }
    for (int axis = 0; axis < 3; ++axis) {
        // Of both vertices of a gap, each of which may have the largest coordinate.
        const auto motion = [&](int i) FASTCCD_INLINE_LAMBDA -> AxisMotion<L> { return {pair.start[i][axis], pair.end[i][axis]}; };
        const L largest = max(motion(0).largest(), motion(1).largest(), motion(2).largest());
        sure.gap_bound[axis] = pair.gap_bound[axis] + broadcast<L>(4 * 3.6 * ErrorBounds::u) * largest;
    }
    return sure;
}

/// How many certificates, one after the other, are looked for: of pairs in one plane, four leave 8 % more to the search, eight 1 % less.
inline constexpr int most_certificates = 6;

/// Until when the search finds the pair apart, as far as the last certificates of one time after the other tell: on each leaf that ends
/// before. 1: throughout. It does not run into its cap before, with two intervals a level at either end of each certificate.
template <PairKind kind, class L>
FASTCCD_INLINE L apart_from_start(const PairCoefficientsOf<L>& pair, L leaf_width)
{
    const PairCoefficientsOf<L> sure = with_margins<kind>(pair);
    const L one = broadcast<L>(1.0);
    L time = broadcast<L>(0.0), apart = time;
    LaneMask<L> open = less(time, one);
    for (int k = 0; k < most_certificates; ++k) {
        const L end = last_certificate<kind>(pair, time, one).before;
        open = open & less(apart, end) & apart_on<kind>(sure, time, end);
        apart = select<L>(open, end, apart);
        // Intervals across the end of one certificate lie within the next one.
        const L next = end - leaf_width;
        open = open & less(end, one) & less(time, next);
        if (Lane<L>::bits(open) == 0) break;
        time = select<L>(open, next, time);
    }
    return apart;
}

/// What the search finds in the leaf that starts at `left` or, if that is apart, in the next one; nothing in the first leaf and after 1.
template <PairKind kind, class L>
FASTCCD_INLINE LeafContacts<L> answer_in_two_leaves(const PairCoefficientsOf<L>& pair, L left, L width, LaneMask<L> asked)
{
    const L one = broadcast<L>(1.0), next = left + width;
    const LaneMask<L> none = less(left, left);
    LeafContacts<L> found{none, none, none, none, left};
    asked = asked & less_equal(next, one);
    if (Lane<L>::bits(asked) == 0) return found;
    const LaneMask<L> apart = asked & apart_on<kind>(pair, left, min(next, one));
    const LaneMask<L> here = asked & less(broadcast<L>(0.0), left) & !apart, in_next = apart & less_equal(next + width, one);
    if (Lane<L>::bits(here) != 0) found = answer_in_leaf<kind>(pair, left, width, here);
    if (Lane<L>::bits(in_next) == 0) return found;
    const LeafContacts<L> there = answer_in_leaf<kind>(pair, next, width, in_next);
    const LaneMask<L> open = in_next & !there.reported;
    if (Lane<L>::bits(open) != 0) found.elsewhere = open & apart_on<kind>(pair, next, next + width);
    found.reported = found.reported | there.reported;
    found.proven = found.proven | there.proven;
    found.time = select<L>(there.reported, there.time, found.time);
    return found;
}

/// The pairs of a batch, as the search sees them.
template <class L>
struct SearchedPairs {
    PairCoefficientsOf<L> pair;
    LaneMask<L> open, apart;  ///< Nothing is known yet; apart by the certificates on [0, 1]. Neither: of another scale.
};

template <PairKind kind, class L>
FASTCCD_INLINE SearchedPairs<L> searched_pairs(const double* coordinates, unsigned first, const SearchParameters& parameters)
{
    const auto motion = [&](int origin, double t_max) FASTCCD_INLINE_LAMBDA {
        // As in the search's, point `origin` and x0 are exchanged.
        return relative_motion_of<L>([=](int c) FASTCCD_INLINE_LAMBDA {
            const int point = c / 3 % 4, exchanged = point == 0 ? origin : point == origin ? 0 : point;
            return Lane<L>::load(coordinates + first + (c + 3 * (exchanged - point)) * static_cast<int>(block_pairs));
        }, t_max);
    };
    const RelativeMotion<L> r = motion(0, parameters.t_max);
    const LaneMask<L> unscaled = is_unscaled(motion(0, 1.0), r);
    SearchedPairs<L> searched;
    LaneMask<L> apart;
    if constexpr (kind == PairKind::edge_edge)
        apart = find_coefficients<kind>(r, motion(1, parameters.t_max), parameters.bounds, searched.pair);
    else
        apart = find_coefficients<kind>(r, r, parameters.bounds, searched.pair);
    searched.open = unscaled & !apart;
    searched.apart = unscaled & apart;
    return searched;
}

/// Pairs that may be in contact in the leaves that start at `left`, or in the next ones.
template <PairKind kind, class L>
FASTCCD_INLINE LeafContacts<L> contact_in_leaves(const SearchedPairs<L>& searched, L left, const SearchParameters& parameters)
{
    const LeafContacts<L> found =
        answer_in_two_leaves<kind>(searched.pair, left, broadcast<L>(parameters.leaf_width), searched.open);
    return {found.reported, found.proven, found.elsewhere, searched.apart, found.time};
}

/// Pairs that may be in contact in any leaf.
template <PairKind kind, class L>
FASTCCD_INLINE LeafContacts<L> contact_anywhere(const SearchedPairs<L>& searched, const SearchParameters& parameters)
{
    const PairCoefficientsOf<L>& pair = searched.pair;
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0), width = broadcast<L>(parameters.leaf_width);
    // Most whose cubic tells nothing are kept apart by a gap.
    const L gap = last_gap<kind>(pair, zero, one).before;
    const LaneMask<L> apart_before = searched.open & less(gap, one) & separated_on<kind>(with_margins<kind>(pair), zero, gap);
    LeafContacts<L> found = answer_in_two_leaves<kind>(pair, leaf_start(gap, parameters), width, apart_before);

    const LaneMask<L> open = found.elsewhere | (searched.open & !apart_before);
    found.elsewhere = less(one, zero);
    found.apart = searched.apart;
    if (Lane<L>::bits(open) == 0) return found;
    const L until = apart_from_start<kind>(pair, width);
    found.apart = found.apart | (open & less_equal(one, until));
    LaneMask<L> at_start = open & less_equal(until, zero);
    if (Lane<L>::bits(at_start) != 0) {
        at_start = at_start & in_contact_at_start<kind>(pair, width) & has_area_at<kind>(pair, zero);
        found.reported = found.reported | at_start;
        found.time = select<L>(at_start, zero, found.time);
    }
    const LaneMask<L> in_leaf = open & less(zero, until) & less(until, one);
    if (Lane<L>::bits(in_leaf) == 0) return found;
    const LeafContacts<L> there = answer_in_two_leaves<kind>(pair, leaf_start(until, parameters), width, in_leaf);
    return {found.reported | there.reported, found.proven | there.proven, found.elsewhere, found.apart,
            select<L>(there.reported, there.time, found.time)};
}

template <class L, bool anywhere>
void touching_block(PairKind kind, const double* block, const SearchParameters& parameters, TouchAnswers& answers)
{
    answers.reported = answers.proven = answers.elsewhere = answers.apart = 0;
    const auto answer = [&]<PairKind pair_kind>(unsigned first) FASTCCD_INLINE_LAMBDA {
        const SearchedPairs<L> searched = searched_pairs<pair_kind, L>(block, first, parameters);
        LeafContacts<L> found;
        if constexpr (anywhere)
            found = contact_anywhere<pair_kind>(searched, parameters);
        else
            found = contact_in_leaves<pair_kind>(searched, Lane<L>::load(&answers.left[first]), parameters);
        Lane<L>::store(&answers.time[first], found.time);
        answers.reported |= Lane<L>::bits(found.reported) << first;
        answers.proven |= Lane<L>::bits(found.proven) << first;
        answers.elsewhere |= Lane<L>::bits(found.elsewhere) << first;
        answers.apart |= Lane<L>::bits(found.apart) << first;
    };
    for (unsigned i = 0; i < block_pairs; i += Lane<L>::width) {
        if (kind == PairKind::vertex_face)
            answer.template operator()<PairKind::vertex_face>(i);
        else
            answer.template operator()<PairKind::edge_edge>(i);
    }
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
