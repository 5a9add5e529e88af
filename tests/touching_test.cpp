// Contact at a side, at an end, or next to the end of a leaf, which is reported without halving the leaf (kernels/touching.hpp): the verdict
// that halving would give, times that are not late (from lanes the same: touching_lanes_test.cpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <certified_search.hpp>
#include <leaf_search.hpp>
#include <touching_pairs.hpp>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "oracle/exact_distance.hpp"
#include "thin_pairs.hpp"
#include "touching_pairs_made.hpp"

namespace fastccd::testing {
namespace {

/// Whether halving a leaf down to the spacing of doubles leaves a part without any certificate, eq. 7 included.
template <PairKind kind>
bool halving_reports(const PairCoefficients& leaf)
{
    using namespace FASTCCD_KERNEL_NAMESPACE;
    scalar::IntervalStack stack;
    stack.push({0.0, 1.0});
    for (int looks = 0; !stack.empty(); ++looks) {
        const scalar::Interval i = stack.pop();
        if (looks > 100000) return false;
        if (apart_on<kind>(leaf, i.a, i.b).value || apart_by_area_on<kind>(leaf, i.a, i.b).value) continue;
        if (i.width() * leaf.duration <= time_in_step(leaf, i.a) * 0x1p-52) return true;
        stack.push_halves(i);
    }
    return false;
}

template <PairKind kind>
void compare_with_halving(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, const std::string& what,
                          std::size_t& touches, std::size_t& at_leaf_start)
{
    std::mt19937_64 bits{811};
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        if (polynomials.apart()) continue;
        scalar::ExpectedContact expected{polynomials.coefficients(), parameters};
        const double near = expected.from(0.0);
        if (near == expected.nowhere) continue;
        for (const scalar::Interval leaf : leaves_around(near, parameters)) {
            const PairCoefficients inside = polynomials.in_leaf(leaf);
            const auto touch = polynomials.touch(inside, parameters.bounds);
            if (!touch.present.value) continue;
            ++touches;
            const auto uniform = [&] { return std::ldexp(static_cast<double>(bits() >> 11), -53); };
            const auto is_apart = [&](double a, double b) { return FASTCCD_KERNEL_NAMESPACE::apart_on<kind>(inside, a, b).value; };
            const double at = (touch.time - leaf.a) / leaf.width(), until = (touch.lower_bound - leaf.a) / leaf.width();
            ASSERT_TRUE(leaf.contains(touch.time) && leaf.contains(touch.lower_bound) && touch.lower_bound <= touch.time)
                << what << ": " << lossless(pair);
            ASSERT_LE(touch.time - touch.lower_bound, 0.5 * leaf.width()) << what << ": " << lossless(pair);
            for (int k = 0; k < 8; ++k) {
                const double s = until * uniform();
                ASSERT_TRUE(until == 0.0 || is_apart(s, s)) << what << ", " << s << " of the leaf: " << lossless(pair);
            }
            at_leaf_start += touch.lower_bound == leaf.a;
            ASSERT_TRUE(halving_reports<kind>(inside)) << what << ": " << lossless(pair);
            for (int k = 0; k < 8; ++k) {
                // Where it meets is rounded to a time of the step; parts are no narrower than that.
                const double reach = std::ldexp(1.0, -static_cast<int>(bits() % 40)) + touch.time * 0x1p-52 / leaf.width();
                ASSERT_FALSE(is_apart(std::max(at - reach, 0.0), std::min(at + reach, 1.0))) << what << ": " << lossless(pair);
            }
        }
    }
}

TEST(Touching, IsReportedByHalvingToo)
{
    for (const auto kind : kinds)
        for (const double tolerance : {1e-4, 1e-9, 1e-12})
            for (const double t_max : {1.0, 0.7}) {
                std::size_t touches = 0, at_leaf_start = 0;
                const SearchParameters parameters{tolerance, t_max, false};
                for_each_family(kind, 812, amount(300), [&](const std::vector<oracle::Pair>& pairs, const std::string& family) {
                    if (kind == oracle::Kind::vertex_face)
                        compare_with_halving<PairKind::vertex_face>(pairs, parameters, family, touches, at_leaf_start);
                    else
                        compare_with_halving<PairKind::edge_edge>(pairs, parameters, family, touches, at_leaf_start);
                });
                std::printf("%s, E_tol %g, t_max %g: %zu leaves in which pairs touch, in %zu at their start\n", kind_name(kind), tolerance, t_max,
                            touches, at_leaf_start);
                EXPECT_GT(touches, amount(500));
                EXPECT_GT(at_leaf_start, amount(50));
            }
}

template <PairKind kind>
void compare_with_exact_times(oracle::Kind exact_kind, const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters,
                              const std::string& what, std::size_t& touches)
{
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        const scalar::SearchResult found = scalar::certified_search(kind, pair[0].data(), parameters);
        if (!std::isfinite(found.toi) || !(found.toi > 0.0)) continue;
        const double left = std::floor(found.toi * parameters.leaf_count) * parameters.leaf_width;
        const auto touch = polynomials.touch(polynomials.in_leaf({left, left + parameters.leaf_width}), parameters.bounds);
        if (!touch.present.value || touch.lower_bound != found.toi) continue;
        const oracle::Verdict exact = oracle::exact_ccd(exact_kind, pair);
        if (!exact.contact) continue;
        ++touches;
        ASSERT_LE(found.toi, exact.t_lo) << what << ": " << lossless(pair);
        // Earlier only where rounding hides all the while that it is not there yet, as where it grazes.
        for (int k = 1; k < 8 && exact.t_lo - found.toi > parameters.leaf_width; ++k) {
            const double s = found.toi + 0.125 * k * (exact.t_lo - found.toi);
            ASSERT_FALSE(polynomials.apart({s, s})) << what << ", at " << s << ": " << lossless(pair);
        }
    }
}

