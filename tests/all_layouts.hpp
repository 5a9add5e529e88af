// The same pairs in every packed layout.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "narrow_phase.hpp"

namespace fastccd::testing {

/// Of coordinates rounded to Number, float or double.
template <class Number>
struct AllLayouts {
    std::vector<Number> records, blocked, columns;
    std::vector<std::pair<std::string, PairView>> views;  ///< Name and pairs of each.

    explicit AllLayouts(const std::vector<oracle::Pair>& pairs)
        : records(pairs.size() * pair_coordinates), blocked((pairs.size() + block_pairs - 1) / block_pairs * block_coordinates),
          columns(records.size())
    {
        std::array<const Number*, pair_coordinates> column{};
        for (std::size_t i = 0; i < pairs.size(); ++i)
            for (std::size_t c = 0; c < pair_coordinates; ++c) {
                const auto value = static_cast<Number>(pairs[i][c / 3][c % 3]);
                records[i * pair_coordinates + c] = value;
                blocked[blocked_index(i, c)] = value;
                columns[c * pairs.size() + i] = value;
                column[c] = &columns[c * pairs.size()];
            }
        const std::string numbers = sizeof(Number) == sizeof(float) ? "floats" : "doubles";
        views = {{numbers + ", interleaved", PairView::interleaved(records.data(), pairs.size())},
                 {numbers + ", blocked", PairView::blocked(blocked.data(), pairs.size())},
                 {numbers + ", strided", PairView::strided(column, 1, pairs.size())}};
    }
    AllLayouts(const AllLayouts&) = delete;
    AllLayouts& operator=(const AllLayouts&) = delete;
};

}  // namespace fastccd::testing
