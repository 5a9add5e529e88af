// Nothing is invented: at the reported toi, the exact distance of the pair is at most
//
//     E_tol v + 2^12 u s,      u = 2^-53, 2^12 u = 4.5e-13,
//
// v the largest relative velocity of two end points, one of each primitive (per unit of t), and s the norm of the
// extents: the largest |component| per axis of x_i - x_0, i = 1, 2, 3, at both ends of the step. Here pairs stay within a quarter of that.
// Where more than 31 looks along directions are needed, it is 2^(11 + n/16) u s after n of them, up to 2^28 u s = 3e-8 s; and after 4,096 the
// time reached is the answer.
//
// Where it comes from. A leaf is reported because contact within it is proven: then the points that touch are at most E_tol v
// apart at its left end. Or because a part of it, halved down to where time ends, has no certificate of absence. There only
// rounding is left: of volumes and areas, for shapes that do not amplify it (has_area_at in kernels/touching.hpp). Otherwise it is lost in
// rounding while the distance is still sqrt(u) s, or cbrt(u) s for edges that shrink to a point. So where shapes are nearly degenerate then,
// and where the search came to a cap, the search with a separation goes on (scalar/certified_search.cpp), unless its first looks have told
// already that it would stop (kernels/no_distance.hpp). It stops within 2^8 u S of contact (SeparationBounds::beyond()), S the sum of its extents.
// Axes are multiplied so that these are from 1/2 to 1, S < 3: back in the pair's units components are at most 2 s times as large, which makes
// 2^8 3 2 u s < 2^11 u s.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <certified_search.hpp>
#include <pair_polynomials.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "oracle/exact_distance.hpp"
#include "test_data.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};
constexpr double u = 0x1p-53;
constexpr double promised = 0x1p12 * u, bound = 0x1p10 * u;

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
};

Measure measure(oracle::Kind kind, const oracle::Pair& pair, double toi)
{
    Measure m{wide_root(oracle::squared_distance(kind, pair, toi)), 0, 0};
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
    return m;
}

struct Worst {
    double beyond = 0;  ///< (distance - E_tol v) / s
    std::size_t reported = 0;
    oracle::Pair pair{};
};

void measure_all(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, double tolerance, Worst& worst, double t_max = 1.0)
{
    Options options;
    options.tolerance = tolerance;
    options.t_max = t_max;
    const Answer found = answer(kind, interleaved(pairs), options);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!(found.toi[i] <= 1.0)) continue;
        ++worst.reported;
        const Measure m = measure(kind, pairs[i], found.toi[i]);
        if (m.distance == 0) continue;
        ASSERT_GT(m.size, 0);
        const double beyond = static_cast<double>((m.distance - tolerance * m.speed) / m.size);
        if (beyond <= worst.beyond) continue;
        worst.beyond = beyond;
        worst.pair = pairs[i];
    }
}

void expect_close(oracle::Kind kind, const std::string& name, double tolerance, const Worst& worst, double allowed = bound)
{
    if (worst.beyond > 0.25 * bound)
        std::printf("%-11s %-26s E_tol %g: %zu reported, beyond E_tol v at most %.0f u s\n", kind_name(kind), name.c_str(), tolerance,
                    worst.reported, worst.beyond / u);
    EXPECT_LE(worst.beyond, allowed) << name << " E_tol " << tolerance << ' ' << lossless(worst.pair);
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
                expect_close(kind, family, tolerance, worst);
                reported += worst.reported;
            }
    EXPECT_GT(reported, 10000u);
}

/// Reported although their shape amplifies rounding.
template <PairKind kind>
std::size_t without_area(const std::vector<oracle::Pair>& pairs, const SearchParameters& parameters)
{
    std::size_t count = 0;
    for (const oracle::Pair& pair : pairs) {
        const double toi = scalar::certified_search(kind, pair[0].data(), parameters).toi;
        count += toi <= 1.0 && !scalar::PairPolynomials<kind>{pair[0].data(), parameters}.has_area(toi);
    }
    return count;
}

