// Nothing is invented: at the reported toi, the exact distance of the pair is at most
//
//     E_tol v + 2^8 sqrt(u) s,      u = 2^-53, 2^8 sqrt(u) = 2.7e-6,
//     E_tol v + 2^3 cbrt(u) s,      2^3 cbrt(u) = 3.8e-5, for two edges both of which are shorter than 2^-8 s then,
//
// v the largest relative velocity of two end points, one of each primitive (per unit of t), and s the norm of the
// extents: the largest |component| per axis of x_i - x_0, i = 1, 2, 3, at both ends of the step. Pairs of ordinary shape
// (see well_shaped) are within E_tol v + 2^10 u s = E_tol v + 1.1e-13 s.
//
// Where it comes from. A leaf is reported either because contact within it is proven: then the points that touch are
// at most E_tol v apart at its left end. Or because, halved down to where time ends, a part of it has no certificate of
// absence. There only rounding is left, and all certificates fail for one configuration of points:
//
// Vertex-face, at distance d. Let N = XY + YZ + ZX <= s^2, and A = 2 area() N: the area test fails, so the sum of the
// partial areas exceeds the whole by at most A <= 576 u s^2. Let h be the height over the face's plane, g the distance
// to the face within it, l the longest side.
// - Axis gaps fail, so the face reaches past the vertex along the axis where the shortest vector is longest: some
//   corner is at least d / sqrt(3) - O(u s) from the nearest point, hence l too.
// - If h >= 0.43 d: each side e at distance g_e within the plane adds e (sqrt(h^2 + g_e^2) - g_e) >= e h^2 / (h + 2 g_e);
//   for the longest side, with g_e <= g + l, that is at least 0.033 d^2.
// - Else g >= 0.9 d: the corner found above is off the shortest vector's line by at least 0.28 d, and the partial areas
//   outside add at least 0.22 d^2, at a side as at a corner.
// So d^2 <= A / 0.033, d <= 133 sqrt(u) s. With t_max other than 1 rho is 10, and A <= 1008 u s^2: d <= 175 sqrt(u) s.
//
// Edge-edge. The area test says little: its excess may vanish for edges well apart. Let h be the distance of the lines through
// the edges, n the unit normal to both. The cubic is h |e1| |e2| sin(angle) <= 46 u m, m the sum of its terms' magnitudes, at most
// 6 XYZ <= 1.2 s^3, so <= 54 u s^3. The projections fail: seen along each axis x_k the edges cross, up to O(u) s, so that there
// are points a_k, b_k on them with a_k - b_k = (h / n_k) x_k. Along the axis where |n_k| >= 1 / sqrt(3), that is at most
// sqrt(3) h: so d <= sqrt(3) h. And seen along n, the three lie in the parallelogram of the edges, whose width across e1 is
// |e2| sin(angle). With w a unit vector across e1 and n, they are h w_k / n_k wide there, numbers whose mean with the weights
// n_k^2 is w . n = 0 and whose mean square is h^2: they spread over at least 2 h. So |e1| sin(angle) and |e2| sin(angle) >= 2 h, and
// - 4 h^3 <= 54 u s^3: d <= 4.2 cbrt(u) s (with rho = 10 and 100 u m: 5.4), as if both edges were as short as h;
// - 2 h^2 e <= 54 u s^3, e the longer edge: d <= 9 sqrt(u) s sqrt(s / e) (14), for e above 2^-8 s below 2^8 sqrt(u) s.
// Where they would cross outside an edge, axis gaps fail only at an angle, and the edge functions give d^2 <= O(26 u s^2).
//
// Both roots are real: distances of sqrt(u) s are found below, for faces and angles as thin, and of cbrt(u) s, for edges that
// shrink to a point. Where the search reaches its cap of intervals in a leaf or in all, it reports the first leaf that it cannot
// clear at once, which nothing shows to be as close. Such pairs, momentarily degenerate ones above all, stay within 2^11 sqrt(u) s
// here, and so did the worst that hill climbing found; that bound is measured, not derived.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <certified_search.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_distance.hpp"
#include "test_data.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};
constexpr double u = 0x1p-53;
const double thin_bound = 0x1p8 * std::sqrt(u);
const double shrinking_bound = 0x1p3 * std::cbrt(u);
const double capped_bound = 0x1p11 * std::sqrt(u);
constexpr double well_shaped_bound = 0x1p10 * u;

