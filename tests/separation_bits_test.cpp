// Minimum separation gives the same bits everywhere: instruction sets, layouts, threads, packed and indexed pairs, dense,
// compact and earliest answers, against the scalar search; and what it refuses.
#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "followed_pairs.hpp"
#include "generators.hpp"
#include "mesh_of_pairs.hpp"
#include "narrow_phase.hpp"
#include "test_data.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};
constexpr double distances[] = {1e-300, 1e-9, 1e-3, 0.1, 1.0, 1e30};

Options options_for(double d, Isa isa = Isa::automatic)
{
    Options options;
    options.minimum_separation = d;
    options.isa = isa;
    return options;
}

Answer reference(oracle::Kind kind, const PairView& pairs, Options options)
{
    options.isa = Isa::automatic;
    options.reference = true;
    return answer(kind, pairs, options);
}

void expect_same(const Answer& expected, const Answer& found, const std::string& what)
{
    const std::size_t i = first_difference(expected, found);
    ASSERT_EQ(i, expected.toi.size()) << what << ": pair " << i << ": toi " << found.toi[i] << " instead of " << expected.toi[i];
    EXPECT_EQ(expected.summary.contacts, found.summary.contacts) << what;
    EXPECT_EQ(expected.summary.proven, found.summary.proven) << what;
    EXPECT_EQ(expected.summary.at_start, found.summary.at_start) << what;
    EXPECT_EQ(expected.summary.invalid, found.summary.invalid) << what;
    EXPECT_EQ(expected.summary.earliest.pair, found.summary.earliest.pair) << what;
    EXPECT_EQ(expected.summary.earliest.proven, found.summary.earliest.proven) << what;
    EXPECT_EQ(expected.summary.earliest.at_start, found.summary.earliest.at_start) << what;
}

/// Of every family, some with a NaN or an infinity.
std::vector<oracle::Pair> mixed_with_invalid_pairs(oracle::Kind kind, std::uint64_t seed, std::size_t per_family)
{
    std::vector<oracle::Pair> pairs = mixed_pairs(kind, seed, per_family);
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 50; i < pairs.size(); i += 101) pairs[i][i % 8][i % 3] = bad[i / 101 % 3];
    return pairs;
}

TEST(SeparationBits, IsasOnMadePairs)
{
    for (const auto kind : kinds) {
        const auto pairs = mixed_with_invalid_pairs(kind, 121, 101);
        const PairBuffer buffer = to_buffer(pairs);
        for (const double d : distances)
            for (const double t_max : {1.0, 0.7, 1e-4}) {
                Options options = options_for(d);
                options.t_max = t_max;
                const Answer expected = reference(kind, buffer.view(), options);
                EXPECT_GT(expected.summary.invalid, 40u);
                for (const Isa isa : isas_to_test()) {
                    options.isa = isa;
                    const Answer found = answer(kind, buffer.view(), options);
                    EXPECT_EQ(found.summary.isa, isa);
                    expect_same(expected, found, std::string(kind_name(kind)) + ' ' + name(isa) + " d " + std::to_string(d));
                }
            }
    }
}

/// Lanes leave them to the scalar search, wherever they stand among others.
TEST(SeparationBits, FollowedPairs)
{
    for (const auto& [kind, d, followed] : followed_pairs) {
        std::vector<oracle::Pair> pairs = mixed_with_invalid_pairs(kind, 125, 11);
        std::size_t count = 0;
        for (std::size_t i = 0; i < pairs.size(); i += 3 + i % 4, ++count) pairs[i] = followed;
        const PairBuffer buffer = to_buffer(pairs);
        const Answer expected = reference(kind, buffer.view(), options_for(d));
        for (std::size_t i = 0; i < pairs.size(); ++i)
            EXPECT_TRUE(pairs[i] != followed || expected.toi[i] == std::numeric_limits<double>::infinity()) << i;
        for (const Isa isa : isas_to_test()) {
            const Answer found = answer(kind, buffer.view(), options_for(d, isa));
            EXPECT_GE(found.summary.scalar_pairs, count);
            EXPECT_LT(found.summary.scalar_pairs, count + pairs.size() / 4);
            expect_same(expected, found, std::string(kind_name(kind)) + ' ' + name(isa) + " followed pairs");
        }
    }
}

