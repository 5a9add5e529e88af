#include <default_floating_point.hpp>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace fastccd {

#ifdef __SSE2__

namespace {

/// MXCSR (Intel, Software Developer's Manual, volume 1, 10.2.3): the exceptions there were, and its value after a reset.
constexpr unsigned exceptions = 0x3f, at_reset = 0x1f80;

}  // namespace

DefaultFloatingPoint::DefaultFloatingPoint() noexcept : before_{_mm_getcsr()}
{
    if ((before_ & ~exceptions) != at_reset) _mm_setcsr(at_reset);
}

DefaultFloatingPoint::~DefaultFloatingPoint() { _mm_setcsr(before_); }

#else

DefaultFloatingPoint::DefaultFloatingPoint() noexcept
{
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
}

DefaultFloatingPoint::~DefaultFloatingPoint() { std::fesetenv(&before_); }

#endif

}  // namespace fastccd