/// Never later than the exact first contact, nor earlier than that by more than the tolerance.
TEST(Touching, TimesAreNeitherLateNorEarly)
{
    for (const auto kind : kinds)
        for (const double tolerance : {1e-4, 1e-9, 1e-12}) {
            std::size_t touches = 0;
            const SearchParameters parameters{tolerance, 1.0, false};
            for (const char* family : {"boundary", "f32_boundary", "f32_near_boundary", "collinear", "zero_cubic", "parallel_vel", "binarygrid", "coplanar_map",
                                       "coplanar_grid"}) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 813, amount(300), pairs);
                if (kind == oracle::Kind::vertex_face)
                    compare_with_exact_times<PairKind::vertex_face>(kind, pairs, parameters, family, touches);
                else
                    compare_with_exact_times<PairKind::edge_edge>(kind, pairs, parameters, family, touches);
            }
            std::printf("%s, E_tol %g: %zu pairs touch\n", kind_name(kind), tolerance, touches);
            EXPECT_GT(touches, amount(100));
        }
}

template <PairKind kind>
void expect_no_contact(oracle::Kind exact_kind, const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, const std::string& what,
                       std::size_t& apart)
{
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        if (polynomials.apart()) continue;
        const oracle::Verdict exact = oracle::exact_ccd(exact_kind, pair);
        const double near = exact.contact ? exact.t_lo : scalar::ExpectedContact{polynomials.coefficients(), parameters}.from(0.0);
        if (near > 1.0) continue;
        for (const scalar::Interval leaf : leaves_around(near, parameters)) {
            if (polynomials.apart(leaf) || !polynomials.touch(polynomials.in_leaf(leaf), parameters.bounds).apart.value) continue;
            ++apart;
            ASSERT_FALSE(exact.contact && leaf.a <= exact.t_lo && exact.t_hi <= leaf.b) << what << ": " << lossless(pair);
        }
    }
}

/// By certificates that lead through them.
TEST(Touching, LeavesThatAreApartHoldNoContact)
{
    for (const auto kind : kinds)
        for (const double tolerance : {0.5, 1e-2, 1e-4, 1e-6}) {
            std::size_t apart = 0;
            const SearchParameters parameters{tolerance, 1.0, false};
            for_each_family(kind, 823, amount(300), [&](const std::vector<oracle::Pair>& pairs, const std::string& family) {
                if (kind == oracle::Kind::vertex_face)
                    expect_no_contact<PairKind::vertex_face>(kind, pairs, parameters, family, apart);
                else
                    expect_no_contact<PairKind::edge_edge>(kind, pairs, parameters, family, apart);
            });
            std::printf("%s, E_tol %g: %zu leaves apart by several certificates\n", kind_name(kind), tolerance, apart);
            EXPECT_GT(apart, amount(20));
        }
}

struct Touches {
    std::size_t count = 0;
    double farthest = 0.0;  ///< Largest exact distance at one, relative to the norm of the extents at both ends.
};