TEST(SeparationBits, IsasOnPublicData)
{
    const auto data = data_directory();
    if (!data) GTEST_SKIP() << no_data_message;
    for (const QuerySet& set : load_hardcases(*data))
        for (const double d : {1e-9, 1e-3}) {
            const Answer expected = reference(set.kind, interleaved(set.pairs), options_for(d));
            for (const Isa isa : isas_to_test())
                expect_same(expected, answer(set.kind, interleaved(set.pairs), options_for(d, isa)), set.name + ' ' + name(isa));
        }
}

TEST(SeparationBits, LayoutsAndCompactAnswers)
{
    for (const auto kind : kinds) {
        auto pairs = mixed_with_invalid_pairs(kind, 122, 37);
        pairs.resize(pairs.size() / 8 * 8 - 3);
        const Answer expected = reference(kind, interleaved(pairs), options_for(1e-2));
        std::vector<double> columns(pairs.size() * pair_coordinates);
        std::array<const double*, pair_coordinates> column{};
        for (std::size_t c = 0; c < pair_coordinates; ++c) {
            column[c] = &columns[c * pairs.size()];
            for (std::size_t i = 0; i < pairs.size(); ++i) columns[c * pairs.size() + i] = pairs[i][c / 3][c % 3];
        }
        const PairBuffer buffer = to_buffer(pairs);
        for (const Isa isa : isas_to_test()) {
            const Options options = options_for(1e-2, isa);
            expect_same(expected, answer(kind, buffer.view(), options), "blocked");
            expect_same(expected, answer(kind, interleaved(pairs), options), "interleaved");
            expect_same(expected, answer(kind, PairView::strided(column, 1, pairs.size()), options), "strided");

            std::vector<Contact> contacts;
            std::vector<std::size_t> invalid;
            ASSERT_TRUE(find_contacts(pair_kind(kind), buffer.view(), options, contacts, &invalid).ok());
            auto contact = contacts.begin();
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (!std::isfinite(expected.toi[i])) continue;
                ASSERT_NE(contact, contacts.end());
                EXPECT_EQ(contact->pair, i);
                EXPECT_EQ(contact->toi, expected.toi[i]);
                EXPECT_EQ(contact->at_start, expected.toi[i] == 0.0);
                ++contact;
            }
            EXPECT_EQ(contact, contacts.end());
            EXPECT_EQ(invalid.size(), expected.summary.invalid);
        }
    }
}

TEST(SeparationBits, Threads)
{
    for (const auto kind : kinds) {
        const PairBuffer buffer = to_buffer(mixed_with_invalid_pairs(kind, 123, 301));
        const Answer expected = reference(kind, buffer.view(), options_for(1e-3));
        for (const int threads : {1, 2, 3, 7}) {
            tbb::global_control limit{tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)};
            tbb::task_arena arena{threads};
            arena.execute([&] { expect_same(expected, answer(kind, buffer.view(), options_for(1e-3)), std::to_string(threads) + " threads"); });
        }
    }
}

TEST(SeparationBits, AnyLaneAndAnyNeighbours)
{
    for (const auto kind : kinds) {
        const auto pairs = mixed_with_invalid_pairs(kind, 124, 3);
        const Answer expected = reference(kind, interleaved(pairs), options_for(1e-2));
        for (std::size_t offset = 0; offset < 9; ++offset)
            for (const std::size_t size : {1u, 2u, 7u, 8u, 9u, 15u, 17u, 33u}) {
                const std::vector<oracle::Pair> part(pairs.begin() + static_cast<std::ptrdiff_t>(offset),
                                                     pairs.begin() + static_cast<std::ptrdiff_t>(offset + size));
                for (const Isa isa : isas_to_test()) {
                    const Answer found = answer(kind, to_buffer(part).view(), options_for(1e-2, isa));
                    for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(found.toi[i], expected.toi[offset + i]);
                }
            }
    }
}

/// Positions, and d with them, times a power of two; far enough that the scalar search has to scale them back.
TEST(SeparationBits, PowerOfTwoScale)
{
    for (const auto kind : kinds)
        for (const char* family : {"uniform", "simcloth", "boundary", "degenerate", "grazing"}) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 125, 200, pairs);
            const Answer expected = answer(kind, interleaved(pairs), options_for(1e-2));
            for (const double scale : {0x1p40, 0x1p-40, 0x1p200, 0x1p-200, 0x1p900, 0x1p-900}) {
                auto scaled = pairs;
                for (auto& pair : scaled)
                    for (auto& point : pair)
                        for (double& x : point) x *= scale;
                expect_same(expected, answer(kind, interleaved(scaled), options_for(1e-2 * scale)), std::string(family) + " scaled");
            }
        }
}

