// The cap on intervals of the certified search. No pair that bounded_test looks at comes to the ordinary one, so lower ones are set here: what is not
// looked at by then must not be missed, late or called proven, and the search must end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include <certified_search.hpp>
#include <interval_stack.hpp>
#include <kernel_table.hpp>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

/// Exact, once for all caps.
struct KnownPairs {
    std::vector<oracle::Pair> pairs;
    std::vector<oracle::Verdict> truth;

    explicit KnownPairs(oracle::Kind kind)
    {
        pairs = mixed_pairs(kind, 401, amount(100));
        const auto thin = ThinPairs{kind, 402}.next(amount(1000));
        pairs.insert(pairs.end(), thin.begin(), thin.end());
        for (const oracle::Pair& pair : pairs) truth.push_back(oracle::exact_ccd(kind, pair));
    }
};

const KnownPairs& known_pairs(oracle::Kind kind)
{
    static const KnownPairs known[] = {KnownPairs{kinds[0]}, KnownPairs{kinds[1]}};
    return known[kind == kinds[1]];
}

struct Seen {
    std::size_t contacts = 0, at_cap = 0, extended = 0, proven = 0, within_tolerance = 0, uncounted = 0;
};

Seen expect_sound(oracle::Kind kind, double tolerance, unsigned most)
{
    const KnownPairs& known = known_pairs(kind);
    const SearchParameters parameters{tolerance, 1.0, true};
    // What waits is looked at once (IntervalStack of leaves, and of parts), looks along directions may pass the cap.
    constexpr unsigned stacks = 2 * scalar::IntervalStack::capacity;
    Seen seen;
    for (std::size_t i = 0; i < known.pairs.size(); ++i) {
        const oracle::Verdict& truth = known.truth[i];
        const auto what = [&] { return std::string(kind_name(kind)) + ", cap " + std::to_string(most) + ": " + lossless(known.pairs[i]); };
        const scalar::SearchResult found = scalar::certified_search(pair_kind(kind), known.pairs[i][0].data(), parameters, nullptr, most);
        EXPECT_LE(found.intervals, most + scalar::most_looks_to_skip + scalar::most_extensions * scalar::extension + stacks) << what();
        EXPECT_LE(found.root_intervals, most + stacks) << what();
        seen.at_cap += found.intervals > most;
        seen.extended += found.intervals > most + scalar::most_looks_to_skip + stacks;
        if (found.proof != scalar::Proof::none) {
            EXPECT_TRUE(truth.contact) << "proven: " << what();
        }
        if (!truth.contact) continue;
        ++seen.contacts;
        EXPECT_LE(found.toi, truth.t_lo) << (found.toi <= 1.0 ? "late: " : "missed: ") << what();
        const scalar::SearchResult ordinary = scalar::certified_search(pair_kind(kind), known.pairs[i][0].data(), parameters);
        EXPECT_EQ(found.toi > 0.0, ordinary.toi > 0.0) << what();
        if (found.proof != scalar::Proof::none) {
            ++seen.proven;
            EXPECT_LE(truth.t_lo, found.toi + std::max(tolerance, 0x1p-6)) << what();
        }
        seen.within_tolerance += truth.t_lo - found.toi <= tolerance;
        seen.uncounted += found.roots == 0;
        EXPECT_TRUE(found.roots == ordinary.roots || found.roots == 0) << unsigned{found.roots} << ' ' << what();
    }
    std::printf("%s, E_tol %g, cap %u: %zu contacts, %zu pairs at the cap, %zu with more for what is wide; contacts proven %zu, within E_tol %zu, "
                "roots not counted %zu\n", kind_name(kind), tolerance, most, seen.contacts, seen.at_cap, seen.extended, seen.proven,
                seen.within_tolerance, seen.uncounted);
    return seen;
}

TEST(Cap, WhateverItIsNothingIsMissedOrLateOrFalselyProven)
{
    for (const oracle::Kind kind : kinds)
        for (const double tolerance : {1e-6, 1e-9, 1e-14})
            for (const unsigned most : {1u, 2u, 8u, 20u, 64u, 256u}) {
                const Seen seen = expect_sound(kind, tolerance, most);
                if (most <= 8) {  // the way down to a leaf takes more than that
                    EXPECT_GT(seen.at_cap, seen.contacts / 2) << "hardly any comes to the cap: nothing was tested";
                }
            }
}

/// And with lanes it is the same one.
TEST(Cap, IsTheSameForSeveralIntervalsAtOnce)
{
    for (const oracle::Kind kind : kinds) {
        const KnownPairs& known = known_pairs(kind);
        for (const unsigned most : {1u, 3u, 8u, 20u, 64u, 256u}) {
            const SearchParameters parameters{1e-12, 1.0, true};
            for (std::size_t i = 0; i < known.pairs.size(); i += 3) {
                const double* const pair = known.pairs[i][0].data();
                const scalar::SearchResult one = scalar::certified_search(pair_kind(kind), pair, parameters, nullptr, most);
                for (const Isa isa : isas_to_test()) {
                    const scalar::SearchResult several =
                        scalar::certified_search(pair_kind(kind), pair, parameters, &kernel_table(isa)->intervals, most);
                    ASSERT_EQ(std::memcmp(&one.toi, &several.toi, sizeof one.toi), 0) << name(isa) << ' ' << lossless(known.pairs[i]);
                    ASSERT_EQ(one.proof, several.proof) << name(isa) << ' ' << lossless(known.pairs[i]);
                    ASSERT_EQ(one.intervals, several.intervals) << name(isa) << ' ' << lossless(known.pairs[i]);
                }
            }
        }
    }
}

}  // namespace
}  // namespace fastccd::testing
