// The last of the lanes' stages: of pairs whose contact is not proven, what the certified search says of the leaf in which it may be.
//
// From the pair's coordinates, by the search's own text and bounds, so what it says of a leaf needs no margin. That it comes to this leaf is
// either known from the stages before, or found out here, from one certificate to the next: those need margins, as the search asks for
// narrower intervals; or by the very intervals that it asks for.
#pragma once

#include <kernel_table.hpp>
#include <meeting_along_directions.hpp>
#include <search_coefficients.hpp>
#include <unscaled_pairs.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Sets the bounds of `part` to those of `whole` and `times` its margins (meeting.hpp). A certificate by bound and margin on an interval is one by
/// the bound on each part of it; and one by the bound on an interval is one by bound less margin on each part.
template <PairKind kind, class L>
FASTCCD_INLINE void set_bounds(PolynomialsOf<L>& part, const PolynomialsOf<L>& whole, double times)
{
    const L factor = broadcast<L>(times);
    part.cubic_bound = whole.cubic_bound + factor * value_margin(cubic_of(whole));
    const auto set = [&](auto& of_part, const auto& of_whole, const auto& coefficients) FASTCCD_INLINE_LAMBDA {
        of_part.bound = of_whole.bound + factor * value_margin(coefficients);
    };
    for_each_edge_and_gap<kind>(
        part, whole, [&](auto& edge, const auto& of_whole) FASTCCD_INLINE_LAMBDA { set(edge, of_whole, quadratic_of(of_whole)); },
        [&](auto& gap, const auto& of_whole) FASTCCD_INLINE_LAMBDA { set(gap, of_whole, linear_of(of_whole)); });
}

template <PairKind kind, class L>
FASTCCD_INLINE PolynomialsOf<L> with_margins(const PolynomialsOf<L>& pair)
{
    PolynomialsOf<L> sure = pair;
    set_bounds<kind>(sure, pair, 1.0);
    return sure;
}

/// Down to what those are looked for: with half a margin more, for the rounding of a value.
inline constexpr CertificateLevel level_with_margins{1.0, 1.5};

/// How many certificates, one after the other, are looked for: of triangles that move on a lattice, four leave 41 % more to the search,
/// eight 14 % less.
inline constexpr int most_certificates = 6;

/// The search finds each leaf before `time`, the start of one, apart. The start of which other leaf before which it does so, too, by one
/// certificate after the other, each from the start of the leaf in which the last one ends: no leaf is apart by two of them, so each is by
/// itself. `sure`: with_margins.
template <PairKind kind, class L>
FASTCCD_INLINE L apart_before(const PolynomialsOf<L>& pair, const PolynomialsOf<L>& sure, L time, const SearchParameters& parameters,
                              LaneMask<L> open)
{
    const L one = broadcast<L>(1.0);
    for (int k = 0; k < most_certificates && Lane<L>::bits(open) != 0; ++k) {
        const L end = last_certificate<kind>(pair, time, one, level_with_margins, open), left = interval_start(end, parameters.leaf_width);
        open = open & less(time, left);
        if (Lane<L>::bits(open) == 0) break;
        open = open & apart_on<kind>(sure, time, end);
        time = select<L>(open, left, time);
        open = open & less(left, one);
    }
    return time;
}

/// From `time`, the start of a leaf, on: past the intervals that the search halves the step to and that are apart by its own certificates and
/// bounds, as it asks for them or for one around them; to the start of a leaf, mostly the first that is not, or to the end. Wider and wider ones
/// first, then narrower and narrower ones: where a pair grazes, some ten leaves lie between the end of what is certain with margins and that leaf.
template <PairKind kind, class L>
__attribute__((noinline)) L apart_by_intervals(const PairCoefficientsOf<L>& pair, L time, double leaf_width, LaneMask<L> asked)
{
    const L one = broadcast<L>(1.0);
    const auto pass = [&](double width, LaneMask<L> lanes) FASTCCD_INLINE_LAMBDA {
        if (Lane<L>::bits(lanes) == 0) return lanes;
        const L end = time + broadcast<L>(width);  // exact: multiples of a leaf's width
        const LaneMask<L> passed = lanes & apart_on<kind>(pair, time, end);
        time = select<L>(passed, end, time);
        return passed;
    };
    double width = leaf_width;
    for (LaneMask<L> widening = asked & less(time, one); width < 1.0 && Lane<L>::bits(widening) != 0; width *= 2.0) {
        const LaneMask<L> second_half = widening & less(interval_start(time, 2.0 * width), time);
        const LaneMask<L> stopped = second_half & !pass(width, second_half);
        widening = widening & !stopped & less(time, one);
    }
    for (; leaf_width <= width; width *= 0.5) pass(width, asked & less(time, one) & less_equal(time, interval_start(time, width)));
    return time;
}

