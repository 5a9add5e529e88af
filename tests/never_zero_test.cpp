// Never zero by rounding: a pair that is apart at t = 0 by more than rounding hides gets toi > 0, whatever E_tol.
//
// More than rounding hides: the rounding part of the bound in nothing_invented_test.cpp, a quarter of it for what is made here. E_tol is no part of it: a contact within the first leaf, however wide, has a
// positive lower bound.
#include <gtest/gtest.h>

#include <cmath>

#include "amount.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "oracle/exact_distance.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};
constexpr double bound = 0x1p10 * 0x1p-53;

/// Exact distance at t = 0 over the norm of the extents; 0 if the extents are no ordinary numbers.
double relative_distance_at_start(oracle::Kind kind, const oracle::Pair& pair)
{
    double size = 0;
    for (std::size_t i = 1; i < 4; ++i)
        for (std::size_t end : {0u, 4u})
            for (std::size_t k = 0; k < 3; ++k) size = std::max(size, std::fabs(pair[i + end][k] - pair[end][k]));
    if (!(size > 1e-100 && size < 1e100)) return 0;
    return std::sqrt(oracle::squared_distance(kind, pair, 0.0).get_d()) / (std::sqrt(3.0) * size);
}

struct Seen {
    std::size_t apart = 0;        ///< Pairs certifiably apart at the start.
    std::size_t in_first_leaf = 0;  ///< Of these, contacts within the first leaf: where 0 would be a valid lower bound.
};

void expect_never_zero(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const std::string& name, Seen& seen)
{
    std::vector<double> distance;
    for (const oracle::Pair& pair : pairs) distance.push_back(relative_distance_at_start(kind, pair));
    for (const double tolerance : {1.0, 0.1, 1e-4, 1e-9, 1e-12})
        for (const Isa isa : isas_to_test()) {
            Options options;
            options.tolerance = tolerance;
            options.isa = isa;
            const Answer found = answer(kind, interleaved(pairs), options);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (!(distance[i] > bound)) continue;
                ++seen.apart;
                seen.in_first_leaf += found.toi[i] < tolerance;
                ASSERT_GT(found.toi[i], 0.0) << name << " E_tol " << tolerance << ' ' << fastccd::name(isa) << ", apart by "
                                             << distance[i] << " s: " << lossless(pairs[i]);
            }
        }
}

TEST(NeverZero, MadePairs)
{
    Seen seen;
    std::vector<oracle::Pair> pairs;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            generate(family, kind, 91, 100, pairs);
            expect_never_zero(kind, pairs, family, seen);
        }
    std::printf("%zu answers for pairs apart at t = 0, %zu of them in contact within the first leaf\n", seen.apart, seen.in_first_leaf);
    EXPECT_GT(seen.in_first_leaf, 1000u);
}

TEST(NeverZero, ThinPairs)
{
    Seen seen;
    for (const auto kind : kinds) expect_never_zero(kind, ThinPairs{kind, 92}.next(2000), "thin pairs", seen);
    EXPECT_GT(seen.apart, 1000u);
}

/// Contact after 2^-1 .. 2^-46 of the step: a vertex, or edge, at that height above the other primitive, both in general
/// position, or in that of a family. The lower bound is to be positive and near the exact time, in relative terms.
TEST(NeverZero, ContactsSoonAfterTheStart)
{
    std::size_t near_zero = 0;
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> start, some, pairs;
        generate("uniform", kind, 93, 4000, start);
        for (const std::string& family : families()) {
            generate(family, kind, 94, amount(100), some);
            start.insert(start.end(), some.begin(), some.end());
        }
        // A pair in contact at a time t, made to start at t - t 2^-k.
        for (std::size_t i = 0; i < start.size(); ++i) {
            const oracle::Verdict verdict = oracle::exact_ccd(kind, start[i]);
            if (verdict.contact_class != oracle::Class::regular || verdict.t_lo < 0.01) continue;
            const double from = verdict.t_lo * (1 - std::ldexp(1.0, -static_cast<int>(1 + i % 46)));
            oracle::Pair pair = start[i];
            for (std::size_t p = 0; p < 4; ++p)
                for (std::size_t k = 0; k < 3; ++k) pair[p][k] = (1 - from) * pair[p][k] + from * pair[p + 4][k];
            pairs.push_back(pair);
        }
        ASSERT_GT(pairs.size(), 100u);
        for (const double tolerance : {1.0, 1e-9}) {
            Options options;
            options.tolerance = tolerance;
            const Answer found = answer(kind, interleaved(pairs), options);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (relative_distance_at_start(kind, pairs[i]) <= bound) continue;
                const oracle::Verdict verdict = oracle::exact_ccd(kind, pairs[i]);
                EXPECT_GT(found.toi[i], 0.0) << lossless(pairs[i]);
                EXPECT_LE(found.toi[i], verdict.t_lo) << lossless(pairs[i]);
                near_zero += verdict.contact && verdict.t_lo < tolerance;
            }
        }
    }
    EXPECT_GT(near_zero, 200u) << "hardly any contact within the first leaf: nothing was tested";
}

}  // namespace
}  // namespace fastccd::testing
