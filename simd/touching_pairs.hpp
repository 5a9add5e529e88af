// The last of the lanes' stages: of pairs whose contact is not proven, what the certified search says of the leaf in which it may be.
//
// From the pair's coordinates, by the search's own text and bounds, so what it says of a leaf needs no margin. That it comes to this leaf is
// either known from the stages before, or found out here, from one certificate to the next: those need margins, as the search asks for
// narrower intervals.
#pragma once

#include <kernel_table.hpp>
#include <search_coefficients.hpp>
#include <start_in_doubt.hpp>
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

/// In terms of lanes: see TouchAnswers. `both_apart`: in the leaf asked for, and in the next one.
template <class L>
struct LeafContacts {
    LaneMask<L> reported, proven, both_apart, apart, start_in_doubt;
    L time;
};

/// What the search finds in the leaves that start at `left`, for pairs that are in contact there, proven or as far as rounding can tell.
template <PairKind kind, class L>
__attribute__((noinline)) LeafContacts<L> answer_in_leaf(const PairCoefficientsOf<L>& pair, L left, L width, LaneMask<L> asked)
{
    const L right = left + width;
    const LaneMask<L> proven = asked & contact_proven_on<kind>(pair, left, right), none = less(left, left);
    const Touch<L> touch = touch_on<kind>(pair, left, right, asked & !proven);
    LeafContacts<L> found{proven | touch.present, proven, none, none, none, select<L>(proven, left, touch.lower_bound)};
    if (Lane<L>::bits(touch.present) != 0) found.proven = proven | (touch.present & contact_proven_near<kind>(pair, touch.time));
    return found;
}

/// The pair with its bounds and `times` the margins such that a certificate by bound and margin on an interval is one for the search on each
/// part of it (meeting.hpp).
template <PairKind kind, class L>
FASTCCD_INLINE PairCoefficientsOf<L> with_margins(const PairCoefficientsOf<L>& pair, double times)
{
    PairCoefficientsOf<L> sure = pair;
    const L factor = broadcast<L>(times);
    sure.cubic_bound = pair.cubic_bound + factor * value_margin(Cubic<L>{pair.cubic[0], pair.cubic[1], pair.cubic[2], pair.cubic[3]});
    for (auto& edges : sure.edges)
        for (int edge = 0; edge < (kind == PairKind::vertex_face ? 3 : 4); ++edge) {
            auto& e = edges[edge];
            e.bound = e.bound + factor * value_margin(Quadratic<L>{e.start, e.middle, e.end});
        }
    for (int axis = 0; axis < 3; ++axis) {
        // Of both vertices of a gap, each of which may have the largest coordinate.
        const auto motion = [&](int i) FASTCCD_INLINE_LAMBDA -> AxisMotion<L> { return {pair.start[i][axis], pair.end[i][axis]}; };
        const L largest = max(motion(0).largest(), motion(1).largest(), motion(2).largest());
        sure.gap_bound[axis] = pair.gap_bound[axis] + factor * (broadcast<L>(4 * 3.6 * ErrorBounds::u) * largest);
    }
    return sure;
}

/// A pair, and what certificates of it are to exceed: to prove, and, with half a margin more for the rounding of a value, to be looked for.
template <PairKind kind, class L>
struct Certificates {
    PairCoefficientsOf<L> proven, expected;

    FASTCCD_INLINE explicit Certificates(const PairCoefficientsOf<L>& pair)
        : proven{with_margins<kind>(pair, 1.0)}, expected{with_margins<kind>(pair, 1.5)}
    {
    }
};

/// How many certificates, one after the other, are looked for: of pairs in one plane, four leave 17 % more to the search, eight 6 % less.
inline constexpr int most_certificates = 6;

/// The search finds the pair apart before `apart`. Before what time it does so, too, by the last certificates of `time` on, each from shortly
/// before the end of the last one.
///
/// Only a part that begins before such an overlap and ends after it may have no certificate: one a level. An overlap is longer than the finest
/// parts are (leaf_search.hpp), so the search halves that part until its parts have one. It reports no leaf there, as a pair that meets
/// (meets_at) has no certificate then. With at most two overlaps within a leaf's width it examines 400 parts of a leaf at most, two on each
/// of 100 levels for either, where 512 are allowed.
template <PairKind kind, class L>
FASTCCD_INLINE L apart_from(const Certificates<kind, L>& pair, L time, L apart, L leaf_width, LaneMask<L> open)
{
    const L one = broadcast<L>(1.0), earliest_end = broadcast<L>(8 * finest_at_zero);
    L last_end = broadcast<L>(-1.0), end_before = last_end;
    for (int k = 0; k < most_certificates; ++k) {
        const L end = last_certificate<kind>(pair.expected, time, one, one);
        open = open & less(apart, end) & apart_on<kind>(pair.proven, time, end);
        apart = select<L>(open, end, apart);
        open = open & less(end, one) & less(earliest_end, end) & less(leaf_width, end - end_before);
        if (Lane<L>::bits(open) == 0) break;
        end_before = last_end;
        last_end = end;
        time = select<L>(open, end - max(end * broadcast<L>(0x1p-50), broadcast<L>(4 * finest_at_zero)), time);
    }
    return apart;
}

