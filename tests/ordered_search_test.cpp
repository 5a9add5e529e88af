// The certified search with lanes, which looks at several intervals at once, against the one that looks at one after the other: the
// same answer, proof, roots and count of intervals for every pair, whatever was foreseen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <string_view>

#include <certified_search.hpp>
#include <interval_certificates.hpp>
#include <kernel_table.hpp>
#include <leaf_search.hpp>
#include <meeting.hpp>
#include <pair_polynomials.hpp>
#include <separation_search.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

std::size_t calls = 0;

template <PairKind kind>
bool has_certificate(const PairCoefficients& pair, double a, double b)
{
    return portable::apart_on<kind>(pair, a, b).value;
}

/// A kernel with lanes on any machine: one interval after the other.
template <PairKind kind>
unsigned apart_one_by_one(unsigned lanes, const PairCoefficients& pair, const double* starts, const double* ends, unsigned met, bool by_area)
{
    unsigned bits = 0;
    for (unsigned k = 0; k < lanes; ++k) {
        const double a = starts[k], b = ends[k];
        const bool apart = has_certificate<kind>(pair, a, b);
        if (apart && (met >> k & 1) != 0) ADD_FAILURE() << "a certificate on [" << a << ", " << b << "], said to have none";
        bits |= unsigned{apart || (by_area && portable::apart_by_area_on<kind>(pair, a, b).value)} << k;
    }
    return bits;
}
template <unsigned lanes>
unsigned apart_one_by_one(const PairCoefficients& pair, const double* starts, const double* ends, unsigned met, bool by_area)
{
    ++calls;
    return pair.kind == PairKind::vertex_face ? apart_one_by_one<PairKind::vertex_face>(lanes, pair, starts, ends, met, by_area)
                                              : apart_one_by_one<PairKind::edge_edge>(lanes, pair, starts, ends, met, by_area);
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

/// Walks both ways until there is a leaf, or `limit` intervals have been counted: the same one, the same count, the same waiting.
template <PairKind kind>
void expect_same_walk(const oracle::Pair& pair, const SearchParameters& parameters, unsigned limit)
{
    const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
    const auto is_leaf = [&](scalar::Interval i) { return i.width() <= parameters.leaf_width; };
    const auto walk = [&](const IntervalKernel* lanes, scalar::IntervalStack& stack, unsigned& counted) {
        scalar::OrderedSearch<kind> search{polynomials.coefficients(), parameters, lanes};
        stack.push_halves({0.0, 1.0});
        const auto found = search.next_without_certificate(stack, false, limit, is_leaf);
        counted = search.intervals;
        return found;
    };
    scalar::IntervalStack one_stack;
    unsigned one_counted = 0;
    const auto one = walk(nullptr, one_stack, one_counted);
    for (const IntervalKernel& kernel : interval_kernels()) {
        scalar::IntervalStack stack;
        unsigned counted = 0;
        ASSERT_EQ(walk(&kernel, stack, counted), one) << lossless(pair);
        ASSERT_EQ(counted, one_counted) << lossless(pair);
        ASSERT_EQ(stack.size(), one_stack.size()) << lossless(pair);
        for (unsigned k = 0; k < stack.size(); ++k) ASSERT_EQ(stack.peek(k), one_stack.peek(k)) << lossless(pair);
    }
}

TEST(OrderedSearch, TheSameWalkUpToAnyCap)
{
    std::vector<oracle::Pair> pairs;
    const SearchParameters parameters{1e-12, 1.0, false};
    for (const unsigned limit : {1u, 2u, 5u, 13u, 34u, 50u, 250u, 270u, 4096u}) {
        for (const char* family : {"near_interior", "boundary", "grazing", "zero_cubic"}) {
            generate(family, oracle::Kind::vertex_face, 308, 100, pairs);
            for (const oracle::Pair& pair : pairs) expect_same_walk<PairKind::vertex_face>(pair, parameters, limit);
            generate(family, oracle::Kind::edge_edge, 308, 100, pairs);
            for (const oracle::Pair& pair : pairs) expect_same_walk<PairKind::edge_edge>(pair, parameters, limit);
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
            ASSERT_GT(calls, 0u) << "the lanes were not asked";
            EXPECT_GT(intervals, 5 * calls);
        }
    }
}

struct Meetings {
    std::size_t met = 0, not_met = 0;
};

/// Looks next to where contact is expected, from 2^-60 to 2^-4 away from it, and if the pair is said to meet there, for certificates on
/// intervals of all widths around that time.
template <PairKind kind>
void look_for_certificates(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, const std::string& what, Meetings& seen)
{
    std::mt19937_64 bits{305};
    const auto width = [&] { return std::ldexp(1.0, -static_cast<int>(bits() % 57)); };
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        if (polynomials.apart()) continue;
        scalar::ExpectedContact expected{polynomials.coefficients(), parameters};
        const double first = expected.from(0.0), root = expected.root();
        if (first == expected.nowhere) continue;
        for (int k = 0; k < 12; ++k) {
            const double by = k < 2 ? 0.0 : width() / 16, near = k % 2 == 0 || root == expected.nowhere ? first : root;
            const double s = std::clamp(k % 4 < 2 ? near + by : near - by, 0.0, 1.0);
            const bool meets = scalar::meets_at<kind>(polynomials.coefficients(), s).value;
            ++(meets ? seen.met : seen.not_met);
            for (int i = 0; meets && i < 20; ++i) {
                const double before = i % 5 == 0 ? 0.0 : width(), after = i % 5 == 1 ? 0.0 : width();
                const scalar::Interval around{std::max(s - before, 0.0), std::min(s + after, 1.0)};
                ASSERT_FALSE(polynomials.apart(around))
                    << what << ", s = " << s << " in [" << around.a << ", " << around.b << "]: " << lossless(pair);
            }
        }
    }
}

