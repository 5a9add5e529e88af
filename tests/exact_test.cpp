// Proven and possible, and the exact verdict: against the oracle, whose rational arithmetic shares no code with the library's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "all_layouts.hpp"
#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

struct Found {
    std::vector<Contact> contacts;
    Summary summary;
};

Found find(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const Options& options)
{
    Found found;
    const Status status = find_contacts(pair_kind(kind), interleaved(pairs), options, found.contacts, nullptr, &found.summary);
    if (!status.ok()) throw std::runtime_error(message(status.error));
    return found;
}

/// So degenerate in the first half of the step that the search came to its cap there, before it went on along directions; regular contact at 0.81.
TEST(Exact, LocatesContactAfterAlmostMeeting)
{
    const std::vector<oracle::Pair> pairs{{{{0, 0, 0}, {0x1.e8p-26, 0x1.9p-26, 0}, {-0x1.4p-30, 0, 0}, {0, 16, -0.75},
                                            {4, -0.25, -3}, {-3.9921875, 0.75, -1}, {-2.03125, 0, -1.7626953125}, {0, 0, 0}}}};
    const oracle::Verdict verdict = oracle::exact_ccd(oracle::Kind::edge_edge, pairs[0], 1.0);
    ASSERT_TRUE(verdict.contact);
    for (const bool exact : {false, true}) {
        Options options;
        options.exact = exact;
        const Found found = find(oracle::Kind::edge_edge, pairs, options);
        ASSERT_EQ(found.contacts.size(), 1u);
        EXPECT_GE(found.contacts[0].toi, verdict.t_lo - options.tolerance);
        EXPECT_LE(found.contacts[0].toi, verdict.t_lo);
    }
}

TEST(Exact, VerdictIsTheOracles)
{
    std::size_t at_start = 0;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 51, amount(150), pairs);
            for (const double t_max : {1.0, 0.7, 1e-3})
                for (const double tolerance : {1e-3, 1e-9, 1e-15}) {
                    if (t_max != 1.0 && tolerance != 1e-9) continue;
                    Options options;
                    options.exact = true;
                    options.t_max = t_max;
                    options.tolerance = tolerance;
                    const Found found = find(kind, pairs, options);
                    EXPECT_EQ(found.summary.proven, found.summary.contacts);
                    auto contact = found.contacts.begin();
                    for (std::size_t i = 0; i < pairs.size(); ++i) {
                        const oracle::Verdict verdict = oracle::exact_ccd(kind, pairs[i], t_max);
                        const bool reported = contact != found.contacts.end() && contact->pair == i;
                        ASSERT_EQ(reported, verdict.contact) << kind_name(kind) << ' ' << family << ' ' << lossless(pairs[i]);
                        if (!reported) continue;
                        EXPECT_TRUE(contact->proven);
                        EXPECT_GE(contact->toi, verdict.t_lo - std::max(tolerance, 0x1p-49)) << "early: " << family << ' ' << lossless(pairs[i]);
                        EXPECT_LE(contact->toi, verdict.t_lo) << "late: " << family << ' ' << lossless(pairs[i]);
                        EXPECT_EQ(contact->toi > 0.0, !verdict.at_start) << family << ' ' << lossless(pairs[i]);
                        at_start += verdict.at_start;
                        ++contact;
                    }
                }
        }
    EXPECT_GT(at_start, amount(1000));
}

TEST(Exact, ProvenIsNeverWrong)
{
    std::size_t proven = 0, contacts = 0, beyond = 0, beyond_at_least = 0;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 52, amount(300), pairs);
            for (const double tolerance : {0.3, 1e-6, 1e-12}) {
                Options options;
                options.tolerance = tolerance;
                const Found found = find(kind, pairs, options);
                contacts += found.contacts.size();
                EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(found.contacts, true, &Contact::proven)), found.summary.proven);
                for (const Contact& contact : found.contacts) {
                    if (!contact.proven) continue;
                    ++proven;
                    const oracle::Verdict verdict = oracle::exact_ccd(kind, pairs[contact.pair]);
                    const auto what = [&] { return kind_name(kind) + (' ' + family) + ' ' + lossless(pairs[contact.pair]); };
                    ASSERT_TRUE(verdict.contact) << what();
                    // README, Accuracy: in [toi, toi + E_tol], or within 2^-6 of the step.
                    EXPECT_LE(contact.toi, verdict.t_lo) << what();
                    EXPECT_LE(verdict.t_lo, contact.toi + std::max(tolerance, 0x1p-6)) << what();
                    if (verdict.t_lo > contact.toi + tolerance) ++(tolerance > 1e-12 ? beyond : beyond_at_least);
                }
            }
        }
    std::printf("%zu of %zu contacts of hard pairs proven, %zu and at 1e-12 %zu of these earlier than E_tol\n", proven, contacts, beyond,
                beyond_at_least);
    EXPECT_GT(proven, contacts / 4);
    EXPECT_LE(beyond, 2 + proven / 1000) << "only of primitives that graze does rounding hide the sign for as long";
    EXPECT_LE(beyond_at_least, 2 + proven / 20);
}