/// What the search finds in the leaf that starts at `left` or, if that is apart, in the next one; nothing in the first leaf and after 1.
template <PairKind kind, class L>
FASTCCD_INLINE LeafContacts<L> answer_in_two_leaves(const PairCoefficientsOf<L>& pair, L left, L width, LaneMask<L> asked)
{
    const L one = broadcast<L>(1.0), next = left + width;
    const LaneMask<L> none = less(left, left);
    LeafContacts<L> found{none, none, none, none, none, left};
    asked = asked & less_equal(next, one);
    if (Lane<L>::bits(asked) == 0) return found;
    const LaneMask<L> apart = asked & apart_on<kind>(pair, left, min(next, one));
    const LaneMask<L> here = asked & less(broadcast<L>(0.0), left) & !apart, in_next = apart & less_equal(next + width, one);
    if (Lane<L>::bits(here) != 0) found = answer_in_leaf<kind>(pair, left, width, here);
    if (Lane<L>::bits(in_next) == 0) return found;
    const LeafContacts<L> there = answer_in_leaf<kind>(pair, next, width, in_next);
    const LaneMask<L> open = in_next & !there.reported;
    if (Lane<L>::bits(open) != 0) found.both_apart = open & apart_on<kind>(pair, next, next + width);
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
    LeafContacts<L> found = answer_in_two_leaves<kind>(searched.pair, left, broadcast<L>(parameters.leaf_width), searched.open);
    found.apart = searched.apart;
    return found;
}

/// How often a leaf is asked for and, if the pair is apart there and in the next one, what comes after. In all the search examines less than
/// 2,400 intervals, far below its cap: two on each of 100 levels for ten overlaps, and of 50 for four leaves.
inline constexpr int most_leaves_asked = 2;

/// Pairs that may be in contact in any leaf.
template <PairKind kind, class L>
FASTCCD_INLINE LeafContacts<L> contact_anywhere(const SearchedPairs<L>& searched, const SearchParameters& parameters)
{
    const PairCoefficientsOf<L>& pair = searched.pair;
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0), width = broadcast<L>(parameters.leaf_width);
    const LaneMask<L> none = less(one, zero);
    LeafContacts<L> found{none, none, none, searched.apart, none, zero};
    const auto add = [&](const LeafContacts<L>& there) FASTCCD_INLINE_LAMBDA {
        found.reported = found.reported | there.reported;
        found.proven = found.proven | there.proven;
        found.time = select<L>(there.reported, there.time, found.time);
    };

    LaneMask<L> open = searched.open;
    const LaneMask<L> at_start = open & in_contact_at_start<kind>(pair, width);
    if (Lane<L>::bits(at_start) != 0) {
        found.reported = at_start & well_shaped_at_start<kind>(pair);
        found.start_in_doubt = at_start & !found.reported;
        open = open & !at_start;
    }
    if (Lane<L>::bits(open) == 0) return found;

    // Most whose cubic tells nothing are kept apart by a gap.
    const Certificates<kind, L> certificates{pair};
    const L gap = last_gap<kind>(certificates.expected, zero, one, one);
    const LaneMask<L> apart_before = open & less(gap, one) & separated_on<kind>(certificates.proven, zero, gap);
    add(answer_in_two_leaves<kind>(pair, leaf_start(gap, parameters), width, apart_before));
    open = open & !found.reported;

    L time = zero, apart = zero;
    for (int k = 0; k < most_leaves_asked && Lane<L>::bits(open) != 0; ++k) {
        apart = apart_from<kind>(certificates, time, apart, width, open);
        found.apart = found.apart | (open & less_equal(one, apart));
        open = open & less(zero, apart) & less(apart, one);
        if (Lane<L>::bits(open) == 0) break;
        const L left = leaf_start(apart, parameters);
        const LeafContacts<L> there = answer_in_two_leaves<kind>(pair, left, width, open);
        add(there);
        open = open & there.both_apart;
        time = apart = left + broadcast<L>(2.0) * width;
    }
    return found;
}

/// Calls answer<kind>(number of the first pair) for each batch of a block.
template <class L, class Answer>
FASTCCD_INLINE void for_each_batch(PairKind kind, Answer answer)
{
    for (unsigned i = 0; i < block_pairs; i += Lane<L>::width) {
        if (kind == PairKind::vertex_face)
            answer.template operator()<PairKind::vertex_face>(i);
        else
            answer.template operator()<PairKind::edge_edge>(i);
    }
}

template <class L, bool anywhere>
void touching_block(PairKind kind, const double* block, const SearchParameters& parameters, TouchAnswers& answers)
{
    answers.reported = answers.proven = answers.apart = answers.start_in_doubt = 0;
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
        answers.apart |= Lane<L>::bits(found.apart) << first;
        answers.start_in_doubt |= Lane<L>::bits(found.start_in_doubt) << first;
    };
    for_each_batch<L>(kind, answer);
}

template <class L>
void start_in_doubt_block(PairKind kind, const double* block, const SearchParameters& parameters, TouchAnswers& answers)
{
    answers.reported = answers.proven = answers.apart = answers.start_in_doubt = 0;
    for_each_batch<L>(kind, [&]<PairKind pair_kind>(unsigned first) FASTCCD_INLINE_LAMBDA {
        const RelativeMotion<L> r = relative_motion<L>(block + first, block_pairs, parameters.t_max);
        Lane<L>::store(&answers.time[first], broadcast<L>(0.0));
        answers.reported |= Lane<L>::bits(stays_in_contact_at_start<pair_kind>(r, parameters.bounds)) << first;
    });
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
