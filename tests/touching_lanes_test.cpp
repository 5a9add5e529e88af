// Lanes that are asked whether a pair touches (simd/touching_pairs.hpp) say what the search does, bit for bit; and so do all stages together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <certified_search.hpp>
#include <kernel_table.hpp>
#include <leaf_search.hpp>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "thin_pairs.hpp"
#include "touching_pairs_made.hpp"

namespace fastccd::testing {
namespace {

struct Compared {
    std::size_t skipped = 0, asked = 0, reported = 0, in_next = 0, proven = 0, anywhere = 0, at_start = 0, apart = 0, left = 0;
};

/// Asks lanes for the leaf that the search answers with, for the one before it, and for any.
template <PairKind kind>
void compare_lanes(const KernelTable& kernels, const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters,
                   const std::string& what, Compared& seen)
{
    struct Question {
        const oracle::Pair* pair;
        double left;  // 0: anywhere
        scalar::SearchResult expected;
    };
    const auto answer = [&](const std::vector<Question>& asked, TouchingBlock* kernel) {
        TouchAnswers answers;
        alignas(64) double block[pair_coordinates][block_pairs];
        for (std::size_t lane = 0; lane < block_pairs; ++lane) {
            const Question& question = asked[std::min(lane, asked.size() - 1)];
            for (std::size_t c = 0; c < pair_coordinates; ++c) block[c][lane] = (*question.pair)[c / 3][c % 3];
            answers.left[lane] = question.left;
        }
        kernel(kind, block[0], parameters, answers);
        return answers;
    };
    std::vector<Question> in_leaves, anywhere;
    const auto compare = [&](std::vector<Question>& asked) {
        if (asked.empty()) return;
        const bool is_anywhere = asked.front().left == 0.0;
        const TouchAnswers answers = answer(asked, is_anywhere ? kernels.contact_anywhere : kernels.contact_in_leaves);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            const auto& [pair, left, expected] = asked[i];
            ++seen.asked;
            if ((answers.apart >> i & 1) != 0) {
                ++seen.apart;
                ASSERT_EQ(expected.toi, std::numeric_limits<double>::infinity()) << what << ": " << lossless(*pair);
                ASSERT_EQ(answers.reported >> i & 1, 0u) << what << ": " << lossless(*pair);
            }
            seen.left += is_anywhere && ((answers.reported | answers.apart) >> i & 1) == 0;
            if ((answers.reported >> i & 1) == 0) continue;
            const bool proven = (answers.proven >> i & 1) != 0;
            ASSERT_EQ(parameters.time(answers.time[i]), expected.toi) << what << ": " << lossless(*pair);
            ASSERT_EQ(proven, expected.proof != scalar::Proof::none) << what << ": " << lossless(*pair);
            ++seen.reported;
            if (is_anywhere)
                ++(answers.time[i] > 0.0 ? seen.anywhere : seen.at_start);
            else
                seen.in_next += answers.time[i] >= left + parameters.leaf_width;
            seen.proven += proven;
        }
        asked.clear();
    };
    const auto ask = [&](std::vector<Question>& asked, const Question& question) {
        asked.push_back(question);
        if (asked.size() == block_pairs) compare(asked);
    };
    for (const oracle::Pair& pair : pairs) {
        const scalar::SearchResult found = scalar::certified_search(kind, pair[0].data(), parameters);
        ask(anywhere, {&pair, 0.0, found});
        // Lanes ask only where the search comes to.
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        scalar::LeafSearch<kind> leaves{polynomials, parameters};
        const double last = polynomials.apart() ? scalar::LeafSearch<kind>::none : leaves.first_contact();
        if (leaves.skipped_to() > 0.0) {  // along directions, past leaves that no certificate clears
            ++seen.skipped;
            continue;
        }
        // Of a pair that is apart, where contact would be.
        const double near = last <= 1.0 ? last : scalar::ExpectedContact{polynomials.coefficients(), parameters}.from(0.0);
        if (std::isfinite(near))
            for (const scalar::Interval leaf : leaves_around(near, parameters))
                if (leaf.a <= last) ask(in_leaves, {&pair, leaf.a, found});
        if (::testing::Test::HasFatalFailure()) return;
    }
    compare(in_leaves);
    compare(anywhere);
}

/// Four points in line at time 0, but for rounding; of every other pair a vertex some roundings before the first corner of its face along the
/// line, or a short edge as far beside another one: what directions tell, and certificates do not.
std::vector<oracle::Pair> in_line_at_start(oracle::Kind kind, std::size_t count)
{
    std::vector<oracle::Pair> pairs(count);
    std::mt19937_64 bits{818};
    const auto random = [&] { return std::ldexp(static_cast<double>(bits() >> 11), -53); };
    for (std::size_t i = 0; i < count; ++i) {
        const double from[] = {random(), random(), random()}, along[] = {random(), random(), random()};
        const double off = i % 2 == 0 ? std::ldexp(random(), -50 + static_cast<int>(bits() % 4)) : 0.0;
        double at[] = {-random(), random(), -random(), random()}, beside = 0.0;
        if (kind == oracle::Kind::edge_edge)
            for (double& s : at) s *= 0x1p-5;
        if (off > 0.0 && kind == oracle::Kind::vertex_face) {
            at[0] = 0.0;
            at[1] = off;
            at[2] = -at[2];
        } else {
            beside = off;
        }
        for (std::size_t point = 0; point < 4; ++point)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                pairs[i][point][axis] = from[axis] + at[point] * along[axis];
                if (point > 1) pairs[i][point][axis] += beside * (along[(axis + 1) % 3] - along[(axis + 2) % 3]);
                pairs[i][point + 4][axis] = random();
            }
    }
    return pairs;
}