template <PairKind kind>
void add_touches(oracle::Kind exact_kind, const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, Touches& shaped, Touches& thin)
{
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        scalar::ExpectedContact expected{polynomials.coefficients(), parameters};
        for (double near = expected.from(0.0); near != expected.nowhere; near = expected.from(std::nextafter(near, 2.0)))
            for (const scalar::Interval leaf : leaves_around(near, parameters)) {
                const auto touch = polynomials.touch(polynomials.in_leaf(leaf), parameters.bounds);
                if (!touch.present.value) continue;
                Touches& touches = FASTCCD_KERNEL_NAMESPACE::well_shaped_at<kind>(polynomials.coefficients(), touch.time, 1.0).value ? shaped : thin;
                ++touches.count;
                double size_squared = 0.0;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    double extent = 0.0;
                    for (const std::size_t end : {0u, 4u})
                        for (std::size_t i = 1; i < 4; ++i) extent = std::max(extent, std::abs(pair[end + i][axis] - pair[end][axis]));
                    size_squared += extent * extent;
                }
                const mpq_class distance_squared = oracle::squared_distance(exact_kind, pair, touch.time);
                touches.farthest = std::max(touches.farthest, std::sqrt(distance_squared.get_d() / size_squared));
            }
    }
}

/// Who touches is as close as is promised of its shape where it is reported, random pairs of ordinary shape closer (nothing_invented_test.cpp).
TEST(Touching, IsNoFartherThanRoundingHides)
{
    for (const auto kind : kinds) {
        Touches shaped, thin;
        const SearchParameters parameters{1e-9, 1.0, false};
        const auto look = [&](const std::vector<oracle::Pair>& pairs) {
            if (kind == oracle::Kind::vertex_face)
                add_touches<PairKind::vertex_face>(kind, pairs, parameters, shaped, thin);
            else
                add_touches<PairKind::edge_edge>(kind, pairs, parameters, shaped, thin);
        };
        look(ThinPairs{kind, 815}.next(amount(60000)));
        std::vector<oracle::Pair> pairs;
        for (const char* family : {"near_boundary", "parallel_slide", "momentary_degenerate", "collinear", "t1_contact", "grazing"}) {
            generate(family, kind, 816, amount(2000), pairs);
            look(pairs);
        }
        std::printf("%s: %zu touches, at a distance of %.2g u of the pair's size or less; %zu of nearly degenerate shape, %.2g u\n", kind_name(kind),
                    shaped.count, shaped.farthest * 0x1p53, thin.count, thin.farthest * 0x1p53);
        EXPECT_LE(shaped.farthest, 0x1p10 * 0x1p-53);
        EXPECT_LE(thin.farthest, 0x1p10 * 0x1p-53);
        EXPECT_GT(shaped.count, amount(3000));
        EXPECT_GT(thin.count, amount(3000));
    }
}

/// The two edges of a pair, and the ends of each, are in no particular order.
TEST(Touching, ShapeDoesNotDependOnTheOrderOfEdges)
{
    const SearchParameters parameters{1e-9, 1.0, false};
    std::size_t with_area = 0, without = 0, both = 0;
    std::mt19937_64 bits{817};
    for_each_family(oracle::Kind::edge_edge, 818, amount(200), [&](const std::vector<oracle::Pair>& pairs, const std::string&) {
        constexpr std::size_t orders[][4] = {{0, 1, 2, 3}, {2, 3, 0, 1}, {1, 0, 2, 3}, {3, 2, 0, 1}};
        for (const oracle::Pair& pair : pairs) {
            const double s = std::ldexp(static_cast<double>(bits() >> 11), -53);
            unsigned shaped = 0;
            for (const auto& order : orders) {
                oracle::Pair other;
                for (std::size_t i = 0; i < 4; ++i) other[i] = pair[order[i]], other[4 + i] = pair[4 + order[i]];
                shaped += scalar::PairPolynomials<PairKind::edge_edge>{other[0].data(), parameters}.has_area(s);
            }
            ++(shaped == 4 ? with_area : shaped == 0 ? without : both);
        }
    });
    std::printf("%zu pairs of edges with an area, %zu without, %zu as they are written\n", with_area, without, both);
    // What the area is compared with does depend on which end comes first: on the differences to it.
    EXPECT_LT(20 * both, with_area + without);
    EXPECT_GT(without, amount(1000));
}