// Squares of coordinates up to 1e308 have no double; long double has the range on all machines that the library
// runs on.
using Wide = long double;
static_assert(std::numeric_limits<Wide>::max_exponent > 4000);

Wide wide_root(const mpq_class& value)
{
    long exponent = 0;
    const double fraction = mpf_get_d_2exp(&exponent, mpf_class(value, 256).get_mpf_t());
    return std::sqrt(std::ldexp(static_cast<Wide>(fraction), static_cast<int>(exponent)));
}

struct Measure {
    Wide distance, speed, size;
    bool shrunk;  ///< Two edges, both shorter than 2^-8 of the size.
};

Measure measure(oracle::Kind kind, const oracle::Pair& pair, double toi)
{
    Measure m{wide_root(oracle::squared_distance(kind, pair, toi)), 0, 0, kind == oracle::Kind::edge_edge};
    const auto norm = [](Wide x, Wide y, Wide z) { return std::sqrt(x * x + y * y + z * z); };
    const std::size_t first = kind == oracle::Kind::vertex_face ? 1 : 2;
    for (std::size_t i = 0; i < first; ++i)
        for (std::size_t j = first; j < 4; ++j) {
            Wide v[3];
            for (std::size_t k = 0; k < 3; ++k)
                v[k] = (Wide{pair[j + 4][k]} - pair[i + 4][k]) - (Wide{pair[j][k]} - pair[i][k]);
            m.speed = std::max(m.speed, norm(v[0], v[1], v[2]));
        }
    Wide extent[3] = {};
    for (std::size_t i = 1; i < 4; ++i)
        for (std::size_t end : {0u, 4u})
            for (std::size_t k = 0; k < 3; ++k)
                extent[k] = std::max(extent[k], std::fabs(Wide{pair[i + end][k]} - pair[end][k]));
    m.size = norm(extent[0], extent[1], extent[2]);
    for (std::size_t first_end : {0u, 2u}) {
        Wide edge[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = [&](std::size_t i) { return (1 - Wide{toi}) * pair[i][k] + Wide{toi} * pair[i + 4][k]; };
            edge[k] = at(first_end + 1) - at(first_end);
        }
        m.shrunk = m.shrunk && norm(edge[0], edge[1], edge[2]) <= 0x1p-8L * m.size;
    }
    return m;
}

bool well_shaped(const std::string& family)
{
    for (const char* clear : {"uniform", "scale", "big_offset", "common_velocity", "near_interior", "simcloth"})
        if (family == clear || family == std::string("f32_") + clear) return true;
    return false;
}

struct Worst {
    double beyond = 0;  ///< (distance - E_tol v) / s, of pairs within the caps of the search.
    double beyond_shrunk = 0;  ///< The same of edges that are as good as points.
    double beyond_capped = 0;
    std::size_t reported = 0;
    oracle::Pair pair{};
};

void measure_all(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, double tolerance, Worst& worst, double t_max = 1.0)
{
    Options options;
    options.tolerance = tolerance;
    options.t_max = t_max;
    const Answer found = answer(kind, interleaved(pairs), options);
    const SearchParameters parameters{tolerance, t_max, false};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!(found.toi[i] <= 1.0)) continue;
        ++worst.reported;
        const Measure m = measure(kind, pairs[i], found.toi[i]);
        if (m.distance == 0) continue;
        ASSERT_GT(m.size, 0);
        const double beyond = static_cast<double>((m.distance - tolerance * m.speed) / m.size);
        if (beyond <= std::min({worst.beyond, worst.beyond_shrunk, worst.beyond_capped}) || beyond <= 0) continue;
        const auto intervals = scalar::certified_search(pair_kind(kind), pairs[i][0].data(), parameters).intervals;
        double& group = intervals >= 512 ? worst.beyond_capped  // 512: the cap within one leaf
                        : m.shrunk       ? worst.beyond_shrunk
                                         : worst.beyond;
        group = std::max(group, beyond);
        if (beyond >= std::max({worst.beyond, worst.beyond_shrunk, worst.beyond_capped})) worst.pair = pairs[i];
    }
}