/// The same in the middle of the step, where coordinates are rounded once more.
std::vector<oracle::Pair> in_line_midway(oracle::Kind kind, std::size_t count)
{
    std::vector<oracle::Pair> pairs = in_line_at_start(kind, count);
    for (oracle::Pair& pair : pairs)
        for (std::size_t point = 0; point < 4; ++point)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double middle = pair[point][axis], half = 0.5 * (pair[point + 4][axis] - middle);
                pair[point][axis] = middle - half;
                pair[point + 4][axis] = middle + half;
            }
    return pairs;
}

TEST(Touching, LanesReportWhatTheSearchDoes)
{
    for (const Isa isa : isas_to_test())
        for (const auto kind : kinds) {
            Compared seen, at_start, midway;
            for (const double tolerance : {1.5, 0.5, 1e-4, 1e-9, 1e-12, 0x1p-44})
                for (const double t_max : {1.0, 0.7}) {
                    const SearchParameters parameters{tolerance, t_max, false};
                    const auto compare = [&](const std::vector<oracle::Pair>& pairs, const std::string& family, Compared& compared) {
                        if (kind == oracle::Kind::vertex_face)
                            compare_lanes<PairKind::vertex_face>(*kernel_table(isa), pairs, parameters, family, compared);
                        else
                            compare_lanes<PairKind::edge_edge>(*kernel_table(isa), pairs, parameters, family, compared);
                    };
                    for_each_family(kind, 814, amount(160), [&](const std::vector<oracle::Pair>& pairs, const std::string& family) {
                        compare(pairs, family, seen);
                    });
                    compare(in_line_at_start(kind, 600), "in line at the start", at_start);
                    compare(in_line_midway(kind, 600), "in line midway", midway);
                    if (HasFatalFailure()) return;
                }
            std::printf("%s, %s: %zu of %zu reported, %zu of them in the leaf after, %zu in any, %zu at the start, %zu proven; %zu apart; "
                        "in line: %zu at the start, where %zu are left, and %zu midway, where %zu are; %zu and %zu not asked about in their leaf, as "
                        "directions led there\n",
                        name(isa), kind_name(kind), seen.reported, seen.asked, seen.in_next, seen.anywhere, seen.at_start, seen.proven, seen.apart,
                        at_start.at_start, at_start.left, midway.reported, midway.left, seen.skipped, midway.skipped);
            EXPECT_GT(seen.reported, amount(10000));
            EXPECT_GT(seen.in_next, amount(1000));
            EXPECT_GT(seen.proven, amount(1000));
            EXPECT_GT(seen.anywhere, amount(1000));
            EXPECT_GT(seen.at_start, amount(1000));
            EXPECT_GT(seen.apart, amount(1000));
            EXPECT_GT(at_start.at_start, 100u);
            EXPECT_GT(at_start.left, 10u);
            EXPECT_GT(midway.reported, 100u);
            EXPECT_GT(midway.left, 10u);
            // What is left out is to stay the exception: of 600 pairs, for six tolerances and two lengths of step, a fifth.
            EXPECT_LT(midway.skipped, 1440u);
            EXPECT_LT(seen.skipped, seen.asked / 100);
        }
}

/// Apart at the start, in contact within the first leaf: by a time that is not 0, and proven by what is proven of the leaf.
TEST(Touching, LanesProveContactInTheFirstLeaf)
{
    const oracle::Pair pair{{{-0x1.4157f1b4b4718p-2, 0x1.0cc5735144d05p+0, 0x1.56551fc0d46bbp-2},
                             {-0x1.d03c089d6cbecp-1, 0x1.3679c999d9f27p+0, 0x1.bb8bc83c2d254p-2},
                             {0x1.04c641f821e5p-4, 0x1.2784428bb1ce6p+0, 0x1.5b64ba97d7d6p-2},
                             {-0x1.789028e086496p-2, 0x1.08f355b6a2f46p+0, 0x1.559c09a21d135p-2},
                             {-0x1.e0abc997be04cp-2, 0x1.8270b3e39ce32p-2, 0x1.71b0df04a0771p-1},
                             {-0x1.0ff2fa4778c45p+0, 0x1.14a10682f8b73p-1, 0x1.a44c33424cd3ep-1},
                             {-0x1.78891d940469cp-4, 0x1.ed6bf0cd50de2p-2, 0x1.7438ac70222c3p-1},
                             {-0x1.0bf20061c7ee8p-1, 0x1.73283d791576p-2, 0x1.715453f544cadp-1}}};
    const SearchParameters parameters{1.0, 1.0, false};
    const scalar::SearchResult found = scalar::certified_search(PairKind::vertex_face, pair[0].data(), parameters);
    EXPECT_GT(found.toi, 0.0);
    EXPECT_EQ(found.proof, scalar::Proof::leaf);
    for (const Isa isa : isas_to_test()) {
        Compared seen;
        compare_lanes<PairKind::vertex_face>(*kernel_table(isa), {pair}, parameters, "in the first leaf", seen);
        EXPECT_EQ(seen.proven, 1u) << name(isa);
    }
}

