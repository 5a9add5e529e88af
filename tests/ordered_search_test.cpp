// The certified search with lanes, which looks at several intervals at once, against the one that looks at one after the other: the
// same answer, proof, roots and count of intervals for every pair, whatever was foreseen.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include <certified_search.hpp>
#include <interval_certificates.hpp>
#include <kernel_table.hpp>
#include <leaf_search.hpp>
#include <pair_polynomials.hpp>

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
        for (const char* family : {"near_interior", "boundary"}) {
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

/// The walk to time 0, of which one look takes the place: the first leaf and, below it, the part that starts at 0 are reached
/// only if nothing wider has a certificate.
template <PairKind kind>
bool walk_ends_at_zero(const scalar::PairPolynomials<kind>& pair, double leaf_width)
{
    for (double end = leaf_width < 1.0 ? 0.5 : 1.0; end >= 0x1p-100; end *= 0.5) {
        const scalar::Interval i{0.0, end};
        if (pair.apart(i) || (end <= leaf_width && pair.apart_by_area(i))) return false;
    }
    return true;
}

struct AtStart {
    std::size_t pairs = 0, not_foreseen = 0;
};

template <PairKind kind>
void compare_with_walk(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, const std::string& what, AtStart& seen)
{
    for (const oracle::Pair& pair : pairs) {
        const double* const coordinates = pair[0].data();
        const scalar::PairPolynomials<kind> polynomials{coordinates, parameters};
        if (polynomials.apart()) continue;
        scalar::LeafSearch<kind> leaves{polynomials, parameters};
        const bool at_zero = walk_ends_at_zero(polynomials, parameters.leaf_width);
        ASSERT_EQ(leaves.first_contact() == 0.0, at_zero) << what << ": " << lossless(pair);
        seen.pairs += at_zero;
        seen.not_foreseen += at_zero && leaves.intervals() > 4;
    }
}

/// Pairs that rest on one another, such as boxes on a table, would take a hundred intervals each, and they come by thousands.
TEST(OrderedSearch, ContactAtTheStartTakesOneLook)
{
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds) {
        AtStart seen;
        for (const char* family : {"resting", "t0_contact", "zero_cubic", "collinear", "degenerate", "pointpoint", "f32_resting"}) {
            generate(family, kind, 304, 1000, pairs);
            // And the same next to contact, by 2^-56 to 2^-20 of a coordinate: where bounds decide.
            const std::size_t given = pairs.size();
            for (std::size_t i = 0; i < given; ++i) {
                oracle::Pair moved = pairs[i];
                const double by = std::ldexp(i % 2 == 0 ? 1.0 : -1.0, -56 + static_cast<int>(i / 2 % 37));
                for (std::size_t point = 0; point < 8; point += 4) moved[point][2] += by * (std::abs(moved[point][2]) + std::abs(moved[point][0]));
                pairs.push_back(moved);
            }
            const std::string what = std::string(kind_name(kind)) + " " + family;
            for (const double tolerance : {1.0, 1e-3, 1e-9, 1e-14})
                for (const double t_max : {1.0, 0.7}) {
                    const SearchParameters parameters{tolerance, t_max, false};
                    if (kind == oracle::Kind::vertex_face)
                        compare_with_walk<PairKind::vertex_face>(pairs, parameters, what, seen);
                    else
                        compare_with_walk<PairKind::edge_edge>(pairs, parameters, what, seen);
                }
        }
        EXPECT_GT(seen.pairs, 20000u);
        EXPECT_EQ(seen.not_foreseen, 0u) << "of " << seen.pairs;
    }
}

}  // namespace
}  // namespace fastccd::testing