/// Those of `asked` that the search finds apart on none of the intervals that hold a leaf, but for the leaf and the step.
template <PairKind kind, class L>
__attribute__((noinline)) LaneMask<L> not_apart_around(const PairCoefficientsOf<L>& pair, L left, double leaf_width, LaneMask<L> asked)
{
    for (double width = 2.0 * leaf_width; width < 1.0 && Lane<L>::bits(asked) != 0; width *= 2.0) {
        const L start = interval_start(left, width);
        asked = asked & !apart_on<kind>(pair, start, start + broadcast<L>(width));
    }
    return asked;
}

/// In terms of lanes. Apart: throughout what was asked for, a leaf, two, or the step.
template <class L>
struct Contacts {
    LaneMask<L> reported, proven, apart;
    L time;  ///< Where reported.
};

/// What the search finds in the leaves that start at `left`.
template <PairKind kind, class L>
__attribute__((noinline)) Contacts<L> answer_in_leaf(const PairCoefficientsOf<L>& pair, L left, const SearchParameters& parameters, LaneMask<L> asked)
{
    const Throughout<L> all;
    PolynomialsOf<L> leaf = restricted_to<kind>(pair, left, left + broadcast<L>(parameters.leaf_width));
    const LaneMask<L> apart = asked & apart_on<kind>(leaf, all);
    const LaneMask<L> certain = contact_proven_on<kind>(leaf, all), proven = asked & certain & less(broadcast<L>(0.0), left);
    const LaneMask<L> open = asked & !apart & !proven;
    Contacts<L> found{proven, proven, apart, left};
    if (Lane<L>::bits(open) == 0) return found;

    add_rounding_on_parts<kind>(leaf);
    const Touch<L> touch = touch_in<kind>(leaf, pair, parameters.bounds, open);
    found.apart = apart | touch.apart;
    LaneMask<L> unanswered = open & !(touch.present | touch.apart);
    if (Lane<L>::bits(unanswered) != 0) unanswered = unanswered & !apart_by_area_on<kind>(pair, left, left + broadcast<L>(parameters.leaf_width));
    const AlongDirections<L> along = along_directions<kind>(pair, touch.lower_bound, parameters.bounds, unanswered);
    const LaneMask<L> ended = along.asked & !(along.goes_on | along.apart);
    const Meeting<L> met = meeting_after_directions<kind>(pair, along.time, parameters.leaf_width, ended);
    const LaneMask<L> answered = touch.present | met.present;
    if (Lane<L>::bits(answered) == 0) return found;
    // The search comes to this leaf if nothing around it has a certificate: if the pair meets, or if the leaf has none even by less than
    // the bounds; where neither, all that is around it is asked.
    LaneMask<L> comes_here = touch.present;
    if (Lane<L>::bits(comes_here) != 0) comes_here = comes_here & meets_at<kind>(pair, touch.time);
    if (Lane<L>::bits(answered & !comes_here) != 0) {
        set_bounds<kind>(leaf, pair, -1.0);
        comes_here = comes_here | !apart_on<kind>(leaf, all);
    }
    if (const LaneMask<L> unclear = answered & !comes_here; Lane<L>::bits(unclear) != 0)
        comes_here = comes_here | not_apart_around<kind>(pair, left, parameters.leaf_width, unclear);
    const LaneMask<L> present = touch.present & comes_here, later = met.present & comes_here;
    found.reported = proven | present | later;
    found.proven = proven | (later & met.proven);
    if (Lane<L>::bits(present) != 0) found.proven = found.proven | (present & (certain | contact_proven_near<kind>(pair, touch.time)));
    found.time = select<L>(present, touch.lower_bound, select<L>(later, along.time, left));
    return found;
}