TEST(Exact, RandomContactsAreProven)
{
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> pairs;
        generate("uniform", kind, 53, 20000, pairs);
        for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
            Options options;
            options.tolerance = tolerance;
            const Found found = find(kind, pairs, options);
            EXPECT_EQ(found.summary.proven, found.contacts.size()) << tolerance;
        }
    }
}

/// However lanes, or no lanes, come to ask for it.
TEST(Exact, TheSameOnEveryIsaInEveryLayoutAndByReference)
{
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> pairs = mixed_pairs(kind, 56, amount(16));
        for (oracle::Pair& pair : pairs)
            for (auto& point : pair)
                for (double& x : point) x = static_cast<float>(std::clamp(x, -0x1.fffffep127, 0x1.fffffep127));  // as a float, too
        Options options;
        options.exact = options.reference = true;
        const Answer expected = answer(kind, interleaved(pairs), options);
        EXPECT_EQ(expected.summary.proven, expected.summary.contacts);
        EXPECT_EQ(expected.summary.scalar_pairs, pairs.size());
        options.reference = false;
        const AllLayouts<float> floats{pairs};
        const AllLayouts<double> doubles{pairs};
        for (const Isa isa : isas_to_test()) {
            options.isa = isa;
            for (const auto& views : {floats.views, doubles.views})
                for (const auto& [layout, view] : views) {
                    const Answer found = answer(kind, view, options);
                    EXPECT_EQ(first_difference(expected, found), pairs.size()) << name(isa) << ", " << layout;
                    EXPECT_EQ(found.summary.proven, expected.summary.proven) << name(isa) << ", " << layout;
                    EXPECT_LT(found.summary.scalar_pairs, pairs.size());
                }
        }
    }
}

TEST(Exact, EarliestIsTheMinimumOfTheDenseAnswer)
{
    for (const auto kind : kinds)
        for (const char* family : {"boundary", "degenerate", "near_boundary", "coplanar_map", "uniform"}) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 54, amount(500), pairs);
            Options options;
            options.exact = true;
            const Answer dense = answer(kind, interleaved(pairs), options);
            Contact earliest;
            ASSERT_TRUE(earliest_contact(pair_kind(kind), interleaved(pairs), options, earliest).ok());
            EXPECT_EQ(earliest.pair, dense.summary.earliest.pair) << family;
            EXPECT_EQ(earliest.toi, dense.summary.earliest.toi) << family;
            EXPECT_EQ(earliest.proven, dense.summary.earliest.proven) << family;
        }
}

/// Small integer coordinates: contacts at vertices, along edges, in flat faces, always coplanar motion, in every combination.
TEST(Exact, SmallIntegers)
{
    std::uint64_t state = 55;
    const auto small = [&state](int range) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(static_cast<int>((state >> 33) % static_cast<unsigned>(2 * range + 1)) - range);
    };
    for (const auto kind : kinds)
        for (const int range : {1, 2, 3}) {
            std::vector<oracle::Pair> pairs(amount(4000));
            for (auto& pair : pairs)
                for (auto& point : pair)
                    for (double& x : point) x = small(range);
            // Every third pair is flat for good.
            for (std::size_t i = 0; i < pairs.size(); i += 3)
                for (auto& point : pairs[i]) point[i % 2] = 0.0;
            Options options;
            options.exact = true;
            const Found found = find(kind, pairs, options);
            auto contact = found.contacts.begin();
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                const oracle::Verdict verdict = oracle::exact_ccd(kind, pairs[i]);
                const bool reported = contact != found.contacts.end() && contact->pair == i;
                ASSERT_EQ(reported, verdict.contact) << kind_name(kind) << ' ' << lossless(pairs[i]);
                if (!reported) continue;
                EXPECT_LE(contact->toi, verdict.t_lo) << "late: " << lossless(pairs[i]);
                EXPECT_GE(contact->toi, verdict.t_lo - 1e-9) << "early: " << lossless(pairs[i]);
                ++contact;
            }
        }
}

}  // namespace
}  // namespace fastccd::testing