/// `shrunk_bound`: of edges that are as good as points; 0: the same as of others, which is enough for all pairs but some.
void expect_close(oracle::Kind kind, const std::string& name, double tolerance, const Worst& worst, double bound, double shrunk_bound = 0)
{
    if (std::max({worst.beyond, worst.beyond_shrunk, worst.beyond_capped}) > well_shaped_bound)
        std::printf("%-11s %-26s E_tol %g: %zu reported, beyond E_tol v at most %.3g s = %.3g sqrt(u) s; shrunk edges %.3g s; with a cap reached %.3g s\n",
                    kind_name(kind), name.c_str(), tolerance, worst.reported, worst.beyond, worst.beyond / std::sqrt(u),
                    worst.beyond_shrunk, worst.beyond_capped);
    EXPECT_LE(worst.beyond, bound) << name << " E_tol " << tolerance << ' ' << lossless(worst.pair);
    EXPECT_LE(worst.beyond_shrunk, std::max(bound, shrunk_bound)) << name << " E_tol " << tolerance << ' ' << lossless(worst.pair);
    EXPECT_LE(worst.beyond_capped, bound < thin_bound ? bound : capped_bound) << name << " E_tol " << tolerance << ' ' << lossless(worst.pair);
}

TEST(NothingInvented, MadePairs)
{
    std::size_t reported = 0;
    for (const auto kind : kinds)
        for (const std::string& family : families())
            for (const double tolerance : {1e-3, 1e-9, 1e-12}) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 71, 250, pairs);
                Worst worst;
                measure_all(kind, pairs, tolerance, worst);
                expect_close(kind, family, tolerance, worst, well_shaped(family) ? well_shaped_bound : thin_bound);
                reported += worst.reported;
            }
    EXPECT_GT(reported, 10000u);
}

TEST(NothingInvented, ThinPairs)
{
    for (const auto kind : kinds) {
        const auto pairs = ThinPairs{kind, 72}.next(25000);
        double largest = 0;
        for (const double tolerance : {1e-3, 1e-9, 1e-12}) {
            Worst worst;
            measure_all(kind, pairs, tolerance, worst);
            expect_close(kind, "thin pairs", tolerance, worst, thin_bound);
            largest = std::max({largest, worst.beyond, worst.beyond_shrunk});
        }
        EXPECT_GT(largest, 0.1 * std::sqrt(u)) << "none of these pairs amplifies rounding: nothing was tested";
    }
}

/// Positions at t_max are rounded.
TEST(NothingInvented, UpToAnEarlierTime)
{
    constexpr double t_max = 0.7;
    std::vector<oracle::Pair> pairs;
    std::size_t reported = 0;
    for (const auto kind : kinds)
        for (const double tolerance : {1e-3, 1e-9}) {
            for (const std::string& family : families()) {
                generate(family, kind, 73, 100, pairs);
                Worst worst;
                measure_all(kind, pairs, tolerance, worst, t_max);
                expect_close(kind, family, tolerance, worst, well_shaped(family) ? well_shaped_bound : thin_bound);
                reported += worst.reported;
            }
            Worst worst;
            measure_all(kind, ThinPairs{kind, 74}.next(5000), tolerance, worst, t_max);
            expect_close(kind, "thin pairs", tolerance, worst, thin_bound);
        }
    EXPECT_GT(reported, 2000u);
}