TEST(NothingInvented, ThinPairs)
{
    for (const auto kind : kinds) {
        const auto pairs = ThinPairs{kind, 72}.next(25000);
        for (const double tolerance : {1e-3, 1e-9, 1e-12}) {
            Worst worst;
            measure_all(kind, pairs, tolerance, worst);
            expect_close(kind, "thin pairs", tolerance, worst);
        }
        const SearchParameters parameters{1e-9, 1.0, false};
        const std::size_t thin = kind == oracle::Kind::vertex_face ? without_area<PairKind::vertex_face>(pairs, parameters)
                                                                   : without_area<PairKind::edge_edge>(pairs, parameters);
        std::printf("%s: %zu of them without area\n", kind_name(kind), thin);
        EXPECT_GT(thin, 500u) << "none of these pairs amplifies rounding: nothing was tested";
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
                expect_close(kind, family, tolerance, worst);
                reported += worst.reported;
            }
            Worst worst;
            measure_all(kind, ThinPairs{kind, 74}.next(5000), tolerance, worst, t_max);
            expect_close(kind, "thin pairs", tolerance, worst);
        }
    EXPECT_GT(reported, 2000u);
}

/// Two edges that shrink to one point at the end of the step, touching in every projection, and in no plane: what volumes and areas tell is
/// lost in rounding at a distance of cbrt(u) s.
TEST(NothingInvented, EdgesThatShrinkToAPoint)
{
    const oracle::Pair pair{{{0, 0, -1}, {-1, -1, 0}, {0, 0, 0}, {-1, -1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    const oracle::Pair apart{{{0, 0, -1}, {-1, 0, 0}, {0, 0, 0}, {-1, -1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    for (const double tolerance : {1e-3, 1e-9, 1e-12})
        for (const double t_max : {1.0, 0x1.fffffp-1}) {
            Worst worst;
            measure_all(oracle::Kind::edge_edge, {pair, apart}, tolerance, worst, t_max);
            expect_close(oracle::Kind::edge_edge, "edges that shrink", tolerance, worst);
            EXPECT_EQ(worst.reported, t_max == 1.0 ? 2u : 1u);  // the first pair has a corner in common
        }
}

/// Two short edges that pass each other at some 1e-10 of the extents: on its way past, the search once used up all its
/// intervals (cap_test.cpp). What comes after that, most of the step, is far from contact and must be cleared.
TEST(NothingInvented, WhatComesAfterAlmostMeetingIsStillLookedAt)
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
        expect_close(oracle::Kind::edge_edge, "passing edges", tolerance, worst);
    }
}

/// Hill climbing led to the cap on intervals here, at a distance of 2e-5 s, before the search went on along directions.
TEST(NothingInvented, FarWhereTheCapWas)
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
    expect_close(oracle::Kind::vertex_face, "worst at the cap", 1e-9, worst);
}

/// A contact that is proven not in the leaf found but later, the pair 1.3e-6 s apart in that leaf.
TEST(NothingInvented, ProvenLater)
{
    const oracle::Pair pair{{{-0x1.000034e3709b3p+0, -0x1.ffee76b60690ep+0, 0x1.002226cfec105p+3},
                             {-0x1.00002d0fd8acfp+0, -0x1.fffffda6f2d56p+0, 0x1.002287c491d5cp+3},
                             {-0x1.0000357fb377p+0, -0x1.000000e040a45p+1, 0x1.00229cde4d77p+3},
                             {-0x1.001dabeb8480bp+0, -0x1.ffee76bce49c7p+0, 0x1.00240982300a1p+3},
                             {-0x1.26980336b3449p+1, -0x1.5a1c8a271ba0cp+2, 0x1.e053f4ea92adfp+2},
                             {0x1.15dd6c94a5059p-4, -0x1.825114d514c1dp+1, -0x1.4cb6096602438p+1},
                             {0x1.14f74a4654912p-1, -0x1.c25a84d556a68p+1, -0x1.32dbff8c2d9ep+1},
                             {0x1.6ed49938a203fp+1, 0x1.d0d70604960e4p-6, 0x1.18ac05a4431b5p+3}}};
    Worst worst;
    measure_all(oracle::Kind::edge_edge, {pair}, 1e-9, worst);
    expect_close(oracle::Kind::edge_edge, "proven later", 1e-9, worst);
    EXPECT_EQ(worst.reported, 1u);
}

/// The farthest that hill climbing came to before the directions of all features were asked: 3.4e-9 s.
TEST(NothingInvented, FoundByHillClimbing)
{
    const oracle::Pair pair{{{-0x1.2c002b9f081e3p+2, -0x1.2c006a5fbb6cap+1, -0x1.2bffe2df9ccc9p+2},
                             {-0x1.1ffffd69ef3cap+4, -0x1.2000128d71795p+3, -0x1.20006c0aafaa8p+4},
                             {0x1.faffff0b86892p+4, 0x1.faffdfb1c512cp+3, 0x1.fac33b0d725efp+4},
                             {-0x1.5b00037fbe42cp+4, -0x1.5b001bc2e7b47p+3, -0x1.5aff9c73b1627p+4},
                             {-0x1.2600000005062p+3, -0x1.26000002d2affp+2, -0x1.26000001204f6p+3},
                             {-0x1.1fffffffc67fep+4, -0x1.1fffffffe807ep+3, -0x1.200000322434dp+4},
                             {0x1.017fffffff70fp+5, 0x1.017ffffd02d8bp+4, 0x1.018000008026ap+5},
                             {-0x1.63000054831f5p+4, -0x1.6300015b72c1cp+3, -0x1.62ffffb7c6b7cp+4}}};
    Worst worst;
    measure_all(oracle::Kind::vertex_face, {pair}, 1e-12, worst);
    expect_close(oracle::Kind::vertex_face, "found by hill climbing", 1e-12, worst);
}

/// Edges of a cloth, nearly parallel when they pass each other: no direction tells them apart at the time at which they meet, as far as
/// certificates tell, but one does where certificates end before it.
TEST(NothingInvented, TellsWhereCertificatesEnd)
{
    const oracle::Pair pair{{{0x1.b62b8d75a947cp-1, 0x1.71cb05e3c80b3p-2, 0x1.c7647d5c1d798p-1},
                             {0x1.77aee63d089b8p-1, 0x1.2166844d2faa4p-1, 0x1.db9c01c915b14p-1},
                             {0x1.a8324024fe8f8p-1, 0x1.a089df78304fep-2, 0x1.cbfeebf1f4af6p-1},
                             {0x1.6aba6c83dc692p-1, 0x1.373110522aa17p-1, 0x1.dfb25bcd4e217p-1},
                             {0x1.bb49220ec79c5p-1, 0x1.6b0d610f17a08p-2, 0x1.c636687404679p-1},
                             {0x1.7ccccb4ce56e3p-1, 0x1.1e083f1d74a90p-1, 0x1.da6d4f5922204p-1},
                             {0x1.ad4a8382d11ddp-1, 0x1.99c69b372f2f0p-2, 0x1.cace9897f8373p-1},
                             {0x1.6fd2b5e720ce4p-1, 0x1.33d00846a0cd0p-1, 0x1.de81f4b9cb3a4p-1}}};
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
        Options options;
        options.tolerance = tolerance;
        EXPECT_EQ(answer(oracle::Kind::edge_edge, interleaved({pair}), options).summary.contacts, 0u) << tolerance;
    }
}

/// Thin, and so close that directions do not tell them apart when they end: eq. 7 does, at that time, or of the parts of the leaf after it.
TEST(NothingInvented, TellsWhereOnlyAreasDo)
{
    const oracle::Pair at_the_end{{{-0x1.214e0d831fde3p-17, -0x1.e5736b3872837p-21, 0x1.24515f3ad7443p-17},
                                   {0, 0, 0},
                                   {-0x1.c66cd6c55ee35p-16, -0x1.7ef07da8a710fp-19, 0x1.cb3a2cf9e668ap-16},
                                   {-0x1.06af975fd32cep-17, -0x1.baba632aea0cfp-21, 0x1.09763cf562321p-17},
                                   {-0x1.20bc190df22dep-17, -0x1.ecc5e000c6ca2p-21, 0x1.23e9c170a7c5ap-17},
                                   {0, 0, 0},
                                   {-0x1.c66cd6c55ee35p-16, -0x1.7ef07da8a710fp-19, 0x1.cb3a2cf9e668ap-16},
                                   {-0x1.06af975fd32cep-17, -0x1.baba632aea0cfp-21, 0x1.09763cf562321p-17}}};
    const oracle::Pair after_it{{{0x1.cc1c81834e22ap-7, -0x1.280e0250d50bdp-5, 0x1.0cd3696a37e1fp-6},
                                 {0x1.cc1d10382ed8p-7, -0x1.280e347c05fbbp-5, 0x1.0cd39856a9856p-6},
                                 {-0x1.66aa4d9da45ap-29, 0x1.f85b9b31f86acp-29, -0x1.d7bbe6ee1d116p-30},
                                 {0x1.dc121ac4a9ec8p-25, -0x1.4eba16e978f06p-24, 0x1.3913526fa815ep-25},
                                 {-0x1.d07bd9aad860cp-6, 0x1.2ade017d22289p-4, -0x1.0f613246744d1p-5},
                                 {-0x1.d07b92506806p-6, 0x1.2adde86789b0ap-4, -0x1.0f611ad03b7b6p-5},
                                 {-0x1.66aa4d9da45ap-29, 0x1.f85b9b31f86acp-29, -0x1.d7bbe6ee1d116p-30},
                                 {0x1.dc121ac4a9ec8p-25, -0x1.4eba16e978f06p-24, 0x1.3913526fa815ep-25}}};
    for (const auto& [kind, pair] : {std::pair{oracle::Kind::vertex_face, at_the_end}, std::pair{oracle::Kind::edge_edge, after_it}}) {
        EXPECT_FALSE(oracle::exact_ccd(kind, pair).contact) << "nothing was tested";
        for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
            Options options;
            options.tolerance = tolerance;
            EXPECT_EQ(answer(kind, interleaved({pair}), options).summary.contacts, 0u) << kind_name(kind) << ' ' << tolerance;
        }
    }
}

/// Directions tell that these are apart for a while, and end where they are 4.5e-8 s apart (flat), or 1.4e-10 s and 2.9e-10 s with an ordinary
/// shape: there certificates hold again.
TEST(NothingInvented, CertificatesLeadOnWhereDirectionsEnd)
{
    const oracle::Pair flat{{{-0x1.f9e8cf87e9b99p-54, -0x1.0b85fcfbdaaa9p-9, -0x1.4dbe5bda817a1p-86},
                             {0x1.1c99e265cbb5cp-52, -0x1.9055c4f6fe5e8p-6, 0x1.0fe80fb350838p-71},
                             {-0x1.aaededd491684p-20, -0x1.1890bde81f0ddp+27, -0x1.ff7975cc8c3ecp-41},
                             {-0x1.978fd087752f5p-54, 0x1.2df9f6d068c8ep-19, 0x1.8313da8244a85p-77},
                             {0x1.b6785978d71d7p-32, 0x1.1d6b98e814051p+20, -0x1.60e1f394700bdp-48},
                             {0x1.386abad143c14p-32, -0x1.365faee0e8ea6p+20, -0x1.7ec9f5a4de4b3p-52},
                             {-0x1.4f281f52c47fbp-20, 0x1.157eb9cc4411p+20, -0x1.dfda3bd0f0771p-41},
                             {0x1.211d3e7694ecep-28, -0x1.2c81bc86ce0bbp+20, 0x1.f57bcf878c538p-55}}};
    const oracle::Pair cluster{{{0x1.2d36aab82b6ep-1, -0x1.de0336f57566p-4, -0x1p-37},
                                {0x1.2d36aab80b6ep-1, -0x1.de0336f47566p-4, -0x1p-37},
                                {0x1.2d36aab82b6ep-1, -0x1.de0336f57566p-4, 0},
                                {0x1.2d36aab81b6ep-1, -0x1.de0336f3f566p-4, 0x1p-37},
                                {0x1.2d36aab82b6ep-1, -0x1.de0336f4f566p-4, 0},
                                {0x1.2d36aab80b6ep-1, -0x1.de0336f57566p-4, -0x1p-37},
                                {0x1.385b321cd26eep-1, -0x1.2627ad2ce06f8p-3, -0x1.7b79ca246e92p-10},
                                {0x1.2d36aab80b6ep-1, -0x1.de0336f57566p-4, -0x1p-37}}};
    const oracle::Pair tiny{{{0x1.ffffffffffffcp-1, 0x1.ffffffffffffep-2, 0x1.0000000000004p+0},
                             {0x1.0000000000004p+0, 0x1p-1, 0x1.0000000000004p+0},
                             {0x1.0000000000001p+0, 0x1.ffffffffffff7p-2, 0x1.ffffffffffffep-1},
                             {0x1.ffffffffffffbp-1, 0x1.0000000000003p-1, 0x1.ffffffffffffcp-1},
                             {0x1.ffffffffffffcp-1, 0x1.0000000000004p-1, 0x1.0000000000004p+0},
                             {0x1.ffffffffffffep-1, 0x1.ffffffffffff9p-2, 0x1.0000000000001p+0},
                             {0x1.ffffd61dc2edep-1, 0x1.ffffa2a4bb505p-2, 0x1.00001778d13ecp+0},
                             {0x1.ffffffffffffcp-1, 0x1.ffffffffffffap-2, 0x1p+0}}};
    for (const auto& [pair, t_max] : {std::pair{flat, 0.1}, std::pair{cluster, 1.0}, std::pair{tiny, 1.0}}) {
        EXPECT_FALSE(oracle::exact_ccd(oracle::Kind::vertex_face, pair, t_max).contact) << "nothing was tested";
        for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
            Options options;
            options.tolerance = tolerance, options.t_max = t_max;
            EXPECT_EQ(answer(oracle::Kind::vertex_face, interleaved({pair}), options).summary.contacts, 0u) << tolerance << ": " << lossless(pair);
        }
    }
}

