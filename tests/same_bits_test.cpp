// The same bits everywhere: instruction sets x layouts x thread counts, against the certified search.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "amount.hpp"
#include "all_layouts.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "test_data.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

Answer reference(oracle::Kind kind, const PairView& pairs, double tolerance, double t_max = 1.0)
{
    Options options;
    options.tolerance = tolerance;
    options.t_max = t_max;
    options.reference = true;
    return answer(kind, pairs, options);
}

void expect_same(const Answer& expected, const Answer& found, const std::string& what)
{
    const std::size_t i = first_difference(expected, found);
    ASSERT_EQ(i, expected.toi.size()) << what << ": pair " << i << ": toi " << found.toi[i] << " instead of "
                                      << expected.toi[i] << ", roots " << int{found.roots[i]} << " instead of "
                                      << int{expected.roots[i]};
    EXPECT_EQ(expected.summary.contacts, found.summary.contacts) << what;
    EXPECT_EQ(expected.summary.proven, found.summary.proven) << what;
    EXPECT_EQ(expected.summary.odd, found.summary.odd) << what;
    EXPECT_EQ(expected.summary.even, found.summary.even) << what;
    EXPECT_EQ(expected.summary.invalid, found.summary.invalid) << what;
    EXPECT_EQ(expected.summary.earliest.pair, found.summary.earliest.pair) << what;
}

void expect_same_on_every_isa(oracle::Kind kind, const PairView& pairs, double tolerance, const std::string& what,
                              double t_max = 1.0)
{
    const Answer expected = reference(kind, pairs, tolerance, t_max);
    for (const Isa isa : isas_to_test()) {
        Options options;
        options.tolerance = tolerance;
        options.t_max = t_max;
        options.isa = isa;
        const Answer found = answer(kind, pairs, options);
        EXPECT_EQ(found.summary.isa, isa);
        expect_same(expected, found, what + " " + name(isa));

        const Answer times = answer_without_roots(kind, pairs, options);
        EXPECT_EQ(0, std::memcmp(times.toi.data(), found.toi.data(), found.toi.size() * sizeof(double)))
            << what << ' ' << name(isa) << ": other times if roots are not counted";
        EXPECT_EQ(times.summary.proven, found.summary.proven) << what << ' ' << name(isa);
    }
}

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

TEST(SameBits, IsasOnMadePairs)
{
    for (const auto kind : kinds) {
        const auto pairs = mixed_pairs(kind, 31, amount(101));
        const PairBuffer buffer = to_buffer(pairs);
        for (const double tolerance : {1.0, 0.3, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15})
            expect_same_on_every_isa(kind, buffer.view(), tolerance, std::string(kind_name(kind)) + " E_tol " + std::to_string(tolerance));
        for (const double t_max : {0.7, 1e-4})
            expect_same_on_every_isa(kind, buffer.view(), 1e-9, std::string(kind_name(kind)) + " t_max", t_max);
    }
}

TEST(SameBits, IsasOnManyUniformPairs)
{
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds) {
        generate("uniform", kind, 32, amount(16 * 4096 + 7), pairs);  // full tiles, and less than a block
        expect_same_on_every_isa(kind, to_buffer(pairs).view(), 1e-9, std::string(kind_name(kind)) + ", blocked");
        expect_same_on_every_isa(kind, interleaved(pairs), 1e-9, std::string(kind_name(kind)) + ", interleaved");
    }
}

TEST(SameBits, IsasOnPublicData)
{
    const auto data = data_directory();
    if (!data) GTEST_SKIP() << no_data_message;
    auto sets = load_hardcases(*data);
    for (QuerySet& set : load_queries(*data)) sets.push_back(std::move(set));
    for (QuerySet& set : sets) set.pairs.resize(amount(set.pairs.size()));
    for (const double tolerance : {1e-6, 1e-9, 1e-12})
        for (const QuerySet& set : sets)
            expect_same_on_every_isa(set.kind, interleaved(set.pairs), tolerance, set.name + " E_tol " + std::to_string(tolerance));
}

