// The search for the first time at which a pair comes within d, step by step.
//
// The search walks along the time axis. At the time it has got to it looks at the pair, and goes on to the end of the
// reach of the vector between the primitives: conservative advancement along a fixed direction, hence Newton's method where
// the primitives approach. It begins with the certificates on halves (farther_certificates.hpp) and a look at the middle of what they leave,
// whose reach is all of it for most pairs, and a window to jump over for many others. The next look is where contact probably is
// (contact_guess.hpp), if that can be told. Where the primitives stay close to d for long while they
// turn, a fixed vector reaches as far as the excess of the distance over d, one that turns as far as its square root: so the search also
// looks ahead, to where the secant through the last two distances reaches d, or, after some looks, as far as has gone well, and proves the way
// there by the volume or by the vectors at both ends of it. Where it sees that this was beyond contact, it looks once more, in between.
//
// This is the definition of the result, but for the few pairs that take most_lane_looks, with which scalar/separation_search.cpp
// goes on. Every step is a function of the pair alone, in the same operations in every lane type, so lanes and the scalar
// search come to the same time, bit for bit.
#pragma once

#include <farther_certificates.hpp>
#include <search_parameters.hpp>
#include <separation_certificate.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// A pair on its way, lane by lane.
template <class L>
struct SeparationRecord {
    RelativeMotion<L> r;
    Extents<L> extents;
    L pair;                     ///< Index in the tile, as a double.
    L time;                     ///< Farther than d before this time, and at it if it is positive.
    L window_low, window_high;  ///< Farther than d between these, too.
    L looks;                    ///< How often the pair has been looked at.
    L purpose;                  ///< Of the next look: one of those below.
    L at;                       ///< Time of the next look.
    // While looking ahead. Before the first look at `time`, high is `time`, the others are 0:
    Vector3<L> n;  ///< Vector at `time`,
    L high;        ///< how far it reaches,
    L last_time, last_gap;  ///< the last time the search had got to, and the distance then, from below.
    L interval;    ///< And the time to look ahead at most; 0: any.
};

/// Purposes of a look: to go on from `time`; to go on from there to `at`, by more than one vector, or to less after `at` was too far; to prove
/// contact found at `time`.
inline constexpr double going_on = 0.0, looking_ahead = 1.0, looking_less_far = 1.5, proving = 2.0;

/// Looks after which the search looks ahead even where the distance does not fall, and how far at least: that many times
/// the reach of the vector at `time`.
inline constexpr double most_plain_looks = 8, first_stretch = 8;

/// Contact at `time` is to be proven when that many times the reach of the vector at `time` has passed. That reaches about to
/// contact, less where the primitives turn; within so short a time they do not pass through each other.
inline constexpr double proof_stretch = 32;

/// Looks after which a pair is left to the scalar search, which lets n follow the primitives exactly where it can
/// (scalar/following_direction.hpp). Of random pairs in the unit cube one in 100,000 or fewer comes to so many with d from 1e-6 on.
inline constexpr double most_lane_looks = 64;

/// Cap on the looks at one pair, the first one included; on reaching it the time reached is the answer: contact. After it come at most
/// the look at that time, where the last one was too far ahead, and the one for the proof.
inline constexpr double most_looks = 4096;

/// The distance at which a look ahead is aimed: halfway to what is close enough.
template <class L>
FASTCCD_INLINE L aimed_distance(const SeparationParameters& wanted, const Extents<L>& extents)
{
    return broadcast<L>(wanted.aim) + broadcast<L>(0.5 * SeparationParameters::resolution) * sum(extents);
}

/// Where a step that ends at `time` leads: over the window, if it begins before.
template <class L>
FASTCCD_INLINE L past_window(const SeparationRecord<L>& pair, L time)
{
    return select<L>(less(pair.window_low, time), max(time, pair.window_high), time);
}

/// The look at the middle of what `farther`, certificates on halves, leave of the interval; they do not hold on both. True where it
/// proves that the pair stays farther than d.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> first_look(SeparationRecord<L>& pair, const ApartOnHalves<L>& farther, const SearchParameters& parameters)
{
    const SeparationBounds bounds{parameters.bounds.rho};
    const L zero = broadcast<L>(0.0), half = broadcast<L>(0.5), one = broadcast<L>(1.0), two = broadcast<L>(2.0);
    const L start = select<L>(farther.first, half, zero);
    const L middle = select<L>(farther.first, broadcast<L>(0.75), select<L>(farther.second, broadcast<L>(0.25), half));
    const Vector3<L> n = separation<kind>(positions(pair.r, middle).r).n;  // features are asked where contact may be found
    const Reach<L> seen = reach<kind>(pair.r, n, threshold_along(n, pair.extents, parameters.separation, bounds.height(kind)));
    // Of what is beyond the reach and in the second half, one window, if they meet; otherwise the half, which ends the search.
    const LaneMask<L> apart_from_half = farther.second & less(seen.high, half);
    pair.window_low = select<L>(apart_from_half, half, seen.low);
    pair.window_high = select<L>(farther.second, two, seen.high);
    pair.time = past_window(pair, select<L>(less(seen.low, start), max(seen.high, start), start));
    pair.looks = one;
    pair.purpose = broadcast<L>(going_on);
    pair.at = pair.time;
    pair.n = {zero, zero, zero};
    pair.high = pair.time;  // nothing reaches farther yet
    pair.interval = pair.last_time = pair.last_gap = zero;
    return less_equal(one, pair.time);
}

