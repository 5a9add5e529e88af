#include <default_floating_point.hpp>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace fastccd {

namespace {

// Part of each thread from its start: where it is made at its first use, as in libraries that are loaded later, that needs memory, and glibc ends
// the program if there is none.
[[gnu::tls_model("initial-exec")]] thread_local const DefaultFloatingPoint* outermost = nullptr;

#ifdef __SSE2__

/// MXCSR (Intel, Software Developer's Manual, volume 1, 10.2.3): the exceptions there were, and its value after a reset.
constexpr unsigned exceptions = 0x3f, at_reset = 0x1f80;

unsigned environment() noexcept { return _mm_getcsr(); }

void set(unsigned value) noexcept { _mm_setcsr(value); }

void set_default(unsigned now) noexcept
{
    if ((now & ~exceptions) != at_reset) _mm_setcsr(at_reset);
}

#else

std::fenv_t environment() noexcept
{
    std::fenv_t now;
    std::fegetenv(&now);
    return now;
}

void set(const std::fenv_t& value) noexcept { std::fesetenv(&value); }

void set_default(const std::fenv_t&) noexcept { std::fesetenv(FE_DFL_ENV); }

#endif

}  // namespace

DefaultFloatingPoint::DefaultFloatingPoint() noexcept : before_{environment()}, outermost_{outermost == nullptr}
{
    if (outermost_) outermost = this;
    set_default(before_);
}

DefaultFloatingPoint::~DefaultFloatingPoint()
{
    set(before_);
    if (outermost_) outermost = nullptr;
}

CallersFloatingPoint::CallersFloatingPoint() noexcept : before_{environment()}
{
    if (outermost != nullptr) set(outermost->before_);
}

CallersFloatingPoint::~CallersFloatingPoint() { set(before_); }

}  // namespace fastccd
