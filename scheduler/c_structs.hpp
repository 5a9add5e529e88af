// Structs of the C interface, whose callers may know fewer or more fields than this version: each begins with its `size`.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace fastccd {

/// No struct will ever be as large: its size was not set.
inline constexpr std::size_t most_size = 4096;

/// Copies a struct of the caller into `known`; false if its size is not set, or if fields that this version does not know
/// are not 0.
template <class Struct>
bool read_struct(const Struct& given, std::size_t least, Struct& known)
{
    const std::size_t size = given.size;
    if (size < std::min(least, sizeof(Struct)) || size > most_size) return false;
    std::memcpy(&known, &given, std::min(size, sizeof(Struct)));
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&given);
    return size <= sizeof(Struct) || std::all_of(bytes + sizeof(Struct), bytes + size, [](unsigned char byte) { return byte == 0; });
}

/// Writes what the caller's struct has room for, and zeros into fields this version does not know.
template <class Struct>
void write_struct(Struct known, Struct& given)
{
    const std::size_t size = known.size = given.size;
    std::memcpy(&given, &known, std::min(size, sizeof(Struct)));
    if (size > sizeof(Struct)) std::memset(reinterpret_cast<unsigned char*>(&given) + sizeof(Struct), 0, size - sizeof(Struct));
}

/// Whether the caller's struct, if there is one, can be written.
template <class Struct>
bool has_size(const Struct* given, std::size_t least)
{
    return given == nullptr || (given->size >= std::min(least, sizeof(Struct)) && given->size <= most_size);
}

}  // namespace fastccd
