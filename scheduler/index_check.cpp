#include <index_check.hpp>

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace fastccd {

Status check_pairs(const std::int32_t* pairs, std::size_t count, std::size_t first_size, std::size_t second_size)
{
    const auto good = [&](std::size_t i) {
        // Bitwise, so that the loop has no branch but its own.
        return in_range(pairs[2 * i], first_size) & in_range(pairs[2 * i + 1], second_size);
    };
    constexpr std::size_t grain = 1 << 16;
    const auto scan = [&](const tbb::blocked_range<std::size_t>& range, std::size_t found) {
        bool all = true;
        for (std::size_t i = range.begin(); i != range.end(); ++i) all &= good(i);
        if (all || found < range.begin()) return found;
        std::size_t i = range.begin();
        while (good(i)) ++i;
        return std::min(found, i);
    };
    const std::size_t bad =
        count <= grain ? scan({0, count}, count)
                       : tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, count, grain), count, scan,
                                              [](std::size_t a, std::size_t b) { return std::min(a, b); });
    if (bad == count) return {};
    const bool first_is_bad = !in_range(pairs[2 * bad], first_size);
    return {Error::index_out_of_range, bad, pairs[2 * bad + (first_is_bad ? 0 : 1)]};
}

}  // namespace fastccd