TEST(OrderedSearch, NoCertificateAroundAMeeting)
{
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds) {
        Meetings seen;
        for (const double t_max : {1.0, 0.7}) {
            const SearchParameters parameters{1e-9, t_max, false};
            const auto look = [&](const std::string& what) {
                if (kind == oracle::Kind::vertex_face)
                    look_for_certificates<PairKind::vertex_face>(pairs, parameters, what, seen);
                else
                    look_for_certificates<PairKind::edge_edge>(pairs, parameters, what, seen);
            };
            for (const std::string& family : families()) {
                generate(family, kind, 306, 300, pairs);
                look(family);
            }
            pairs = ThinPairs{kind, 307}.next(2000);
            look("thin");
        }
        std::printf("%s: met at %zu times of %zu\n", kind_name(kind), seen.met, seen.met + seen.not_met);
        EXPECT_GT(seen.met, 20000u);
        EXPECT_GT(seen.not_met, 20000u);
    }
}

/// The walk to time 0, of which one look takes the place: the first leaf and, below it, the part that starts at 0 are reached
/// only if nothing wider has a certificate.
template <PairKind kind>
bool walk_ends_at_zero(const scalar::PairPolynomials<kind>& pair, double leaf_width)
{
    for (double end = leaf_width < 1.0 ? 0.5 : 1.0; end >= 0x1p-100; end *= 0.5) {
        const scalar::Interval i{0.0, end};
        if (pair.apart(i) || (end <= leaf_width && portable::apart_by_area_on<kind>(pair.coefficients(), 0.0, end).value)) return false;
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
        ThinPairs thin{kind, 308};
        for (const char* family : {"resting", "t0_contact", "zero_cubic", "collinear", "degenerate", "pointpoint", "f32_resting", "thin"}) {
            if (family == std::string_view{"thin"}) {
                pairs.resize(1000);
                for (oracle::Pair& pair : pairs) pair = thin.next_closest_at(0.0);
            } else {
                generate(family, kind, 304, 1000, pairs);
            }
            // And the same next to contact, by 2^-56 to 2^-20 of a coordinate: where bounds decide.
            const std::size_t given = pairs.size();
            for (std::size_t i = 0; i < given; ++i) {
                oracle::Pair moved = pairs[i];
                const double by = std::ldexp(i % 2 == 0 ? 1.0 : -1.0, -56 + static_cast<int>(i / 2 % 37));
                for (std::size_t point = 0; point < 8; point += 4) moved[point][2] += by * (std::abs(moved[point][2]) + std::abs(moved[point][0]));
                pairs.push_back(moved);
            }
            const std::string what = std::string(kind_name(kind)) + " " + family;
            const std::size_t seen_before = seen.pairs;
            for (const double tolerance : {1.0, 1e-3, 1e-9, 1e-14})
                for (const double t_max : {1.0, 0.7}) {
                    const SearchParameters parameters{tolerance, t_max, false};
                    if (kind == oracle::Kind::vertex_face)
                        compare_with_walk<PairKind::vertex_face>(pairs, parameters, what, seen);
                    else
                        compare_with_walk<PairKind::edge_edge>(pairs, parameters, what, seen);
                }
            EXPECT_GT(seen.pairs, seen_before) << "none of these begins in contact: " << what;
        }
        EXPECT_GT(seen.pairs, 20000u);
        EXPECT_EQ(seen.not_foreseen, 0u) << "of " << seen.pairs;
    }
}

