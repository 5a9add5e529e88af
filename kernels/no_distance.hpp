// Pairs that seem to meet, of a shape that amplifies rounding: edges in line or nearly parallel, or a face without area, but for rounding.
// Distances along a direction tell apart what computed positions tell apart. Where the direction that shows most tells nothing, the search
// along directions (scalar/separation_search.cpp) would hardly get on, either.
#pragma once

#include <separation_certificate.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// The motion as it is searched, with axes multiplied by the powers of two that bring their extents to [1/2, 1). They are 0 or near the
/// range that scalar/scaling.hpp leaves alone, 2^-100 to 2^100, so no power of two leaves that of doubles. Whether a pair is apart does
/// not change, and what is found along directions does not depend on the units of an axis.
template <class L>
FASTCCD_INLINE RelativeMotion<L> with_normalized_extents(const RelativeMotion<L>& r)
{
    const auto factor = [](L extent) FASTCCD_INLINE_LAMBDA {
        return select<L>(less(broadcast<L>(0.0), extent), broadcast<L>(0.5) / power_of_two(extent), broadcast<L>(1.0));
    };
    const Extents<L> e = extents(r);
    const L x = factor(e.x), y = factor(e.y), z = factor(e.z);
    const auto multiplied = [&](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA -> Vector3<L> { return {v.x * x, v.y * y, v.z * z}; };
    return {{multiplied(r.start[0]), multiplied(r.start[1]), multiplied(r.start[2])},
            {multiplied(r.end[0]), multiplied(r.end[1]), multiplied(r.end[2])}};
}

/// A pair this close, in shares of the distance at which the search along directions stops (SeparationParameters::resolution), counts as one
/// that is not apart, but at time 0. With this share one look settles nearly all pairs that stay in one plane; with all of that
/// distance more near misses would be reported.
inline constexpr double share_of_resolution = 0.25;

/// What the direction in which a pair is farthest apart at a time shows. None: it proves nothing there, or the pair is as close as that.
template <class L>
struct DirectionAt {
    LaneMask<L> none;
    L until;  ///< Where it shows something: the pair is apart from that time until then.
};

/// Of a motion with_normalized_extents.
template <PairKind kind, class L>
FASTCCD_INLINE DirectionAt<L> direction_at(const RelativeMotion<L>& normalized, const Extents<L>& e, L s, const ErrorBounds& bounds)
{
    const LookResult<L> seen = look<kind>(normalized, e, s, SeparationParameters{}, SeparationBounds{bounds.rho});
    const LaneMask<L> proven = certified_at(seen.reach, s);
    if (Lane<L>::bits(proven) == 0) return {!proven, seen.reach.high};
    const L close = broadcast<L>(share_of_resolution * SeparationParameters::resolution) * sum(e);
    const L distance = sqrt(square_distance<kind>(seen.at.r, seen.separation));
    return {!(proven & (less_equal(s, broadcast<L>(0.0)) | less(close, distance))), seen.reach.high};
}

/// Whether directions show nothing at s: the pair is as close as where the search along them stops (SeparationBounds::beyond()). Of the motion as it
/// is searched. A function of its own: much code, seldom run.
template <PairKind kind, class L>
__attribute__((noinline)) LaneMask<L> no_distance_at(const RelativeMotion<L>& r, L s, const ErrorBounds& bounds)
{
    const RelativeMotion<L> normalized = with_normalized_extents(r);
    return direction_at<kind>(normalized, extents(normalized), s, bounds).none;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
