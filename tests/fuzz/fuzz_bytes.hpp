// What every fuzzer of a reader does: any bytes are read, or refused by InputError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <tools/input_error.hpp>

namespace fastccd::testing {

template <class Read>
int read_or_refuse(const std::uint8_t* data, std::size_t size, Read read)
{
    try {
        read(std::string_view{reinterpret_cast<const char*>(data), size});
    } catch (const tools::InputError&) {
        return 0;
    }
    return 0;
}

/// Aborts, so that the fuzzer keeps the input.
inline void require(bool holds)
{
    if (!holds) __builtin_trap();
}

}  // namespace fastccd::testing
