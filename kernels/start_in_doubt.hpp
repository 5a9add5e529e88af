// Pairs that seem to be in contact at time 0, of a shape that amplifies rounding: edges in line, or a face without area, but for rounding.
//
// The search with a separation goes on from there, without any separation (scalar/certified_search.cpp). For most its first look, by which
// nothing is proven to be apart, is its last, too.
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

/// Whether that look proves nothing at time 0: contact there is the answer. Of the motion as it is searched.
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> stays_in_contact_at_start(const RelativeMotion<L>& r, const ErrorBounds& bounds)
{
    const RelativeMotion<L> equal = with_equal_extents(r);
    const L zero = broadcast<L>(0.0);
    const Sight<L> sight = look<kind>(equal, extents(equal), zero, SeparationParameters{}, SeparationBounds{bounds.rho});
    return !certified_at(sight.reach, zero);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
