// Are all indices of the pairs in range, and can there be as many?
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <fastccd/options.hpp>

namespace fastccd {

inline bool in_range(std::int32_t index, std::size_t size)
{
    return index >= 0 && static_cast<std::size_t>(index) < size;
}

/// No array of so many elements of so many bytes exists. A negative number that became a std::size_t is the likely reason; sums of
/// such sizes would wrap around, to nothing to do.
inline bool exceeds_memory(std::size_t elements, std::size_t bytes)
{
    return elements > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / bytes;
}

/// The same of elements that are `stride` elements apart, in either direction: an address of one of them, or a stride in bytes, would wrap around.
inline bool exceeds_memory(std::size_t elements, std::ptrdiff_t stride, std::size_t bytes)
{
    const std::size_t step = stride < 0 ? std::size_t{0} - static_cast<std::size_t>(stride) : static_cast<std::size_t>(stride);
    const std::size_t most = static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / bytes;
    if (elements == 0) return false;
    return elements > most || step > most || (step > 0 && elements - 1 > (most - 1) / step);  // (elements - 1) step + 1 > most
}

/// `pairs`: count pairs of indices; the first of each must be below first_size, the second below second_size.
/// The error names the first pair at fault and its index, whatever the number of threads.
Status check_pairs(const std::int32_t* pairs, std::size_t count, std::size_t first_size, std::size_t second_size);

}  // namespace fastccd
