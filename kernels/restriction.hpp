// The polynomials of a pair over a part of the step, a leaf of the search.
//
// Computed values err relative to the coefficients that they are computed from. Over a leaf in which a pair meets these are small, so what
// is computed from them, at one time or on a part of the leaf, agrees to far less than the bounds: whether there is a certificate
// hardly depends on where it is asked for.
#pragma once

#include <interval_certificates.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Calls on_edge and on_gap for each edge function and gap that a pair of this kind has, with that of `part` to be set and that of `whole`.
template <PairKind kind, class L, class OnEdge, class OnGap>
FASTCCD_INLINE void for_each_edge_and_gap(PolynomialsOf<L>& part, const PolynomialsOf<L>& whole, OnEdge on_edge, OnGap on_gap)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (int edge = 0; edge < edge_function_count(kind); ++edge) on_edge(part.edges[axis][edge], whole.edges[axis][edge]);
        for (int k = 0; k < gap_count(kind); ++k) on_gap(part.gaps[axis][k], whole.gaps[axis][k]);
    }
}

/// Over [a, b], b - a a power of two: the coefficients that coplanarity_on and the like compute, with the bounds that `whole` has.
template <PairKind kind, class L>
FASTCCD_INLINE PolynomialsOf<L> restricted_to(const PolynomialsOf<L>& whole, L a, L b)
{
    PolynomialsOf<L> part;
    part.origin = a, part.duration = b - a;
    const Cubic<L> f = coplanarity_on(whole, a, b);
    part.cubic[0] = f.c0, part.cubic[1] = f.c1, part.cubic[2] = f.c2, part.cubic[3] = f.c3;
    part.cubic_bound = whole.cubic_bound;
    for_each_edge_and_gap<kind>(
        part, whole,
        [&](auto& edge, const auto& of_whole) FASTCCD_INLINE_LAMBDA {
            const Quadratic<L> q = on_interval(quadratic_of(of_whole), a, b);
            edge = {q.c0, q.c1, q.c2, of_whole.bound};
        },
        [&](auto& gap, const auto& of_whole) FASTCCD_INLINE_LAMBDA {
            const Linear<L> g = on_interval(linear_of(of_whole), a, b);
            gap = {g.c0, g.c1, of_whole.bound};
        });
    if constexpr (kind == PairKind::vertex_face) {  // which has no fourth ones
        const L zero = broadcast<L>(0.0);
        for (auto& edges : part.edges) edges[3] = {zero, zero, zero, zero};
        for (auto& gaps : part.gaps) gaps[3] = {zero, zero, zero};
    }
    return part;
}

/// What values and coefficients on parts err by, beside what the coefficients themselves do: one lerp by 2.5 u times the larger
/// one (meeting.hpp), a fifth of u for terms in u^2. The sum with a bound rounds by u of it, which is in its slack.
template <class L>
FASTCCD_INLINE L lerp_rounding(int levels, L largest)
{
    return broadcast<L>((2.5 * levels + 0.2) * ErrorBounds::u) * largest;
}

/// Adds that to the bounds.
template <PairKind kind, class L>
FASTCCD_INLINE void add_rounding_on_parts(PolynomialsOf<L>& part)
{
    part.cubic_bound = part.cubic_bound + lerp_rounding(3, largest_magnitude(cubic_of(part)));
    for_each_edge_and_gap<kind>(
        part, part,
        [](auto& e, const auto&) FASTCCD_INLINE_LAMBDA { e.bound = e.bound + lerp_rounding(2, largest_magnitude(quadratic_of(e))); },
        [](auto& gap, const auto&) FASTCCD_INLINE_LAMBDA { gap.bound = gap.bound + lerp_rounding(1, largest_magnitude(linear_of(gap))); });
}

/// A time of the step that is not after s of [0, 1] over the part, nor before its origin: time_in_step() is rounded up by u of itself at most, and
/// (1 + u)^2 (1 - 2 u) < 1.
template <class L>
FASTCCD_INLINE L earlier_in_step(const PolynomialsOf<L>& part, L s)
{
    return max(time_in_step(part, s) * broadcast<L>(1.0 - 2 * ErrorBounds::u), part.origin);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
