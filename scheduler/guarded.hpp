// What surrounds every call of the public interface: nothing is thrown across it, and arithmetic is what the bounds assume.
#pragma once

#include <fastccd/options.hpp>

#include <default_floating_point.hpp>

namespace fastccd {

/// What the call returns. All that can be thrown below the entry points is for want of something: std::bad_alloc,
/// std::length_error of a vector, and what oneTBB throws if the system refuses it memory or a thread.
template <class Call>
Status guarded(const Call& call) noexcept
{
    const DefaultFloatingPoint defaults;
    try {
        return call();
    } catch (...) {
        return {Error::out_of_memory};
    }
}

}  // namespace fastccd