/// Two edges that shrink to one point at the end of the step, touching in every projection, and in no plane.
TEST(NothingInvented, EdgesThatShrinkToAPoint)
{
    const oracle::Pair pair{{{0, 0, -1}, {-1, -1, 0}, {0, 0, 0}, {-1, -1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    const oracle::Pair apart{{{0, 0, -1}, {-1, 0, 0}, {0, 0, 0}, {-1, -1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    double largest = 0;
    for (const double tolerance : {1e-3, 1e-9, 1e-12})
        for (const double t_max : {1.0, 0x1.fffffp-1}) {
            Worst worst;
            measure_all(oracle::Kind::edge_edge, {pair, apart}, tolerance, worst, t_max);
            expect_close(oracle::Kind::edge_edge, "edges that shrink", tolerance, worst, thin_bound, shrinking_bound);
            largest = std::max(largest, worst.beyond_shrunk);
        }
    EXPECT_GT(largest, thin_bound) << "no cube root: nothing was tested";
}

/// Two short edges that pass each other at some 1e-10 of the extents: on its way past, the search uses up all its
/// intervals. What it has not looked at by then, most of the step, is far from contact and must be cleared.
TEST(NothingInvented, WhatIsLeftAtTheCapIsStillLookedAt)
{
    const oracle::Pair pair{{{0x1.ed5df1d01be48p-13, -0x1.0a984abe7086ap-10, 0x1.6afb48c59f6b7p-11},
                             {-0x1.e5a1beb12b2a7p-12, -0x1.9cf816c8fb99bp-11, 0x1.2eb07787f5db7p-8},
                             {0x1.0367287629a21p-17, -0x1.54adf75f0b07cp-19, -0x1.6c9704b39f3f1p-15},
                             {-0x1.08f3de19e3e3dp-17, 0x1.5bf7d04fa472dp-19, 0x1.7463d21326caep-15},
                             {0x1.3f0ed77cbdca1p-12, 0x1.72e25a89bafedp-12, -0x1.5fb2ad8b1b1c9p-9},
                             {-0x1.9d41e01c7b52ap-12, 0x1.31a9abf8c2f31p-11, 0x1.45dedea6d17f1p-10},
                             {0x1.0367287629a21p-17, -0x1.54adf75f0b07cp-19, -0x1.6c9704b39f3f1p-15},
                             {-0x1.08f3de19e3e3dp-17, 0x1.5bf7d04fa472dp-19, 0x1.7463d21326caep-15}}};
    // And two that never touch, of which most of the step was left.
    const oracle::Pair apart{{{0x1.ff1571e61033ap-11, -0x1.ffffffff7387cp-11, 0x1.ffa5146c29b05p-11},
                              {0x1.ff1943a6d1c1p-11, -0x1.fffcd800ec536p-11, 0x1.ffa5146c29b04p-11},
                              {0x1.ff15490288319p-11, -0x1.00000000bd07p-10, 0x1.ffa51464c2b54p-11},
                              {-0x1.497a49e367356p-10, 0x1.7ffffffd1d808p-1, -0x1.8001a91fa527fp-1},
                              {0x1.fc00007788c96p+1, -0x1.d756560d11328p-3, -0x1.7f5f3e9975656p+1},
                              {-0x1.ff23873807974p+1, 0x1.80800030a809cp-1, -0x1.ff7fff9874ba7p-1},
                              {-0x1.0365cab0e6f49p+1, -0x1.0340e1017cdb5p-10, -0x1.c3p+0},
                              {-0x1.b2a5c48925f71p-1, -0x1.d4038e65c30aap-5, -0x1.c300000000571p+0}}};
    for (const double tolerance : {1e-9, 1e-12, 1e-15}) {
        Worst worst;
        measure_all(oracle::Kind::edge_edge, {pair, apart}, tolerance, worst);
        expect_close(oracle::Kind::edge_edge, "passing edges", tolerance, worst, thin_bound);
    }
}

/// The worst of a million pairs that hill climbing led through, up to the cap and to large distances there.
TEST(NothingInvented, WorstAtTheCap)
{
    const oracle::Pair pair{{{-0x1.320e448000001p+16, -0x1.bb4ff9cp+16, -0x1.46d5b806c5c0cp+16},
                             {0x1.7ap+1, 0x1.65998ba7c99edp-23, 0x0p+0},
                             {0x1.000000001ea34p-8, 0x1.3a00060436f5dp-1, 0x1.b800010154a83p-2},
                             {0x1p-8, -0x1.adff3ad0e204p-1, 0x1.59bd4472364a4p+1},
                             {0x1.320f837f8fc05p+15, 0x1.bb4f1caffd03dp+15, 0x1.46d7ccffffffbp+15},
                             {0x1.7a00797992cb4p+1, -0x1.4cfffa48247bdp+0, 0x1.ba00000000003p-2},
                             {0x1.80000b89d1d5ap-9, 0x1.3a0016c90de97p-1, 0x1.00308d232c094p-3},
                             {0x1.ffffffffffffep-9, -0x1.adfffc11b2425p-1, 0x1.59cp+1}}};
    Worst worst;
    measure_all(oracle::Kind::vertex_face, {pair}, 1e-9, worst);
    expect_close(oracle::Kind::vertex_face, "worst at the cap", 1e-9, worst, thin_bound);
    EXPECT_GT(worst.beyond_capped, 0.25 * capped_bound) << "no longer the worst: another is to be looked for";
}

TEST(NothingInvented, PublicData)
{
    const auto data = data_directory();
    if (!data) GTEST_SKIP() << no_data_message;
    auto sets = load_hardcases(*data);
    for (QuerySet& set : load_queries(*data)) sets.push_back(std::move(set));
    for (QuerySet& set : sets) {
        if (set.pairs.size() > 500) set.pairs.resize(500);
        Worst worst;
        measure_all(set.kind, set.pairs, 1e-9, worst);
        expect_close(set.kind, set.name, 1e-9, worst, thin_bound);
    }
}

}  // namespace
}  // namespace fastccd::testing