TEST(SeparationBits, EarliestIsTheMinimumOfTheDenseAnswer)
{
    for (const auto kind : kinds)
        for (const char* family : {"uniform", "simcloth", "grazing", "near_boundary", "scale"}) {
            for (const std::size_t first : {0u, 1u, 2u, 3u})
                for (const double t_max : {1.0, 0.7}) {
                    std::vector<oracle::Pair> pairs;
                    generate(family, kind, 126 + first, 6000, pairs);
                    Options options = options_for(1e-4);
                    options.t_max = t_max;
                    // Without those at the start, which end the search at once.
                    Answer dense = answer(kind, interleaved(pairs), options);
                    std::vector<oracle::Pair> later;
                    for (std::size_t i = 0; i < pairs.size(); ++i)
                        if (dense.toi[i] != 0.0) later.push_back(pairs[i]);
                    for (const auto* const set : {&pairs, &later}) {
                        dense = answer(kind, interleaved(*set), options);
                        for (const Isa isa : isas_to_test()) {
                            options.isa = isa;
                            Contact earliest;
                            Summary summary;
                            ASSERT_TRUE(earliest_contact(pair_kind(kind), interleaved(*set), options, earliest, &summary).ok());
                            EXPECT_EQ(earliest.pair, dense.summary.earliest.pair) << family;
                            EXPECT_EQ(earliest.toi, dense.summary.earliest.toi) << family;
                            EXPECT_EQ(earliest.proven, dense.summary.earliest.proven) << family;
                            EXPECT_EQ(earliest.at_start, dense.summary.earliest.at_start) << family;
                        }
                    }
                }
        }
}

TEST(SeparationBits, IndexedPairs)
{
    for (const auto kind : kinds) {
        const auto pairs = mixed_with_invalid_pairs(kind, 127, 31);
        const MeshOfPairs made{pairs};
        const MovingMesh mesh = made.mesh();
        const Answer expected = reference(kind, interleaved(pairs), options_for(1e-3));
        for (const Isa isa : isas_to_test()) {
            Answer found;
            found.toi.resize(pairs.size());
            found.roots.resize(pairs.size());
            const Status status =
                kind == oracle::Kind::vertex_face
                    ? time_of_impact(mesh, std::span<const VertexFace>(made.vertex_face), options_for(1e-3, isa), found.toi, &found.summary)
                    : time_of_impact(mesh, std::span<const EdgeEdge>(made.edge_edge), options_for(1e-3, isa), found.toi, &found.summary);
            ASSERT_TRUE(status.ok());
            expect_same(expected, found, std::string("indexed ") + name(isa));
        }
    }
}

TEST(SeparationBits, WithoutSeparationNothingChanges)
{
    for (const auto kind : kinds) {
        const auto pairs = mixed_with_invalid_pairs(kind, 128, 37);
        Options options = options_for(0.0);
        options.distance_tolerance = 0.5;
        const Answer found = answer(kind, interleaved(pairs), options);
        expect_same(answer(kind, interleaved(pairs), {}), found, "d = 0");
        EXPECT_EQ(found.summary.at_start, 0u);
        EXPECT_GT(found.summary.odd, 0u);
    }
}

TEST(SeparationBits, RefusesBadOptions)
{
    std::vector<oracle::Pair> pairs;
    generate("uniform", oracle::Kind::vertex_face, 129, 3, pairs);
    const auto error_of = [&](const Options& options) {
        std::vector<double> toi(3);
        return time_of_impact(PairKind::vertex_face, interleaved(pairs), options, toi).error;
    };
    constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {-1e-300, -1.0, nan, infinity, -infinity}) {
        EXPECT_EQ(error_of(options_for(bad)), Error::bad_minimum_separation) << bad;
        Options options = options_for(1e-3);
        options.distance_tolerance = bad;
        EXPECT_EQ(error_of(options), Error::bad_distance_tolerance) << bad;
    }
    Options options = options_for(1e-3);
    options.exact = true;
    EXPECT_EQ(error_of(options), Error::exact_separation);
    for (const Error error : {Error::bad_minimum_separation, Error::bad_distance_tolerance, Error::exact_separation})
        EXPECT_STRNE(message(error), "unknown error");
    EXPECT_EQ(error_of(options_for(std::numeric_limits<double>::max())), Error::none);
}

}  // namespace
}  // namespace fastccd::testing
