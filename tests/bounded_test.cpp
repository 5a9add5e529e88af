// Bounded: the certified search examines no more intervals for a pair than its cap, and a call allocates nothing per pair.
#include <gtest/gtest.h>

#include <algorithm>

#include <tbb/global_control.h>

#include <certified_search.hpp>

#include "allocation_count.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "test_data.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

/// At the cap, what still waits on the two stacks of intervals (leaves, parts of a leaf) is looked at once, what is wide gets more.
constexpr unsigned most_intervals_with_stack = scalar::most_intervals + scalar::most_extensions * scalar::extension + 2 * 128;
/// Enough for every pair that is not degenerate: a path of halvings to a contact, and some on the way.
constexpr unsigned ordinary_intervals = 512;

struct Work {
    unsigned largest = 0;
    std::size_t pairs = 0, beyond_ordinary = 0, at_cap = 0;

    void add(oracle::Kind kind, const std::vector<oracle::Pair>& set, double tolerance)
    {
        const SearchParameters parameters{tolerance, 1.0, true};
        for (const oracle::Pair& pair : set) {
            const unsigned intervals = scalar::certified_search(pair_kind(kind), pair[0].data(), parameters).intervals;
            largest = std::max(largest, intervals);
            ++pairs;
            beyond_ordinary += intervals > ordinary_intervals;
            at_cap += intervals >= scalar::most_intervals;
        }
    }
    void report(const char* name, double tolerance) const
    {
        std::printf("%-28s E_tol %g: most intervals %u; over %u for %zu of %zu pairs, at the cap %zu\n", name, tolerance, largest,
                    ordinary_intervals, beyond_ordinary, pairs, at_cap);
        EXPECT_LE(largest, most_intervals_with_stack) << name;
    }
};

/// Families with a degeneracy at the very time of contact, where certificates exist on tiny intervals only.
bool may_reach_the_cap(const std::string& family)
{
    for (const char* hard : {"degenerate", "binarygrid", "tinygrid", "mixed_exponent", "grazing", "coplanar", "zero_cubic",
                             "pointpoint", "collinear", "parallel", "resting", "simcloth"})
        if (family.find(hard) != std::string::npos) return true;
    return false;
}

TEST(Bounded, IntervalsOfMadePairs)
{
    std::vector<oracle::Pair> pairs;
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
        Work ordinary, hard, thin;
        for (const auto kind : kinds) {
            for (const std::string& family : families()) {
                generate(family, kind, 101, 150, pairs);
                (may_reach_the_cap(family) ? hard : ordinary).add(kind, pairs, tolerance);
            }
            thin.add(kind, ThinPairs{kind, 102}.next(3000), tolerance);
        }
        ordinary.report("families", tolerance);
        hard.report("degenerate families", tolerance);
        thin.report("thin pairs", tolerance);
        EXPECT_EQ(ordinary.beyond_ordinary, 0u);
        EXPECT_LT(hard.at_cap, hard.pairs / 50);
        EXPECT_GT(ordinary.largest, 40u) << "no search went down to a leaf: nothing was tested";
    }
}

TEST(Bounded, IntervalsOfPublicData)
{
    const auto data = data_directory();
    if (!data) GTEST_SKIP() << no_data_message;
    Work queries, hardcases;
    for (const QuerySet& set : load_queries(*data)) queries.add(set.kind, set.pairs, 1e-9);
    for (const QuerySet& set : load_hardcases(*data)) hardcases.add(set.kind, set.pairs, 1e-9);
    queries.report("queries", 1e-9);
    hardcases.report("hardcases", 1e-9);
    EXPECT_LT(hardcases.at_cap, hardcases.pairs / 1000);
}

/// Allocations of the second of two equal calls: threads and their memory are there by then.
template <class Call>
std::size_t allocations_of(Call call)
{
    call();
    const std::size_t before = allocations();
    call();
    return allocations() - before;
}

TEST(Bounded, NoAllocationPerPair)
{
    constexpr std::size_t few = 16 * 1024, many = 512 * 1024;
    for (const unsigned threads : {1u, 2u}) {
        const tbb::global_control limit{tbb::global_control::max_allowed_parallelism, threads};
        for (const auto kind : kinds) {
            std::vector<oracle::Pair> pairs;
            generate("simcloth", kind, 103, 4096, pairs);  // contacts, near misses and undecided pairs in plenty
            PairBuffer buffer{many};
            for (std::size_t i = 0; i < many; ++i) buffer.set(i, std::span<const double, 24>{pairs[i % pairs.size()][0].data(), 24});
            std::vector<double> toi(many);
            std::vector<std::uint8_t> roots(many);
            const auto dense = [&](std::size_t n) {
                return allocations_of([&] {
                    const Status status = time_of_impact(pair_kind(kind), PairView::blocked(buffer.data(), n), {},
                                                         std::span(toi).first(n), nullptr, std::span(roots).first(n));
                    ASSERT_TRUE(status.ok());
                });
            };
            const std::size_t for_few = dense(few), for_many = dense(many);
            std::printf("%s, %u threads: %zu allocations for %zu pairs, %zu for %zu\n", kind_name(kind), threads, for_few, few,
                        for_many, many);
            // What TBB allocates depends on how often work was stolen, not on the pairs.
            EXPECT_LE(for_few, 64u);
            EXPECT_LE(for_many, 64u);
            std::vector<Contact> contacts;
            contacts.reserve(many);
            const std::size_t compact = allocations_of([&] {
                contacts.clear();
                ASSERT_TRUE(find_contacts(pair_kind(kind), buffer.view(), {}, contacts).ok());
            });
            EXPECT_GT(contacts.size(), 1000u);
            EXPECT_GE(compact, 1u) << "the list of tiles is not counted: nothing is";
            EXPECT_LE(compact, 64u + 2 * 20 * threads) << "lists grow by doubling";
        }
    }
}

}  // namespace
}  // namespace fastccd::testing