/// What a step has shown. Lanes in none of farther, contact and left go on.
template <class L>
struct StepOutcome {
    LaneMask<L> farther;  ///< Than d until the end, or until after `limit`, if nothing later is wanted.
    LaneMask<L> contact;  ///< At `time`.
    LaneMask<L> proven;   ///< Of these, the certain ones.
    LaneMask<L> left;     ///< Of the others: to the scalar search.
};

/// The look at the pair at the time for the next one, but for features (feature_directions.hpp).
template <PairKind kind, class L>
FASTCCD_INLINE Separation<L> quick_look(const SeparationRecord<L>& pair)
{
    return separation<kind>(positions(pair.r, pair.at).r);
}

/// Lanes in which those are to be asked for, too. Contact is proven by points, not by directions.
template <class L>
FASTCCD_INLINE LaneMask<L> asks_features(const SeparationRecord<L>& pair, const Separation<L>& quick, const SearchParameters& parameters)
{
    return less(pair.purpose, broadcast<L>(proving)) & leaves_open(quick, surely_certified(pair.extents, parameters.separation));
}

/// What they show in those lanes; elsewhere what `quick` does.
template <PairKind kind, class L>
FASTCCD_INLINE Separation<L> by_features(const SeparationRecord<L>& pair, const Separation<L>& quick, const SearchParameters& parameters)
{
    return separation_by_features<kind>(positions(pair.r, pair.at).r, quick, surely_certified(pair.extents, parameters.separation),
                                        asks_features(pair, quick, parameters));
}

/// All of the look.
template <PairKind kind, class L>
FASTCCD_INLINE Separation<L> next_look(const SeparationRecord<L>& pair, const SearchParameters& parameters)
{
    const Separation<L> quick = quick_look<kind>(pair);
    return Lane<L>::bits(asks_features(pair, quick, parameters)) == 0 ? quick : by_features<kind>(pair, quick, parameters);
}

/// Lanes of `ahead`, looks ahead of `time`, in which the pair stays farther than d from there to the look: by the volume, or by the vectors at
/// both ends. `at` are the positions at the look, which has shown `separation`.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> way_proven(const SeparationRecord<L>& pair, const Positions<L>& at, const Separation<L>& separation,
                                      const LaneMask<L>& ahead, const SearchParameters& parameters)
{
    if (Lane<L>::bits(ahead) == 0) return ahead;
    const SeparationParameters& wanted = parameters.separation;
    const SeparationBounds bounds{parameters.bounds.rho};
    const Positions<L> before = positions(pair.r, pair.time);
    const LaneMask<L> by_volume = ahead & farther_between<kind>(before.r, at.r, pair.extents, wanted.threshold, bounds);
    // Where the pair was within d at the look, no vectors prove the way to it: often all that is left.
    const LaneMask<L> others = ahead & !by_volume & less(broadcast<L>(wanted.threshold), separation.gap);
    if (Lane<L>::bits(others) == 0) return by_volume;
    return by_volume | (others & farther_while_turning<kind>(before.r, at.r, pair.extents, pair.n, separation.n, wanted, bounds));
}

/// The distance from above in lanes of `measured`, infinity in the others. Few batches need it; lanes that do not must not depend on the others.
template <PairKind kind, class L>
FASTCCD_INLINE L distance_from_above(const Positions<L>& at, const Separation<L>& separation, const LaneMask<L>& measured)
{
    const L infinity = broadcast<L>(__builtin_inf());
    if (Lane<L>::bits(measured) == 0) return infinity;
    return select<L>(measured, sqrt(square_distance<kind>(at.r, separation)), infinity);
}

/// A look ahead of what the vector at the time reached reaches.
template <class L>
struct LookAhead {
    L at;                      ///< Time of the look.
    L interval;                ///< The time to look ahead at most, from now on; 0: any.
    LaneMask<L> is_worthwhile;  ///< It is farther than going on along the vector, or many looks have been in vain.
};

/// The one from `time`, where the distance is `gap` from below and the vector reaches `reach` farther; `turned`: a look ahead went well.
template <class L>
FASTCCD_INLINE LookAhead<L> look_ahead(const SeparationRecord<L>& pair, L time, L reach, L gap, L aim, const LaneMask<L>& turned)
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    const L doubled = select<L>(turned, pair.interval + pair.interval, pair.interval);
    const LaneMask<L> stretching = less(broadcast<L>(most_plain_looks), pair.looks);
    const L interval = select<L>(stretching & less(doubled, reach + reach), broadcast<L>(first_stretch) * reach, doubled);
    // Where the distance falls, the line through the last two times and distances tells when it will be close.
    const L fall = pair.last_gap - gap;
    const LaneMask<L> falling = less(zero, fall);
    const L until_close = (gap - aim) * ((time - pair.last_time) / fall);
    const L span = min(select<L>(falling, until_close, one), select<L>(less(zero, interval), interval, one));
    return {min(time + span, one), interval, stretching | (falling & less(reach, span))};
}