/// With area, found by hill climbing: farther than random ones.
TEST(NothingInvented, WithArea)
{
    const oracle::Pair pair{{{0x1.d047bd25aeecdp-15, 0x1.1fcf62d64772bp-9, -0x1.d0283d92da29bp-10},
                             {0x1.f6e091ba9ebeep-14, 0x1.26faaf278fb62p-12, 0x1.e95e5fecf1ac7p-14},
                             {0x1.fd42cc7746c8bp-14, 0x1.6d02aa4853ae8p-13, 0x1.d268c5b5a56e1p-13},
                             {0x1.f3298b3ce15aep-14, 0x1.68027ac6fb706p-12, 0x1.d1f2955ec989p-15},
                             {0x1.c953319031ffp-15, 0x1.226b3702abb58p-9, -0x1.d1a5cb992fe02p-10},
                             {0x1.f3665ced91389p-14, 0x1.3bd94a78a1536p-12, 0x1.d1856d2dabf17p-14},
                             {0x1.f9c893db8bf38p-14, 0x1.96bfec445232ap-13, 0x1.c67c53681d668p-13},
                             {0x1.efaf57b6b6207p-14, 0x1.7ce11b330d543p-12, 0x1.a240af86b377p-15}}};
    Worst worst;
    measure_all(oracle::Kind::edge_edge, {pair}, 1e-9, worst);
    expect_close(oracle::Kind::edge_edge, "with area", 1e-9, worst, promised);
    EXPECT_GT(worst.beyond, bound) << "no longer the worst: another is to be looked for";
}

