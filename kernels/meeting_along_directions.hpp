// A pair whose shape amplifies rounding, from where its certificates end on to where it meets, along directions.
//
// Where both edges are points or in one line for a moment, or a face has no area, the cubic, the edge functions and their bounds come to zero
// together: of thousands of leaves before that moment none has a certificate by itself, and one direction reaches through all of them. Where
// it ends, directions show no distance any more, and if certificates say at that time that the pair meets, hardly any other search would clear it:
// it is reported at once, by the search and, with the same bits, by lanes, as in touching.hpp.
#pragma once

#include <touching.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// How often a direction is asked for by lanes, each from where the last one ends: of pairs without area for a moment, two in three need no
/// more than one. The search goes on after that (leaf_search.hpp).
inline constexpr int most_directions = 4;

template <class L>
struct AlongDirections {
    LaneMask<L> asked;    ///< Those that were open and have no area.
    LaneMask<L> goes_on;  ///< Until `time`, and may be for longer; after most_directions.
    LaneMask<L> apart;    ///< From the start to the end of the step.
    L time;               ///< Apart from the start until then.
};

/// From `start` on, those of the lanes in `open` that have no area there. A function of its own: much code, seldom run.
template <PairKind kind, class L>
__attribute__((noinline)) AlongDirections<L> along_directions(const PairCoefficientsOf<L>& pair, L start, const ErrorBounds& bounds, LaneMask<L> open)
{
    if (Lane<L>::bits(open) != 0) open = open & !has_area_at<kind>(pair, start);
    AlongDirections<L> found{open, open, no_lanes<L>(), start};
    if (Lane<L>::bits(open) == 0) return found;

    const RelativeMotion<L> motion = with_normalized_extents(motion_of<L>(pair));
    const Extents<L> size = extents(motion);
    const L one = broadcast<L>(1.0);
    for (int k = 0; k < most_directions && Lane<L>::bits(found.goes_on) != 0; ++k) {
        const DirectionAt<L> seen = direction_at<kind>(motion, size, found.time, bounds);
        const LaneMask<L> leads_on = found.goes_on & !seen.none;
        found.time = select<L>(leads_on, min(max(seen.until, found.time), one), found.time);
        found.apart = found.apart | (leads_on & less(one, seen.until));
        found.goes_on = leads_on & !found.apart;
    }
    return found;
}

/// The leaf that `time` lies in, of this width.
template <class L>
FASTCCD_INLINE L leaf_start(L time, double width)
{
    return min(interval_start(time, width), broadcast<L>(1.0 - width));
}

template <class L>
struct Meeting {
    LaneMask<L> present, proven;  ///< Proven: in its leaf, or around it.
};

/// Whether a pair meets at `time`, where directions that have kept it apart end, of the lanes in `asked`. Not at 0: what meets there has been
/// answered (in_contact_at_start), as meets_at() of a leaf leaves more for rounding (meeting.hpp) than its bounds have for parts
/// (restriction.hpp). Rounding of eq. 7 alone could tell otherwise: of a pair that directions do not tell from one in contact at 0.
template <PairKind kind, class L>
__attribute__((noinline)) Meeting<L> meeting_after_directions(const PairCoefficientsOf<L>& pair, L time, double leaf_width, LaneMask<L> asked)
{
    Meeting<L> found{asked, no_lanes<L>()};
    if (Lane<L>::bits(found.present) != 0) found.present = found.present & !apart_by_area_on<kind>(pair, time, time);
    if (Lane<L>::bits(found.present) == 0) return found;
    const L left = leaf_start(time, leaf_width);
    PolynomialsOf<L> leaf = restricted_to<kind>(pair, left, left + broadcast<L>(leaf_width));
    const LaneMask<L> certain = contact_proven_on<kind>(leaf, Throughout<L>{});
    add_rounding_on_parts<kind>(leaf);
    found.present = found.present & meets_at<kind>(leaf, (time - leaf.origin) / leaf.duration);
    if (Lane<L>::bits(found.present) != 0) found.proven = found.present & (certain | contact_proven_near<kind>(pair, time));
    return found;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