/// Directions followed for few looks: a time until which the pair is apart, not before that of fewer looks, and with all of them the end.
TEST(OrderedSearch, DirectionsForFewLooks)
{
    std::size_t cut_short = 0;
    for (const auto kind : kinds) {
        const SearchParameters parameters{1e-9, 1.0, false};
        std::vector<oracle::Pair> pairs;
        generate("momentary_degenerate", kind, 205, 1000, pairs);
        const std::vector<oracle::Pair> thin = ThinPairs{kind, 206}.next(3000);
        pairs.insert(pairs.end(), thin.begin(), thin.end());
        for (const oracle::Pair& pair : pairs) {
            PairCoefficients coefficients;
            if (kind == oracle::Kind::vertex_face)
                coefficients = scalar::PairPolynomials<PairKind::vertex_face>{pair[0].data(), parameters}.coefficients();
            else
                coefficients = scalar::PairPolynomials<PairKind::edge_edge>{pair[0].data(), parameters}.coefficients();
            double before = 0.0;
            const double end = scalar::apart_until(coefficients, parameters, 0.0).toi;
            for (const unsigned most : {1u, 10u, 63u, 64u, 65u, 100u, 256u}) {
                const scalar::SearchResult few = scalar::apart_until(coefficients, parameters, 0.0, most);
                ASSERT_LE(few.intervals, most) << lossless(pair);
                ASSERT_GE(few.toi, before) << lossless(pair);
                ASSERT_LE(few.toi, end) << lossless(pair);
                cut_short += few.toi < end;
                before = few.toi;
            }
        }
    }
    std::printf("%zu times not to the end\n", cut_short);
    EXPECT_GT(cut_short, 100u);
}

TEST(OrderedSearch, SkippingLeavesWhatHoldsTheTime)
{
    const auto after_skipping_to = [](double time) {
        scalar::IntervalStack stack;
        stack.push_halves({0.0, 1.0});
        stack.skip_to(time, 0.25);
        return stack;
    };
    const auto first = [&](double time) { return after_skipping_to(time).peek(0); };
    EXPECT_EQ(first(0.3), (scalar::Interval{0.25, 0.5}));
    EXPECT_EQ(after_skipping_to(0.3).size(), 2u);
    EXPECT_EQ(first(0.0), (scalar::Interval{0.0, 0.5}));
    EXPECT_EQ(first(0.5).b, 0.5) << "contact at the very time is in the interval that ends with it, too";
    EXPECT_EQ(first(1.0), (scalar::Interval{0.75, 1.0})) << "and at 1 in no other";
    EXPECT_TRUE(after_skipping_to(std::numeric_limits<double>::infinity()).empty());
}

