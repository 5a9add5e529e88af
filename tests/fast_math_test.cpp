// The headers in a program that is compiled and linked with -ffast-math. Only the library itself is not.
#include <gtest/gtest.h>

#include <bit>
#include <stdexcept>

#include <fastccd/adapters/ipc_toolkit.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

constexpr std::uint64_t infinity = 0x7ff0'0000'0000'0000, quiet_nan = 0x7ff8'0000'0000'0000;

bool ask(oracle::Kind kind, const oracle::Pair& pair, double& toi, double min_distance = 0.0, double tmax = 1.0, double tolerance = 1e-6)
{
    NarrowPhaseCCD ccd;
    ccd.tolerance = tolerance;
    Eigen::Vector3d x[8];
    for (std::size_t i = 0; i < 8; ++i) x[i] = {pair[i][0], pair[i][1], pair[i][2]};
    return kind == oracle::Kind::vertex_face
        ? ccd.point_triangle_ccd(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], toi, min_distance, tmax)
        : ccd.edge_edge_ccd(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], toi, min_distance, tmax);
}

TEST(FastMath, ApartIsNotInContact)
{
    std::size_t contacts = 0, apart = 0;
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 72, 100, pairs);
            // Verdicts depend neither on the tolerance nor on the caller's arithmetic.
            const Answer expected = answer(kind, interleaved(pairs), {});
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                double toi = -1.0;
                const bool hit = ask(kind, pairs[i], toi), is_apart = std::bit_cast<std::uint64_t>(expected.toi[i]) == infinity;
                ASSERT_EQ(hit, !is_apart) << family << ' ' << lossless(pairs[i]);
                ASSERT_EQ(std::bit_cast<std::uint64_t>(toi) == infinity, is_apart) << family << ' ' << lossless(pairs[i]);
                ++(hit ? contacts : apart);
            }
        }
    EXPECT_GT(contacts, 1000u);
    EXPECT_GT(apart, 1000u);
}

/// Written out, because this program flushes subnormal results.
TEST(FastMath, SubnormalCoordinates)
{
    constexpr double one = 0x1p-1070;
    const oracle::Pair falling{{{0, 0, one}, {-one, -one, 0}, {one, -one, 0}, {0, one, 0}, {0, 0, -one}, {-one, -one, 0}, {one, -one, 0}, {0, one, 0}}};
    const oracle::Pair above{{{0, 0, one}, {-one, -one, 0}, {one, -one, 0}, {0, one, 0}, {0, 0, one}, {-one, -one, 0}, {one, -one, 0}, {0, one, 0}}};
    double toi = -1.0;
    EXPECT_TRUE(ask(oracle::Kind::vertex_face, falling, toi));
    EXPECT_LE(toi, 0.5);
    EXPECT_FALSE(ask(oracle::Kind::vertex_face, above, toi));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(toi), infinity);
}

TEST(FastMath, WhatCannotBeAnsweredThrows)
{
    const oracle::Pair falling{{{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, -1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
    double toi = -1.0;
    for (const std::uint64_t bits : {infinity, quiet_nan}) {
        const auto number = std::bit_cast<double>(bits);
        oracle::Pair broken = falling;
        broken[3][1] = number;
        for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge}) EXPECT_THROW(ask(kind, broken, toi), std::invalid_argument);
        EXPECT_THROW(ask(oracle::Kind::vertex_face, falling, toi, number), std::invalid_argument);
        EXPECT_THROW(ask(oracle::Kind::vertex_face, falling, toi, 0.0, number), std::invalid_argument);
    }
    EXPECT_THROW(ask(oracle::Kind::vertex_face, falling, toi, 0.0, 1.0, std::bit_cast<double>(quiet_nan)), std::invalid_argument);
    EXPECT_THROW(ask(oracle::Kind::vertex_face, falling, toi, -0.1), std::invalid_argument);
}

/// What headers compute by themselves.
TEST(FastMath, NoContactIsTheEarliestOfNone)
{
    const auto toi_of = [](const Summary& summary) { return std::bit_cast<std::uint64_t>(summary.earliest.toi); };
    const double apart[pair_coordinates] = {0, 0, 1, -1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, 1, -1, -1, 0, 1, -1, 0, 0, 1, 0};
    const double falling[pair_coordinates] = {0, 0, 1, -1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, -1, -1, -1, 0, 1, -1, 0, 0, 1, 0};
    Summary sum;
    for (std::size_t piece = 0; const double* const pair : {apart, falling, apart, falling}) {
        Summary part;
        std::vector<Contact> contacts;
        ASSERT_TRUE(find_contacts(PairKind::vertex_face, PairView::interleaved(pair, 1), {}, contacts, nullptr, &part).ok());
        ASSERT_EQ(part.earliest.pair == no_pair, contacts.empty());
        sum.add(part, piece);
        ASSERT_EQ(sum.earliest.pair, piece == 0 ? no_pair : 1u) << "after piece " << piece;
        ASSERT_EQ(toi_of(sum) == infinity, piece == 0);
        ++piece;
    }
    EXPECT_EQ(toi_of(Summary{}), infinity);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(PairToi{}.toi), quiet_nan);
}

}  // namespace
}  // namespace fastccd::testing