struct ApartBefore {
    std::size_t by_one = 0, by_several = 0, throughout = 0;  ///< Pairs, by certificates.
};

template <PairKind kind>
void expect_apart_before(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, const std::string& what, ApartBefore& seen)
{
    using namespace FASTCCD_KERNEL_NAMESPACE;
    const double width = parameters.leaf_width;
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        if (polynomials.apart()) continue;
        const PairCoefficients& whole = polynomials.coefficients();
        const double until = apart_before<kind>(whole, with_margins<kind>(whole), 0.0, parameters, less_equal(0.0, 0.0));
        if (until == 0.0) continue;
        ++(polynomials.apart({0.0, until}) ? seen.by_one : until < 1.0 ? seen.by_several : seen.throughout);
        for (double left = 0.0; left < until; left += width)
            ASSERT_TRUE(polynomials.apart({left, left + width})) << what << ", " << left << ": " << lossless(pair);
    }
}

/// From one certificate to the next: each leaf before has one.
TEST(Touching, EachLeafBeforeIsApart)
{
    for (const auto kind : kinds) {
        ApartBefore seen;
        for (const double tolerance : {0x1p-3, 0x1p-9})
            for (const double t_max : {1.0, 0.7}) {
                const SearchParameters parameters{tolerance, t_max, false};
                for_each_family(kind, 819, amount(250), [&](const std::vector<oracle::Pair>& pairs, const std::string& family) {
                    if (kind == oracle::Kind::vertex_face)
                        expect_apart_before<PairKind::vertex_face>(pairs, parameters, family, seen);
                    else
                        expect_apart_before<PairKind::edge_edge>(pairs, parameters, family, seen);
                });
            }
        std::printf("%s: by one certificate %zu, by several %zu, throughout %zu\n", kind_name(kind), seen.by_one, seen.by_several, seen.throughout);
        EXPECT_GT(seen.by_one, amount(1000));
        EXPECT_GT(seen.by_several, amount(500));
        EXPECT_GT(seen.throughout, amount(1000));
    }
}

/// Up to where a certificate beyond bounds and margins just holds, the search finds one on every part.
template <PairKind kind>
void expect_apart_in_parts(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters, const std::string& what, std::size_t& seen)
{
    std::mt19937_64 bits{821};
    const auto uniform = [&] { return std::ldexp(static_cast<double>(bits() >> 11), -53); };
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        if (polynomials.apart()) continue;
        const auto sure = FASTCCD_KERNEL_NAMESPACE::with_margins<kind>(polynomials.coefficients());
        const auto holds_to = [&](double a, double b) { return FASTCCD_KERNEL_NAMESPACE::apart_on<kind>(sure, a, b).value; };
        for (const double a : {0.0, 0.25 * uniform(), uniform()}) {
            if (!holds_to(a, a)) continue;
            double held = a, lost = 1.0;
            if (holds_to(a, lost)) held = lost;
            for (int k = 0; k < 64 && held < lost; ++k) {
                const double middle = held + 0.5 * (lost - held);
                (holds_to(a, middle) ? held : lost) = middle;
            }
            for (int k = 0; k < 16; ++k) {
                const double reach = (held - a) * std::ldexp(uniform(), -static_cast<int>(bits() % 52));
                const double q = k % 2 == 0 ? held : std::max(held - reach, a), p = std::max(q - (k % 4 < 2 ? 0.0 : reach), a);
                ++seen;
                ASSERT_TRUE(polynomials.apart({p, q})) << what << ", " << a << " to " << held << ": " << lossless(pair);
            }
        }
    }
}

TEST(Touching, CertificatesWithMarginsHoldOnParts)
{
    for (const auto kind : kinds) {
        std::size_t seen = 0;
        for (const double t_max : {1.0, 0.7}) {
            const SearchParameters parameters{1e-9, t_max, false};
            for_each_family(kind, 822, amount(200), [&](const std::vector<oracle::Pair>& pairs, const std::string& family) {
                if (kind == oracle::Kind::vertex_face)
                    expect_apart_in_parts<PairKind::vertex_face>(pairs, parameters, family, seen);
                else
                    expect_apart_in_parts<PairKind::edge_edge>(pairs, parameters, family, seen);
            });
        }
        EXPECT_GT(seen, amount(100000));
    }
}

}  // namespace
}  // namespace fastccd::testing