/// Where directions end and a certificate holds again, the search goes on in the very leaf that it had answered with: here the first one
/// holds the contact, too, or all of the step is left.
TEST(OrderedSearch, ResumesInWhatItAnsweredWith)
{
    const oracle::Pair vertex_face{{{0x1.fa7a0000018p-3, -0x1.99027ffffe8p-3, -0x1.ea586000002p-1},
                                    {0x1.fa7a000002p-3, -0x1.9902800001p-3, -0x1.ea586000006p-1},
                                    {0x1.fa7a000002p-3, -0x1.99027fffffp-3, -0x1.ea586000004p-1},
                                    {0x1.fa7a000002p-3, -0x1.99028001c4e9ap-3, -0x1.ea5860004f01p-1},
                                    {0x1.fa7a0000018p-3, -0x1.99027ffffe8p-3, -0x1.ea586000002p-1},
                                    {0x1.fa79fefbf3456p-3, -0x1.9902866d49fd4p-3, -0x1.ea586000006p-1},
                                    {0x1.fa7a000001p-3, -0x1.9902878428b3fp-3, -0x1.ea585d4c8ba52p-1},
                                    {-0x1.d809ce02becbcp-2, 0x1.773aa3c8e4cccp-1, -0x1.8b23e9ae37e44p-2}}};
    const oracle::Pair edge_edge{{{-0x1.01600b5cf32aap-1, -0x1.f7e7351ea52cdp-1, 0x1.d255b82cff41cp-22},
                                  {-0x1.015ffffffdp-1, -0x1.f7e7400001p-1, 0x1p-40},
                                  {-0x1.0160000003p-1, -0x1.f7e73fffffp-1, 0x1p-39},
                                  {-0x1.015ffffffep-1, -0x1.f7e7400001p-1, -0x1.8p-40},
                                  {-0x1.0160000003p-1, -0x1.f7e73ffffdp-1, -0x1p-41},
                                  {-0x1.015ffffffdp-1, -0x1.f7e7400002p-1, -0x1p-41},
                                  {-0x1.015ffffffdp-1, -0x1.f7e7400002p-1, -0x1p-41},
                                  {-0x1.015fffebf821p-1, -0x1.f7e7403db7b1cp-1, -0x1.39972c4c9a114p-28}}};
    for (const auto& [kind, pair] : {std::pair{oracle::Kind::vertex_face, vertex_face}, std::pair{oracle::Kind::edge_edge, edge_edge}}) {
        const oracle::Verdict truth = oracle::exact_ccd(kind, pair);
        ASSERT_TRUE(truth.contact);
        for (const double tolerance : {1.0, 1e-3, 1e-6, 1e-9, 1e-12}) {
            const SearchParameters parameters{tolerance, 1.0, false};
            const double toi = scalar::certified_search(pair_kind(kind), pair[0].data(), parameters).toi;
            EXPECT_LE(toi, truth.t_lo) << kind_name(kind) << ", " << tolerance;
        }
    }
}

template <PairKind kind>
std::size_t later_than_proven_nearby(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters)
{
    std::size_t later = 0;
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        if (polynomials.apart()) continue;
        scalar::LeafSearch<kind> leaves{polynomials, parameters};
        const double first = leaves.first_contact();
        if (first > 1.0 || leaves.proof_of_contact(first) != scalar::Proof::nearby || !leaves.in_doubt(first)) continue;
        const double apart = scalar::apart_until(polynomials.coefficients(), parameters, first).toi;
        const scalar::SearchResult found = scalar::certified_search(kind, pair[0].data(), parameters);
        EXPECT_EQ(found.toi, parameters.time(apart)) << lossless(pair);
        EXPECT_EQ(found.proof, scalar::Proof::nearby) << lossless(pair);
        later += first < apart;
    }
    return later;
}

/// Contact is certain near where it was found, but may be later than there: directions lead on towards it.
TEST(OrderedSearch, ProvenNearbyMayStillBeInDoubt)
{
    std::size_t later = 0;
    std::vector<oracle::Pair> pairs;
    const SearchParameters parameters{1e-15, 1.0, false};  // in wider leaves directions are asked before parts
    generate("mixed_exponent", oracle::Kind::vertex_face, 71, 800, pairs);
    later += later_than_proven_nearby<PairKind::vertex_face>(pairs, parameters);
    generate("mixed_exponent", oracle::Kind::edge_edge, 71, 800, pairs);
    later += later_than_proven_nearby<PairKind::edge_edge>(pairs, parameters);
    EXPECT_GT(later, 5u) << "nothing was tested";
}

}  // namespace
}  // namespace fastccd::testing
