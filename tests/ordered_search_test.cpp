// The certified search with lanes, which looks at several intervals at once, against the one that looks at one after the other: the
// same answer, proof, roots and count of intervals for every pair, whatever was foreseen.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>

#include <certified_search.hpp>
#include <interval_certificates.hpp>
#include <kernel_table.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

std::size_t calls = 0;

/// A kernel with lanes on any machine: one interval after the other.
template <unsigned lanes>
unsigned apart_one_by_one(const PairCoefficients& pair, const double* starts, const double* ends, bool by_area)
{
    ++calls;
    unsigned bits = 0;
    for (unsigned k = 0; k < lanes; ++k) {
        const double a = starts[k], b = ends[k];
        const bool apart = pair.kind == PairKind::vertex_face
                               ? portable::apart_on<PairKind::vertex_face>(pair, a, b).value ||
                                     (by_area && portable::apart_by_area_on<PairKind::vertex_face>(pair, a, b).value)
                               : portable::apart_on<PairKind::edge_edge>(pair, a, b).value ||
                                     (by_area && portable::apart_by_area_on<PairKind::edge_edge>(pair, a, b).value);
        bits |= unsigned{apart} << k;
    }
    return bits;
}

std::vector<IntervalKernel> interval_kernels()
{
    std::vector<IntervalKernel> kernels{{4, apart_one_by_one<4>}, {8, apart_one_by_one<8>}};
    for (const Isa isa : isas_to_test()) kernels.push_back(kernel_table(isa)->intervals);
    return kernels;
}

void expect_same(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const std::string& family, const SearchParameters& parameters)
{
    for (const oracle::Pair& pair : pairs) {
        const double* const coordinates = pair[0].data();
        const scalar::SearchResult one = scalar::certified_search(pair_kind(kind), coordinates, parameters);
        for (const IntervalKernel& kernel : interval_kernels()) {
            const scalar::SearchResult several = scalar::certified_search(pair_kind(kind), coordinates, parameters, &kernel);
            const std::string what = family + ", " + std::to_string(kernel.lanes) + " lanes: " + lossless(pair);
            ASSERT_EQ(std::memcmp(&one.toi, &several.toi, sizeof one.toi), 0) << what;
            ASSERT_EQ(one.proof, several.proof) << what;
            ASSERT_EQ(one.roots, several.roots) << what;
            ASSERT_EQ(one.intervals, several.intervals) << what;
        }
    }
}

TEST(OrderedSearch, SeveralIntervalsAtOnceChangeNothing)
{
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds) {
        for (const double tolerance : {1.0, 0.3, 1e-3, 1e-9, 1e-14}) {
            for (const double t_max : {1.0, 0.7}) {
                const SearchParameters parameters{tolerance, t_max, true};
                for (const std::string& family : families()) {
                    generate(family, kind, 301, 40, pairs);
                    expect_same(kind, pairs, family, parameters);
                }
                expect_same(kind, ThinPairs{kind, 302}.next(200), "thin", parameters);
            }
        }
    }
}

/// Or there would be no point in it.
TEST(OrderedSearch, ForeseesWhereContactIs)
{
    const IntervalKernel kernel{8, apart_one_by_one<8>};
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds) {
        for (const char* family : {"near_interior", "t0_contact"}) {
            generate(family, kind, 303, 2000, pairs);
            const SearchParameters parameters{1e-9, 1.0, false};
            std::size_t intervals = 0;
            calls = 0;
            for (const oracle::Pair& pair : pairs) {
                const scalar::SearchResult found = scalar::certified_search(pair_kind(kind), pair[0].data(), parameters, &kernel);
                intervals += found.intervals;
            }
            std::printf("%s %s: %.1f intervals in a call of 8\n", kind_name(kind), family,
                        static_cast<double>(intervals) / static_cast<double>(calls));
            EXPECT_GT(intervals, 5 * calls);
        }
    }
}

}  // namespace
}  // namespace fastccd::testing
