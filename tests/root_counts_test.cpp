// The number of roots at which there is contact, against the exact oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"

namespace fastccd::testing {
namespace {

TEST(RootCounts, GrazingContactsKeepTheParityOfTheirRoots)
{
    std::vector<oracle::Pair> pairs;
    std::size_t counted = 0, even = 0;
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const char* family : {"grazing", "f32_grazing"}) {
            generate(family, kind, 555, amount(3000), pairs);
            for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
                Options options;
                options.tolerance = tolerance;
                const Answer found = answer(kind, interleaved(pairs), options);
                for (std::size_t i = 0; i < pairs.size(); ++i) {
                    ASSERT_LE(found.roots[i], 3) << "more than a cubic has: " << lossless(pairs[i]);
                    const oracle::Verdict verdict = oracle::exact_ccd(kind, pairs[i]);
                    if (!verdict.contact) continue;  // perhaps a near miss, possible
                    ASSERT_GE(found.roots[i], 1) << tolerance << ": " << lossless(pairs[i]);
                    ++counted;
                    even += found.roots[i] % 2 == 0;
                    EXPECT_EQ(found.roots[i] % 2, verdict.roots % 2) << tolerance << ": " << lossless(pairs[i]);
                }
            }
        }
    EXPECT_GT(counted, amount(10000));
    EXPECT_GT(even, amount(1000));
}

/// Pairs that meet at k/16, k in 1..15, inside of both primitives, but for one unit in 2^24 to 2^34 in a tenth of their coordinates:
/// intervals of the search end so close to the root that the sign of the cubic there is lost in rounding, and intervals on one
/// side of it are apart as long as they are, other roots of the cubic included.
std::vector<oracle::Pair> meeting_at_ends_of_intervals(oracle::Kind kind, std::size_t count, std::uint64_t seed)
{
    std::mt19937_64 random{seed};
    const auto integer = [&](int from, int to) { return static_cast<double>(std::uniform_int_distribution{from, to}(random)); };
    // So large that other roots rarely have contact on a boundary, which counts as possible.
    constexpr int range = 30;
    std::vector<oracle::Pair> pairs(count);
    for (oracle::Pair& pair : pairs) {
        double meeting[4][3];
        for (auto& point : meeting)
            for (double& x : point) x = 4 * integer(-range, range);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto corner = [&](std::size_t i) { return meeting[i][axis]; };
            if (kind == oracle::Kind::vertex_face) {
                meeting[0][axis] = (corner(1) + corner(2) + 2 * corner(3)) / 4;
            } else {
                const double common = (corner(2) + 3 * corner(3)) / 4, direction = integer(-range, range);
                meeting[0][axis] = common - direction;
                meeting[1][axis] = common + 2 * direction;
            }
        }
        const double k = integer(1, 15), scale = std::ldexp(1.0, static_cast<int>(integer(24, 34)));
        const auto unit = [&] { return integer(0, 9) == 0 ? integer(-1, 1) : 0.0; };
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double velocity = integer(-range, range);
                pair[i][axis] = (meeting[i][axis] - velocity * k) * scale + unit();
                pair[i + 4][axis] = (meeting[i][axis] + velocity * (16 - k)) * scale + unit();
            }
    }
    return pairs;
}

TEST(RootCounts, SimpleRootsAtTheEndsOfIntervals)
{
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        const std::vector<oracle::Pair> pairs = meeting_at_ends_of_intervals(kind, amount(60000), 7);
        const Answer found = answer(kind, interleaved(pairs), {});
        std::size_t regular = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const oracle::Verdict verdict = oracle::exact_ccd(kind, pairs[i]);
            if (verdict.contact_class != oracle::Class::regular) continue;
            ++regular;
            EXPECT_EQ(found.roots[i], verdict.roots) << lossless(pairs[i]);
        }
        EXPECT_GT(regular, amount(50000));
        EXPECT_GT(found.summary.scalar_pairs, pairs.size() / 10) << "roots are not at the ends of intervals: nothing was tested";
    }
}

/// Pairs that the step mirrors at the origin, where all points meet halfway, so the cubic is (1 - 2 t)^3 times that at the start: one root,
/// where it changes sign. Around it, its values are all rounding for a long while, at whose ends they come out of their bound by little.
TEST(RootCounts, TripleRootsCountOnce)
{
    std::mt19937_64 random{11};
    std::uniform_int_distribution<int> whole{-3, 3};
    std::uniform_real_distribution<double> any{-1.0, 1.0};
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) {
        std::vector<oracle::Pair> pairs(amount(20000));
        for (oracle::Pair& pair : pairs)
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    pair[i][axis] = whole(random) < 0 ? any(random) : whole(random);
                    pair[i + 4][axis] = -pair[i][axis];
                }
        for (const double tolerance : {1e-9, 1e-12, 1e-15}) {
            Options options;
            options.tolerance = tolerance;
            const Answer found = answer(kind, interleaved(pairs), options);
            std::size_t once = 0;
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                ASSERT_LE(found.toi[i], 0.5) << tolerance << ' ' << lossless(pairs[i]);
                if (found.roots[i] == 0) continue;  // flat from the start
                ASSERT_EQ(found.roots[i], 1) << tolerance << ' ' << lossless(pairs[i]);
                ++once;
            }
            EXPECT_GT(once, pairs.size() - pairs.size() / 10) << tolerance;
        }
    }
}

}  // namespace
}  // namespace fastccd::testing
