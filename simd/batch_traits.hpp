// What a lane type needs of an instruction set beside what xsimd 8.1 gives (loads, arithmetic, comparisons, selection): bits of a mask, storing
// only some lanes, min / max with MINPD's rule, conversions from and to single precision, transposed records, comparisons of boxes. For each
// instruction set there is a specialization of its own, in the intrinsics of its compiler header: batch_sse2.hpp and the like.
#pragma once

#include <xsimd/xsimd.hpp>

#include <lane.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class A>
struct BatchTraits;

/// Pairs collected coordinate by coordinate.
template <class Traits, class Number>
class CoordinateCollector {
public:
    FASTCCD_INLINE CoordinateCollector(const Number* /*blocks*/, const void* const* pairs) : pairs_{pairs} {}
    FASTCCD_INLINE auto operator()(int c) const
    {
        return Traits::collect([&](unsigned lane) FASTCCD_INLINE_LAMBDA {
            return static_cast<const Number*>(pairs_[lane]) + static_cast<std::size_t>(c) * block_pairs;
        });
    }

private:
    const void* const* pairs_;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
