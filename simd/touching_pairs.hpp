// The last of the lanes' stages: of pairs whose contact is not proven, what the certified search says of the leaf in which it may be.
//
// From the pair's coordinates, by the search's own text and bounds, so nothing here needs a margin: what lanes know from the stages before
// is that the search comes to this leaf, or finds it apart and comes to the next one.
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

/// In terms of lanes: see LeafAnswers.
template <class L>
struct LeafContacts {
    LaneMask<L> reported, proven;
    L time;
};

/// What the search finds in the leaves that start at `left`, for pairs that are in contact there, proven or as far as rounding can tell.
template <PairKind kind, class L>
FASTCCD_INLINE LeafContacts<L> answer_in_leaf(const PairCoefficientsOf<L>& pair, L left, L width)
{
    const L right = left + width;
    const LaneMask<L> proven = contact_proven_on<kind>(pair, left, right);
    const Touch<L> touch = touch_on<kind>(pair, left, right);
    const LaneMask<L> touches = touch.present & !proven;
    if (Lane<L>::bits(touches) == 0) return {proven, proven, left};
    return {proven | touches, proven | (touches & contact_proven_near<kind>(pair, touch.time)), select<L>(proven, left, touch.lower_bound)};
}

template <PairKind kind, class L>
FASTCCD_INLINE void contact_in_leaves(const double* coordinates, unsigned first, const SearchParameters& parameters, LeafAnswers& answers)
{
    const auto motion = [&](int origin, double t_max) FASTCCD_INLINE_LAMBDA {
        // As in the search's, point `origin` and x0 are exchanged.
        return relative_motion_of<L>([=](int c) FASTCCD_INLINE_LAMBDA {
            const int point = c / 3 % 4, exchanged = point == 0 ? origin : point == origin ? 0 : point;
            return Lane<L>::load(coordinates + first + (c + 3 * (exchanged - point)) * static_cast<int>(block_pairs));
        }, t_max);
    };
    const RelativeMotion<L> r = motion(0, parameters.t_max);
    LaneMask<L> unscaled = is_unscaled(motion(0, 1.0), r), apart;
    PairCoefficientsOf<L> pair;
    if constexpr (kind == PairKind::edge_edge) {
        const RelativeMotion<L> from_x1 = motion(1, parameters.t_max);
        unscaled = unscaled & is_unscaled(motion(1, 1.0), from_x1);
        apart = find_coefficients<kind>(r, from_x1, parameters.bounds, pair);
    } else {
        apart = find_coefficients<kind>(r, r, parameters.bounds, pair);
    }

    const L left = Lane<L>::load(&answers.left[first]), width = broadcast<L>(parameters.leaf_width), next = left + width;
    const LeafContacts<L> here = answer_in_leaf<kind>(pair, left, width);
    const unsigned known = Lane<L>::bits(unscaled & !apart);
    unsigned reported = known & Lane<L>::bits(here.reported), proven = known & Lane<L>::bits(here.proven);
    Lane<L>::store(&answers.time[first], here.time);
    LaneMask<L> open = less_equal(next + width, broadcast<L>(1.0)) & (!here.reported);
    if ((known & Lane<L>::bits(open)) != 0) open = open & apart_on<kind>(pair, left, next);
    if ((known & Lane<L>::bits(open)) != 0) {
        const LeafContacts<L> there = answer_in_leaf<kind>(pair, next, width);
        reported |= known & Lane<L>::bits(open & there.reported);
        proven |= known & Lane<L>::bits(open & there.proven);
        Lane<L>::store(&answers.time[first], select<L>(open, there.time, here.time));
    }
    answers.reported |= reported << first;
    answers.proven |= proven << first;
}

template <class L>
void contact_in_leaves_of_block(PairKind kind, const double* block, const SearchParameters& parameters, LeafAnswers& answers)
{
    answers.reported = answers.proven = 0;
    for (unsigned i = 0; i < block_pairs; i += Lane<L>::width) {
        if (kind == PairKind::vertex_face)
            contact_in_leaves<PairKind::vertex_face, L>(block, i, parameters, answers);
        else
            contact_in_leaves<PairKind::edge_edge, L>(block, i, parameters, answers);
    }
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