/// What the search finds in the leaf that starts at `left` or, if that is apart, in the next one.
template <PairKind kind, class L>
FASTCCD_INLINE Contacts<L> answer_in_two_leaves(const PairCoefficientsOf<L>& pair, L left, const SearchParameters& parameters, LaneMask<L> asked)
{
    const L one = broadcast<L>(1.0), width = broadcast<L>(parameters.leaf_width), next = left + width;
    Contacts<L> found = answer_in_leaf<kind>(pair, left, parameters, asked & less_equal(next, one));
    const LaneMask<L> in_next = found.apart & less(next, one);
    if (Lane<L>::bits(in_next) == 0) return found;
    const Contacts<L> there = answer_in_leaf<kind>(pair, next, parameters, in_next);
    return {found.reported | there.reported, found.proven | there.proven, (found.apart & !in_next) | there.apart,
            select<L>(there.reported, there.time, found.time)};
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
    const LaneMask<L> unscaled = is_surely_unscaled(motion(0, 1.0), r);
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

/// How often a leaf is asked for and, if the pair is apart there and in the next one, what comes after. Apart from those that contain the
/// end of a certificate or such a leaf, all intervals have a certificate: in all the search examines 3,000 at most, below its cap, two on
/// each of 50 levels for 24 certificates and six leaves. What apart_by_intervals() passes lies beside those on the way to the leaf before it
/// and to the one at which it ends.
inline constexpr int most_leaves_asked = 3;

/// Pairs that may be in contact in any leaf.
template <PairKind kind, class L>
FASTCCD_INLINE Contacts<L> contact_anywhere(const SearchedPairs<L>& searched, const SearchParameters& parameters)
{
    const PairCoefficientsOf<L>& pair = searched.pair;
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0), width = broadcast<L>(parameters.leaf_width);
    Contacts<L> found{no_lanes<L>(), no_lanes<L>(), searched.apart, zero};
    LaneMask<L> open = searched.open;
    const LaneMask<L> at_start = open & in_contact_at_start<kind>(pair, width);
    if (Lane<L>::bits(at_start) != 0) {
        found.reported = counts_as_contact_at_start<kind>(pair, parameters.bounds, at_start);
        open = open & !at_start;
    }
    if (Lane<L>::bits(open) == 0) return found;

    const PolynomialsOf<L> sure = with_margins<kind>(pair);
    L time = zero;
    for (int k = 0; Lane<L>::bits(open) != 0; ++k) {
        const L from = time;
        time = apart_before<kind>(pair, sure, from, parameters, open);
        // Those that no certificate with margins leads on from the two leaves before.
        if (k != 0) time = apart_by_intervals<kind>(pair, time, parameters.leaf_width, open & less_equal(time, from));
        found.apart = found.apart | (open & less_equal(one, time));
        open = open & less(time, one);
        if (k == most_leaves_asked || Lane<L>::bits(open) == 0) break;
        const Contacts<L> there = answer_in_two_leaves<kind>(pair, time, parameters, open);
        found.reported = found.reported | there.reported;
        found.proven = found.proven | there.proven;
        found.time = select<L>(there.reported, there.time, found.time);
        open = open & there.apart;
        time = min(time + broadcast<L>(2.0) * width, one);
    }
    return found;
}

template <class L, bool anywhere>
void touching_block(PairKind kind, const double* block, const SearchParameters& parameters, TouchAnswers& answers)
{
    answers.reported = answers.proven = answers.apart = 0;
    const auto answer = [&]<PairKind pair_kind>(unsigned first) FASTCCD_INLINE_LAMBDA {
        const SearchedPairs<L> searched = searched_pairs<pair_kind, L>(block, first, parameters);
        Contacts<L> found;
        if constexpr (anywhere) {
            found = contact_anywhere<pair_kind>(searched, parameters);
        } else {
            const L left = Lane<L>::load(&answers.left[first]);
            found = answer_in_two_leaves<pair_kind>(searched.pair, left, parameters, searched.open);
            found.apart = searched.apart;
        }
        Lane<L>::store(&answers.time[first], found.time);
        answers.reported |= Lane<L>::bits(found.reported) << first;
        answers.proven |= Lane<L>::bits(found.proven) << first;
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