/// What follows from next_look(), which has shown `separation`.
template <PairKind kind, class L>
FASTCCD_INLINE StepOutcome<L> step(SeparationRecord<L>& pair, const Separation<L>& separation, const SearchParameters& parameters, double limit)
{
    const SeparationParameters& wanted = parameters.separation;
    const SeparationBounds bounds{parameters.bounds.rho};
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    const L gap = separation.gap;
    const Positions<L> at = positions(pair.r, pair.at);
    const Reach<L> seen = reach<kind>(pair.r, separation.n, threshold_along(separation.n, pair.extents, wanted, bounds.height(kind)));
    pair.looks = pair.looks + one;

    const LaneMask<L> to_prove = less_equal(broadcast<L>(proving), pair.purpose);
    const LaneMask<L> was_ahead = less_equal(broadcast<L>(looking_ahead), pair.purpose) & !to_prove;
    const LaneMask<L> turned = way_proven<kind>(pair, at, separation, was_ahead, parameters);
    const LaneMask<L> too_far = was_ahead & !turned;

    // The look is at the time reached, but for a look too far ahead.
    const LaneMask<L> here = !(to_prove | too_far);
    const L time = select<L>(here, pair.at, pair.time);
    const L high = select<L>(here, seen.high, pair.high);
    const L next = past_window(pair, high);
    const LaneMask<L> certified = here & certified_at(seen, pair.at);
    const LaneMask<L> farther = (certified & less_equal(one, next)) | (turned & less_equal(one, time)) |
                                (here & less(broadcast<L>(limit), time));
    const LaneMask<L> at_start = here & !certified & less_equal(time, zero);

    // At time 0 a pair that is farther than d gets a positive time, however close it is.
    const L size = sum(pair.extents);
    const L close = broadcast<L>(wanted.stop) + broadcast<L>(SeparationParameters::resolution) * size;
    const L distance = distance_from_above<kind>(at, separation, less_equal(gap, close) | to_prove);
    // What is proven tells better how close nearly parallel edges are than the distance of points of theirs.
    const L shown = broadcast<L>(wanted.threshold) + broadcast<L>(SeparationBounds::close_gap()) * size;
    const LaneMask<L> near = certified & less(zero, time) & (less_equal(distance, close) | less_equal(gap, shown));
    const LaneMask<L> advancing = certified & !near & less(time * broadcast<L>(1.0 + 0x1p-50), next) &
                                  less(pair.looks, broadcast<L>(most_looks));
    const LaneMask<L> found = here & !(advancing | at_start);

    const L aim = aimed_distance(wanted, pair.extents), reach = high - time;
    const LookAhead<L> ahead = look_ahead(pair, time, reach, gap, aim, turned);
    const LaneMask<L> looks_ahead = advancing & ahead.is_worthwhile & less(next, ahead.at);
    // A look too far, at which the pair was too close already, leaves the time between to look at, once; not after a guess, since with a
    // last distance of 0 at_aim is beyond `at`.
    const L at_aim = time + (pair.last_gap - aim) * ((pair.at - time) / (pair.last_gap - gap));
    const LaneMask<L> less_far = too_far & less(pair.purpose, broadcast<L>(looking_less_far)) & less(gap, aim) & less(next, at_aim) &
                                 less(at_aim, pair.at) & less(pair.looks, broadcast<L>(most_looks));
    const L later = min(time + select<L>(near, broadcast<L>(proof_stretch) * reach, broadcast<L>(parameters.leaf_width)), one);

    pair.n = select(here, separation.n, pair.n);
    pair.high = high;
    pair.interval = select<L>(too_far, broadcast<L>(0.5) * (pair.at - pair.time), ahead.interval);
    pair.last_time = select<L>(here, time, pair.last_time);
    pair.last_gap = select<L>(here, gap, pair.last_gap);
    pair.time = select<L>((too_far & !less_far) | (advancing & !looks_ahead), next, time);
    pair.at = select<L>(found, later, select<L>(looks_ahead, ahead.at, select<L>(less_far, at_aim, pair.time)));
    pair.purpose = select<L>(found, broadcast<L>(proving),
                             select<L>(looks_ahead, broadcast<L>(looking_ahead),
                                       select<L>(less_far, broadcast<L>(looking_less_far), broadcast<L>(going_on))));

    const LaneMask<L> certain =
        less_equal(distance, broadcast<L>(wanted.certain) - broadcast<L>(bounds.distance()) * size);
    const LaneMask<L> contact = to_prove | at_start;
    const LaneMask<L> left = less_equal(broadcast<L>(most_lane_looks), pair.looks) & !(farther | contact | found);
    return {farther, contact, contact & certain, left};
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