TEST(SameBits, Layouts)
{
    for (const auto kind : kinds) {
        auto pairs = mixed_pairs(kind, 33, 37);
        pairs.resize(pairs.size() - 3);  // no multiple of 8
        const Answer expected = reference(kind, interleaved(pairs), 1e-9);
        const PairBuffer buffer = to_buffer(pairs);
        const std::size_t numbers = (pairs.size() + block_pairs - 1) / block_pairs * block_coordinates;
        std::vector<double> shifted(numbers + 1);  // allocators align to 16 bytes, so one double later is never the start of a line
        std::memcpy(&shifted[1], buffer.view().data(), numbers * sizeof(double));
        std::vector<double> shifted_records(pairs.size() * pair_coordinates + 1);
        std::memcpy(&shifted_records[1], pairs.data(), pairs.size() * pair_coordinates * sizeof(double));

        // 24 columns, and the same backwards with a negative stride; 8 columns of x y z triples.
        std::vector<double> columns(pairs.size() * pair_coordinates), backwards(columns.size()), points(columns.size());
        std::array<const double*, pair_coordinates> forward{}, reversed{}, triples{};
        for (std::size_t c = 0; c < pair_coordinates; ++c) {
            forward[c] = &columns[c * pairs.size()];
            reversed[c] = &backwards[(c + 1) * pairs.size() - 1];
            triples[c] = &points[c / 3 * 3 * pairs.size() + c % 3];
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                columns[c * pairs.size() + i] = pairs[i][c / 3][c % 3];
                backwards[(c + 1) * pairs.size() - 1 - i] = pairs[i][c / 3][c % 3];
                points[3 * (c / 3 * pairs.size() + i) + c % 3] = pairs[i][c / 3][c % 3];
            }
        }
        for (const Isa isa : isas_to_test()) {
            Options options;
            options.isa = isa;
            const auto expect = [&](const PairView& view, const char* layout) {
                expect_same(expected, answer(kind, view, options), std::string(layout) + ' ' + name(isa));
            };
            expect(buffer.view(), "blocked");
            expect(PairView::blocked(&shifted[1], pairs.size()), "blocked, not aligned");
            expect(interleaved(pairs), "interleaved");
            expect(PairView::interleaved(&shifted_records[1], pairs.size()), "interleaved, not aligned");
            expect(PairView::strided(forward, 1, pairs.size()), "strided");
            expect(PairView::strided(reversed, -1, pairs.size()), "strided backwards");
            expect(PairView::strided(triples, 3, pairs.size()), "strided triples");
        }
    }
}

TEST(SameBits, FloatLayoutsWidenExactly)
{
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> pairs, more;
        for (const char* family : {"f32_uniform", "f32_boundary", "f32_simcloth", "f32_degenerate", "f32_extreme_scale", "f32_mixed_exponent"}) {
            generate(family, kind, 34, 203, more);
            pairs.insert(pairs.end(), more.begin(), more.end());
        }
        // Differences of floats that single precision does not hold, that are below its normal range or above all of it, and what is no number.
        const std::size_t finite = pairs.size();
        for (std::size_t i = 0; i < finite; i += 7)
            for (const double factor : {0x1p-149, 0x1p-126, 0x1p126}) {
                oracle::Pair pair = pairs[i];
                for (auto& point : pair)
                    for (double& x : point) x = static_cast<float>(std::clamp(factor * x, -0x1p127, 0x1p127));
                pairs.push_back(pair);
            }
        for (std::size_t i = 0; i < finite; i += 101) {
            oracle::Pair pair = pairs[i];
            pair[i % 8][i % 3] = i % 2 == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
            pairs.push_back(pair);
        }
        pairs.resize(pairs.size() / 8 * 8 - 3);  // the last five all have a coordinate that is not finite
        const AllLayouts<float> floats{pairs};
        for (const double t_max : {1.0, 0.37})
            for (const double separation : {0.0, 1e-2}) {
                Options options;
                options.t_max = t_max;
                options.minimum_separation = separation;
                options.reference = true;
                const Answer expected = answer(kind, interleaved(pairs), options);
                options.reference = false;
                for (const Isa isa : isas_to_test()) {
                    options.isa = isa;
                    for (const auto& [layout, view] : floats.views)
                        expect_same(expected, answer(kind, view, options),
                                    layout + ", " + name(isa) + ", t_max " + std::to_string(t_max) + ", separation " + std::to_string(separation));
                }
            }
    }
}

TEST(SameBits, Threads)
{
    for (const auto kind : kinds) {
        const auto pairs = mixed_pairs(kind, 35, 301);
        const PairBuffer buffer = to_buffer(pairs);
        const Answer expected = reference(kind, buffer.view(), 1e-9);
        for (const int threads : {1, 2, 3, 7}) {
            tbb::global_control limit{tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)};
            tbb::task_arena arena{threads};
            arena.execute([&] {
                expect_same(expected, answer(kind, buffer.view(), {}), std::to_string(threads) + " threads");
                std::vector<Contact> contacts;
                ASSERT_TRUE(find_contacts(pair_kind(kind), buffer.view(), {}, contacts).ok());
                std::size_t next = 0;
                for (std::size_t i = 0; i < pairs.size(); ++i)
                    if (expected.toi[i] <= 1.0) {
                        ASSERT_LT(next, contacts.size());
                        EXPECT_EQ(contacts[next].pair, i);
                        EXPECT_EQ(contacts[next++].toi, expected.toi[i]);
                    }
                EXPECT_EQ(next, contacts.size());
            });
        }
    }
}

