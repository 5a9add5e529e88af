// Are all indices of the pairs in range?
#pragma once

#include <cstddef>
#include <cstdint>

#include <fastccd/options.hpp>

namespace fastccd {

inline bool in_range(std::int32_t index, std::size_t size)
{
    return index >= 0 && static_cast<std::size_t>(index) < size;
}

/// `pairs`: count pairs of indices; the first of each must be below first_size, the second below second_size.
/// The error names the first pair at fault and its index, whatever the number of threads.
Status check_pairs(const std::int32_t* pairs, std::size_t count, std::size_t first_size, std::size_t second_size);

}  // namespace fastccd
