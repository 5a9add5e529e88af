#include <index_check.hpp>

#include <algorithm>

#include <parallel_ranges.hpp>

namespace fastccd {

Status check_pairs(const std::int32_t* pairs, std::size_t count, std::size_t first_size, std::size_t second_size)
{
    if (count == 0) return {};
    const auto good = [&](std::size_t i) {
        return in_range(pairs[2 * i], first_size) && in_range(pairs[2 * i + 1], second_size);
    };
    constexpr std::size_t grain = 1 << 16;
    const auto scan = [&](const Range& range, std::size_t found) {
        if (found < range.begin()) return found;
        // Extremes in 32 bits, without a branch: compilers turn this into vector instructions.
        std::int32_t least = 0, largest_first = -1, largest_second = -1;
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const std::int32_t first = pairs[2 * i], second = pairs[2 * i + 1];
            least = std::min({least, first, second});
            largest_first = std::max(largest_first, first);
            largest_second = std::max(largest_second, second);
        }
        if (least >= 0 && in_range(largest_first, first_size) && in_range(largest_second, second_size)) return found;
        std::size_t i = range.begin();
        while (good(i)) ++i;
        return std::min(found, i);
    };
    const std::size_t bad =
        reduce_ranges(count, grain, count, scan, [](std::size_t a, std::size_t b) { return std::min(a, b); });
    if (bad == count) return {};
    const bool first_is_bad = !in_range(pairs[2 * bad], first_size);
    return {Error::index_out_of_range, bad, pairs[2 * bad + (first_is_bad ? 0 : 1)]};
}

}  // namespace fastccd
