// Which pairs the certified search leaves as they are.
#pragma once

#include <relative_motion.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// The search leaves a pair as it is if along each axis its differences have no extent or one between these (scalar/scaling.hpp); then it
/// computes what lanes do. An inner part of that range will do here.
inline constexpr double smallest_surely_unscaled = 0x1p-90, largest_surely_unscaled = 0x1p90;

template <class L>
FASTCCD_INLINE LaneMask<L> is_surely_unscaled(const RelativeMotion<L>& step, const RelativeMotion<L>& searched)
{
    const Extents<L> s = extents(step), e = extents(searched);
    const L smallest = broadcast<L>(smallest_surely_unscaled), largest = broadcast<L>(largest_surely_unscaled);
    const auto along = [&](L of_step, L of_searched) FASTCCD_INLINE_LAMBDA {
        return less_equal(of_step, broadcast<L>(0.0)) |
               (less(smallest, min(of_step, of_searched)) & less(max(of_step, of_searched), largest));
    };
    return along(s.x, e.x) & along(s.y, e.y) & along(s.z, e.z);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
