// What the steps of the search with a minimum separation keep, step by step (kernels/separation_steps.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <contact_guess.hpp>
#include <separation_steps.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

using namespace FASTCCD_KERNEL_NAMESPACE;

struct Walk {
    std::size_t steps = 0, guesses = 0, wrong_guesses = 0, wrong_from_half = 0;
};

template <PairKind kind>
void walk(const oracle::Pair& pair, const SearchParameters& parameters, Walk& totals)
{
    SeparationRecord<double> record{};
    record.r = relative_motion<double>(pair[0].data(), 1, 1.0);
    const FartherBounds bounds = SeparationBounds{parameters.bounds.rho}.certificates(parameters.separation);
    const ApartOnHalves<double> farther = farther_on_halves<kind>(record.r, bounds, record.extents);
    if (!in_separation_range(record.r, record.extents).value || (farther.first & farther.second).value) return;
    if (first_look<kind>(record, farther, parameters).value) return;
    const double start = record.time;
    if (farther.first.value) {
        ASSERT_GE(start, 0.5) << lossless(pair);
    }
    guess_contact<kind>(record, parameters);
    const bool guessed = record.purpose == looking_ahead;
    totals.guesses += guessed;
    while (record.looks < most_lane_looks) {
        const double before = record.time, looks = record.looks;
        const StepOutcome<double> outcome = step<kind>(record, next_look<kind>(record, parameters), parameters, 1.0);
        ++totals.steps;
        ASSERT_GE(record.time, before) << "of what is proven nothing is asked again: " << lossless(pair);
        ASSERT_GE(record.at, record.time) << lossless(pair);
        ASSERT_EQ(record.looks, looks + 1.0);
        if (guessed && looks == 1.0 && record.time == start) {
            ++totals.wrong_guesses;
            totals.wrong_from_half += start >= 0.5;
            ASSERT_EQ(record.at, start) << "after a guess that was too far, the look at the start: " << lossless(pair);
        }
        if (outcome.farther.value || outcome.contact.value || outcome.left.value) return;
    }
}

TEST(SeparationSteps, TimesOnlyAdvance)
{
    Walk totals;
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 121, 200, pairs);
            for (const oracle::Pair& pair : pairs)
                for (const double relative : {1e-9, 1e-3, 0.05}) {
                    double size = 0.0;
                    for (const auto& point : pair)
                        for (std::size_t axis = 0; axis < 3; ++axis) size = std::max(size, std::fabs(point[axis] - pair[0][axis]));
                    if (!(size > 0.0) || std::isinf(size)) continue;
                    const SearchParameters parameters{1e-9, 1.0, false, SeparationParameters{relative * size, 1e-6}};
                    if (kind == oracle::Kind::vertex_face)
                        walk<PairKind::vertex_face>(pair, parameters, totals);
                    else
                        walk<PairKind::edge_edge>(pair, parameters, totals);
                    if (HasFatalFailure()) return;
                }
        }
    std::printf("%zu steps; %zu guesses, %zu of them too far, %zu in the second half\n", totals.steps, totals.guesses, totals.wrong_guesses,
                totals.wrong_from_half);
    EXPECT_GT(totals.guesses, 5000u);
    EXPECT_GT(totals.wrong_guesses, 500u);
    EXPECT_LT(8 * totals.wrong_guesses, totals.guesses);  // a third, where planes are close already, or where guesses leave no room for rounding
    EXPECT_GT(totals.wrong_from_half, 50u);
}

}  // namespace
}  // namespace fastccd::testing
