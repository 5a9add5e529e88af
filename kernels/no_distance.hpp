// Pairs that seem to meet, of a shape that amplifies rounding: edges in line or nearly parallel, or a face without area, but for rounding.
// Distances along a direction tell apart what computed positions tell apart, and where they tell nothing at the time from which the search
// along directions (scalar/separation_search.cpp) would go on, it ends there, too.
#pragma once

#include <separation_certificate.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// The motion as it is searched, with axes multiplied by the powers of two that bring their extents to [1/2, 1). They are 0 or near the
/// range that scalar/scaling.hpp leaves alone, 2^-100 to 2^100, so no power of two leaves that of doubles. Whether a pair is apart does
/// not change, and what is found along directions does not depend on the units of an axis.
template <class L>
FASTCCD_INLINE RelativeMotion<L> with_equal_extents(const RelativeMotion<L>& r)
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

/// Whether the direction in which the pair is farthest apart at s proves nothing there. Of the motion as it is searched. A function of its
/// own: much code, seldom run.
template <PairKind kind, class L>
__attribute__((noinline)) LaneMask<L> no_distance_at(const RelativeMotion<L>& r, L s, const ErrorBounds& bounds)
{
    const RelativeMotion<L> equal = with_equal_extents(r);
    const Sight<L> sight = look<kind>(equal, extents(equal), s, SeparationParameters{}, SeparationBounds{bounds.rho});
    return !certified_at(sight.reach, s);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
