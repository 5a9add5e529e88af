// The paper's random test (Table 1): ten million vertex-face pairs, every position uniform in the unit cube.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "random_pairs.hpp"

namespace fastccd::testing {
namespace {

struct Counts {
    std::size_t contacts = 0, odd = 0, even = 0;
};

/// In chunks: the whole would be 1.9 GB.
Counts count(std::uint64_t seed, std::size_t pairs, double tolerance)
{
    constexpr std::size_t chunk = 1 << 18;
    PairBuffer buffer{chunk};
    std::vector<double> toi(chunk);
    std::vector<std::uint8_t> roots(chunk);
    Options options;
    options.tolerance = tolerance;
    Counts total;
    for (std::size_t first = 0; first < pairs; first += chunk) {
        const std::size_t size = std::min(chunk, pairs - first);
        tools::fill_random_pairs(seed, first, buffer);
        Summary summary;
        const Status status = time_of_impact(PairKind::vertex_face, PairView::blocked(buffer.data(), size), options,
                                             {toi.data(), size}, &summary, {roots.data(), size});
        EXPECT_TRUE(status.ok()) << message(status.error);
        total.contacts += summary.contacts;
        total.odd += summary.odd;
        total.even += summary.even;
    }
    return total;
}

TEST(RandomCounts, AgreeWithThePaper)
{
    constexpr std::size_t pairs = 10'000'000;
    for (const std::uint64_t seed : {1u, 2u}) {
        const Counts found = count(seed, pairs, 1e-9);
        std::printf("seed %llu: %zu odd, %zu even (paper: 749985, 22779)\n", static_cast<unsigned long long>(seed), found.odd, found.even);
        // Five standard deviations of the difference between two such samples, sqrt(2 n p (1 - p)).
        EXPECT_NEAR(static_cast<double>(found.odd), 749985.0, 5900.0);
        EXPECT_NEAR(static_cast<double>(found.even), 22779.0, 1070.0);
        EXPECT_EQ(found.odd + found.even, found.contacts) << "roots of random contacts can all be counted";
    }
}

TEST(RandomCounts, DoNotDependOnTheTolerance)
{
    constexpr std::size_t pairs = 2'000'000;
    const Counts expected = count(3, pairs, 1e-9);
    for (const double tolerance : {1e-6, 1e-10, 1e-11, 1e-12, 1e-13}) {
        const Counts found = count(3, pairs, tolerance);
        EXPECT_EQ(found.contacts, expected.contacts) << tolerance;
        EXPECT_EQ(found.odd, expected.odd) << tolerance;
    }
}

}  // namespace
}  // namespace fastccd::testing