TEST(SameBits, AnyLaneAndAnyNeighbours)
{
    // One pair in every lane of otherwise different company, and in buffers of every size around a block.
    for (const auto kind : kinds) {
        const auto pairs = mixed_pairs(kind, 36, 3);
        const Answer expected = reference(kind, interleaved(pairs), 1e-9);
        for (std::size_t offset = 0; offset < 9; ++offset)
            for (const std::size_t size : {1u, 2u, 7u, 8u, 9u, 15u, 17u, 33u}) {
                const std::vector<oracle::Pair> part(pairs.begin() + static_cast<std::ptrdiff_t>(offset),
                                                     pairs.begin() + static_cast<std::ptrdiff_t>(offset + size));
                for (const Isa isa : isas_to_test()) {
                    Options options;
                    options.isa = isa;
                    const Answer found = answer(kind, to_buffer(part).view(), options);
                    for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(found.toi[i], expected.toi[offset + i]);
                }
            }
    }
}

/// A gap far below the extent of its axis, which scaling that axis down makes vanish: no business of the lanes.
TEST(SameBits, GapThatUnderflowsWhenScaled)
{
    const oracle::Pair pair{{{-0x1p121, 0x1p-1060, 0}, {0x1p-1030, 0x1p-1030, 0}, {0x1p-1031, 0, 0}, {0x1p-1040, 0x1p-1040, 0},
                             {0, 0x1p-1040, 0x1p-1026}, {0x1p-1026, 0, 0x1p-1028}, {0x1p-1026, 0, 0.5}, {0.5, 0.0131, 0.2}}};
    for (const auto kind : kinds)
        for (const double extent : {0x1p99, 0x1p101, 0x1p121, 0x1p129, 0x1p500})
            for (const double t_max : {1.0, 0.25, 0x1p-30}) {
                oracle::Pair wide = pair;
                wide[0][0] = -extent;
                expect_same_on_every_isa(kind, interleaved({wide}), 0x1p-42, kind_name(kind), t_max);
                std::swap(wide[0], wide[4]);  // wide at the end, out of sight of a short step
                expect_same_on_every_isa(kind, interleaved({wide}), 0x1p-42, kind_name(kind), t_max);
            }
}

/// A gap that would vanish if its axis were scaled down because another axis is far below the range.
TEST(SameBits, GapThatUnderflowsIfAllAxesWereScaled)
{
    for (const auto kind : kinds)
        for (const double extent : {0.9 * 0x1p60, 0x1p99, 0x1p101})
            for (const double gap : {0x1p-1060, 0x1p-960})
                for (const double small : {0x1p-101, 0x1p-170, 0x1p-1000}) {
                    oracle::Pair pair{{{0, 0, 0}, {gap, -1, -small}, {gap, 1, small}, {extent, 2, 0.5 * small}}};
                    for (std::size_t i = 0; i < 4; ++i) pair[i + 4] = pair[i];
                    if (kind == oracle::Kind::edge_edge) pair[1][0] = pair[5][0] = 0;
                    expect_same_on_every_isa(kind, interleaved({pair}), 0x1p-42, kind_name(kind));
                    expect_same_on_every_isa(kind, interleaved({pair}), 0x1p-42, kind_name(kind), 0.25);
                }
}

/// The same pairs with each axis multiplied by a power of two.
std::vector<oracle::Pair> scaled(std::vector<oracle::Pair> pairs, const double (&scale)[3])
{
    for (auto& pair : pairs)
        for (auto& point : pair)
            for (std::size_t axis = 0; axis < 3; ++axis) point[axis] *= scale[axis];
    return pairs;
}

/// Of families whose coordinates stay doubles when they are scaled so.
TEST(SameBits, PowerOfTwoScale)
{
    constexpr double powers[] = {0x1p40, 0x1p-60, 0x1p900, 0x1p-500};
    const auto expect_same_scaled = [&](oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const std::string& family) {
        for (const double t_max : {1.0, 0.7}) {
            Options options;
            options.t_max = t_max;
            const Answer expected = answer(kind, interleaved(pairs), options);
            for (const double power : powers)
                expect_same(expected, answer(kind, interleaved(scaled(pairs, {power, power, power})), options), family + " scaled");
        }
    };
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds) {
        for (const std::string& family : families()) {
            if (family.ends_with("extreme_scale") || family.ends_with("mixed_exponent")) continue;
            generate(family, kind, 37, amount(200), pairs);
            expect_same_scaled(kind, pairs, family);
        }
        expect_same_scaled(kind, ThinPairs{kind, 37}.next(amount(200)), "thin");
    }
}

/// Not of families whose faces or edges have hardly any area when they meet: there lengths have a say (eq. 6), hence the units of an axis.
TEST(SameBits, PowerOfTwoScalePerAxis)
{
    constexpr double scales[][3] = {{0x1p-60, 0x1p30, 1.0}, {0x1p500, 0x1p-500, 0x1p-3}, {0x1p10, 1.0, 0x1p-10}};
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds)
        for (const char* family : {"uniform", "simcloth", "boundary", "f32_boundary", "degenerate", "coplanar_map", "t1_contact", "f32_binarygrid"}) {
            generate(family, kind, 37, 200, pairs);
            const Answer expected = answer(kind, interleaved(pairs), {});
            for (const auto& scale : scales)
                expect_same(expected, answer(kind, interleaved(scaled(pairs, scale)), {}), std::string(family) + " scaled");
        }
}

}  // namespace
}  // namespace fastccd::testing
