// The floating-point environment that all error bounds assume.
#pragma once

#include <cfenv>

namespace fastccd {

/// While it lives, this thread rounds to nearest, keeps subnormal numbers, and does not trap; afterwards it does again what it did
/// before, and of what happened meanwhile no exception is left raised. A caller may do otherwise without knowing: a program, or a library
/// that it loads, that was linked with -ffast-math flushes subnormal numbers to zero; interval arithmetic rounds upwards; some trap
/// divisions by zero, of which lanes do many for nothing. Threads of oneTBB take it over from the one that calls (parallel_ranges.hpp).
class DefaultFloatingPoint {
public:
    DefaultFloatingPoint() noexcept;
    ~DefaultFloatingPoint();
    DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
    DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

private:
    friend class CallersFloatingPoint;
#ifdef __SSE2__
    using Environment = unsigned;  ///< MXCSR. Nothing here uses the x87 registers, whose environment takes much longer to save.
#else
    using Environment = std::fenv_t;
#endif

    Environment before_;
    bool outermost_;  ///< Of this thread.
};

/// While it lives, this thread has the environment that it had before the outermost DefaultFloatingPoint on it, if there is one: for what
/// remembers the environment in which it is made, and will be the caller's own.
class CallersFloatingPoint {
public:
    CallersFloatingPoint() noexcept;
    ~CallersFloatingPoint();
    CallersFloatingPoint(const CallersFloatingPoint&) = delete;
    CallersFloatingPoint& operator=(const CallersFloatingPoint&) = delete;

private:
    DefaultFloatingPoint::Environment before_;
};

}  // namespace fastccd