/// Two edges in line and apart by 16 u of their size at the start, never closer than that: distances along directions tell.
TEST(Touching, InLineAtTheStartIsToldFromContact)
{
    const oracle::Pair pair{{{0, 0, 0},
                             {-0x1.349ecca62e673p-5, 0x1.216b002a5174ep-7, -0x1.32f84ce2a74dp-7},
                             {0x1.7f99855e492d1p-7, -0x1.67bb6d7bf6a44p-9, 0x1.7d8c6029bd61fp-9},
                             {-0x1.d29a085b451b4p-6, 0x1.b591dbacb8686p-8, -0x1.d01b4215d11c8p-8},
                             {0x1.c63c9cea41fp-3, -0x1.1a2412181dc38p-2, -0x1.48c2dd80d5e52p-1},
                             {0x1.a02d8bdb86db4p-2, -0x1.869046c40ad12p-1, -0x1.06278b127b94p-3},
                             {-0x1.1833d39a8b8ep-2, -0x1.14578233ee02ap-1, 0x1.887105c50eecp-4},
                             {0x1.9185d0bf2329cp-2, -0x1.0ac5fa73b22acp-2, -0x1.0854f638af0bp-1}}};
    ASSERT_FALSE(oracle::exact_ccd(oracle::Kind::edge_edge, pair).contact);
    for (const Isa isa : isas_to_test()) {
        Options options;
        options.tolerance = 0.1;
        options.isa = isa;
        EXPECT_EQ(answer_without_roots(oracle::Kind::edge_edge, interleaved({pair}), options).toi[0], std::numeric_limits<double>::infinity()) << name(isa);
    }
}

/// The cubic grazes zero and stays within rounding for some hundred leaves: no certificate with margins leads to the one that the search
/// answers with, certificates of single intervals do.
TEST(Touching, GrazingPairsAreDecidedByLanes)
{
    for (const oracle::Kind kind : kinds)
        for (const std::string family : {"grazing", "grazing_exact"}) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 841, amount(4000), pairs);
            const PairBuffer buffer = to_buffer(pairs);
            for (const Isa isa : isas_to_test()) {
                Options options;
                options.isa = isa;
                const Summary summary = answer_without_roots(kind, buffer.view(), options).summary;
                std::printf("%s, %s, %s: of %zu contacts %zu pairs are left to the search\n", family.c_str(), kind_name(kind), name(isa), summary.contacts,
                            summary.scalar_pairs);
                EXPECT_GT(summary.contacts, pairs.size() / 4);
                EXPECT_LT(summary.scalar_pairs, pairs.size() / 50);
            }
        }
}

/// Whoever decides a pair, lanes at some stage or the search, says when it is first in contact with the same bits: the search alone defines it.
TEST(Touching, AnswersOfAllStagesAreTheSearchs)
{
    std::size_t compared = 0, contacts = 0;
    for (const auto kind : kinds)
        for (const double tolerance : {1e-6, 1e-9, 1e-12})
            for (const double t_max : {1.0, 0.7}) {
                const SearchParameters parameters{tolerance, t_max, false};
                const auto compare = [&](const std::vector<oracle::Pair>& pairs, const std::string& what) {
                    std::vector<double> expected;
                    for (const oracle::Pair& pair : pairs)
                        expected.push_back(scalar::certified_search(pair_kind(kind), pair[0].data(), parameters).toi);
                    for (const Isa isa : isas_to_test()) {
                        Options options;
                        options.tolerance = tolerance;
                        options.t_max = t_max;
                        options.isa = isa;
                        for (const Answer& found : {answer(kind, interleaved(pairs), options), answer_without_roots(kind, interleaved(pairs), options)})
                            for (std::size_t i = 0; i < pairs.size(); ++i)
                                ASSERT_EQ(found.toi[i], expected[i]) << what << ' ' << name(isa) << ": " << lossless(pairs[i]);
                    }
                    compared += pairs.size();
                    contacts += static_cast<std::size_t>(std::count_if(expected.begin(), expected.end(), [](double toi) { return toi <= 1.0; }));
                };
                for_each_family(kind, 816, amount(400), compare);
                compare(ThinPairs{kind, 817}.next(amount(20000)), "thin");
                if (HasFatalFailure()) return;
            }
    std::printf("%zu answers, %zu of them contacts\n", compared, contacts);
    EXPECT_GT(contacts, amount(50000));
    EXPECT_GT(compared - contacts, amount(50000));
}

}  // namespace
}  // namespace fastccd::testing