/// The farthest with area that hill climbing has found, in leaves so narrow that rounding decides alone.
TEST(NothingInvented, WithAreaInNarrowLeaves)
{
    const oracle::Pair pair{{{-0x1.b2e8809874ba8p-28, -0x1.2b2e234b06dd3p-7, 0x1.1b20361736dfdp-17},
                             {-0x1.8afb27b5d4c6ap-16, -0x1.ec800deceb1c8p-10, -0x1.0009342944edap-17},
                             {0x1.181ea01cad9d2p-15, -0x1.ec7e7c8c86ffdp-10, 0x1.191b1f0ee187ep-17},
                             {0x1.4a8130c1f636bp-17, -0x1.ec7fd763de159p-10, -0x1.00f0432018d2p-17},
                             {0x1.83cbb5cc06b8dp-36, -0x1.ec7eaec442d6cp-10, -0x1.8f8043fa4f8e8p-20},
                             {-0x1.4311062e84d5fp-23, -0x1.ec7f2286b0c63p-10, -0x1.fe596e315f1b8p-20},
                             {0x1.159af18559256p-15, -0x1.ec8599ba6a276p-10, -0x1.8f8005614a5ep-20},
                             {-0x1.842691502bcc3p-31, -0x1.ec7f39036474bp-10, -0x1.8f7ffe8b81a12p-20}}};
    Worst worst;
    measure_all(oracle::Kind::edge_edge, {pair}, 1e-15, worst);
    expect_close(oracle::Kind::edge_edge, "with area, narrow leaves", 1e-15, worst, promised);
    EXPECT_GT(worst.beyond, 0x1p11 * u) << "no longer the worst: another is to be looked for";
}

/// Leaves without a certificate are searched on below E_tol: what is near within E_tol alone is not reported.
TEST(NothingInvented, VerdictsDoNotDependOnTheTolerance)
{
    std::vector<oracle::Pair> pairs;
    std::size_t contacts = 0, different = 0;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            generate(family, kind, 25, 300, pairs);
            Options fine;
            fine.tolerance = 1e-12;
            const Answer expected = answer(kind, interleaved(pairs), fine);
            contacts += expected.summary.contacts;
            for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
                Options options;
                options.tolerance = tolerance;
                const Answer found = answer(kind, interleaved(pairs), options);
                for (std::size_t i = 0; i < pairs.size(); ++i)
                    if ((found.toi[i] <= 1.0) != (expected.toi[i] <= 1.0)) {
                        ++different;
                        ADD_FAILURE() << family << " E_tol " << tolerance << ": " << lossless(pairs[i]);
                    }
            }
        }
    std::printf("%zu contacts, %zu different verdicts\n", contacts, different);
    EXPECT_GT(contacts, 1000u);
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
        expect_close(set.kind, set.name, 1e-9, worst);
    }
}

}  // namespace
}  // namespace fastccd::testing
