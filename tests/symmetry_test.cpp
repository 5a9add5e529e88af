// The same verdict however a pair is written down: corners of the face in another order, ends of an edge or both edges exchanged, axes
// exchanged, all mirrored.
//
// Times may differ by rounding: it is another vertex that the others are relative to. So may the verdict on a near miss within rounding
// (README.md, Accuracy), and with it the time of a pair that comes in contact later; contact is reported in any order.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

using Order = std::array<std::size_t, 4>;

std::vector<Order> orders(oracle::Kind kind)
{
    if (kind == oracle::Kind::vertex_face) return {{0, 2, 1, 3}, {0, 2, 3, 1}, {0, 1, 3, 2}, {0, 3, 1, 2}, {0, 3, 2, 1}};
    return {{1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 0, 1}, {2, 3, 1, 0}, {3, 2, 1, 0}};
}

oracle::Pair reordered(const oracle::Pair& pair, const Order& order)
{
    oracle::Pair result;
    for (std::size_t i = 0; i < 4; ++i) {
        result[i] = pair[order[i]];
        result[i + 4] = pair[order[i] + 4];
    }
    return result;
}

oracle::Pair with_axes_exchanged(oracle::Pair pair)
{
    for (auto& point : pair) point = {point[1], point[2], point[0]};
    return pair;
}

oracle::Pair mirrored(oracle::Pair pair)
{
    for (auto& point : pair)
        for (double& x : point) x = -x;
    return pair;
}

/// look(the pairs written down in another way)
template <class Look>
void for_each_form(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, Look look)
{
    const auto all = [&](auto change) {
        std::vector<oracle::Pair> changed;
        for (const oracle::Pair& pair : pairs) changed.push_back(change(pair));
        look(changed);
    };
    for (const Order& order : orders(kind)) all([&](const oracle::Pair& pair) { return reordered(pair, order); });
    all(with_axes_exchanged);
    all(mirrored);
}

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

/// Of families without near misses within rounding.
TEST(Symmetry, SameVerdict)
{
    const std::set<std::string> with_near_misses = {"grazing", "grazing_exact", "near_boundary", "corner", "resting", "t0_contact", "t1_contact",
                                                    "mixed_exponent", "f32_mixed_exponent"};
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            if (with_near_misses.contains(family)) continue;
            generate(family, kind, 71, amount(400), pairs);
            const Answer expected = answer(kind, interleaved(pairs), {});
            for_each_form(kind, pairs, [&](const std::vector<oracle::Pair>& changed) {
                const Answer found = answer(kind, interleaved(changed), {});
                for (std::size_t i = 0; i < pairs.size(); ++i)
                    ASSERT_EQ(expected.toi[i] <= 1.0, found.toi[i] <= 1.0) << family << ": " << lossless(pairs[i]) << "\n  as " << lossless(changed[i]);
            });
        }
}

/// Of the others: what has another verdict in some order is not in contact.
TEST(Symmetry, OtherVerdictsAreNearMisses)
{
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds) {
        std::size_t differ = 0;
        const auto compare = [&](const std::string& family) {
            const Answer expected = answer(kind, interleaved(pairs), {});
            for_each_form(kind, pairs, [&](const std::vector<oracle::Pair>& changed) {
                const Answer found = answer(kind, interleaved(changed), {});
                for (std::size_t i = 0; i < pairs.size(); ++i) {
                    if ((expected.toi[i] <= 1.0) == (found.toi[i] <= 1.0)) continue;
                    ++differ;
                    ASSERT_FALSE(oracle::exact_ccd(kind, pairs[i]).contact) << family << ": " << lossless(pairs[i]);
                }
            });
        };
        for (const char* family : {"grazing", "grazing_exact", "near_boundary", "corner", "resting", "t0_contact", "t1_contact", "mixed_exponent",
                                   "f32_mixed_exponent"}) {
            generate(family, kind, 71, amount(1000), pairs);
            compare(family);
        }
        pairs = ThinPairs{kind, 71}.next(1000);
        compare("thin");
        EXPECT_GT(differ, 0u);
    }
}

}  // namespace
}  // namespace fastccd::testing
