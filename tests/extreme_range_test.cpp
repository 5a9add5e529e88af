// Where double ends: axes with subnormal extents beside ordinary ones, steps so short that the whole motion nearly vanishes, ends of
// the step 2^2000 apart in scale; and, at the other end of what may be asked, tolerances as wide as the step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "amount.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};
constexpr double least = std::numeric_limits<double>::denorm_min();

using Random = std::mt19937_64;

double symmetric(Random& random) { return std::uniform_real_distribution<double>{-1.0, 1.0}(random); }
double whole(Random& random, int most) { return std::uniform_int_distribution<int>{-most, most}(random); }

/// coordinate(end, axis) for every number of every pair.
std::vector<oracle::Pair> make(std::size_t count, const std::function<double(int end, int axis)>& coordinate)
{
    std::vector<oracle::Pair> pairs(count);
    for (oracle::Pair& pair : pairs)
        for (std::size_t point = 0; point < 8; ++point)
            for (std::size_t axis = 0; axis < 3; ++axis) pair[point][axis] = coordinate(point < 4 ? 0 : 1, static_cast<int>(axis));
    return pairs;
}

Options over(double t_max, double tolerance = 1e-9)
{
    Options options;
    options.t_max = t_max;
    options.tolerance = tolerance;
    return options;
}

/// The reference's answer, after asking every instruction set for the same bits.
Answer same_on_all(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, Options options)
{
    options.reference = true;
    const Answer reference = answer(kind, interleaved(pairs), options);
    options.reference = false;
    for (const Isa isa : isas_to_test()) {
        options.isa = isa;
        const Answer found = answer(kind, interleaved(pairs), options);
        const std::size_t i = first_difference(reference, found);
        if (i < pairs.size())
            ADD_FAILURE() << fastccd::name(isa) << ", t_max " << options.t_max << ": " << found.toi[i] << " instead of "
                          << reference.toi[i] << ", " << lossless(pairs[i]);
    }
    return reference;
}

/// Nothing missed, never late. Returns the number of contacts.
std::size_t expect_bounded(oracle::Kind kind, const std::vector<oracle::Pair>& pairs, const Options& options)
{
    const Answer found = same_on_all(kind, pairs, options);
    std::size_t contacts = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const oracle::Verdict truth = oracle::exact_ccd(kind, pairs[i], options.t_max);
        if (!truth.contact) continue;
        ++contacts;
        EXPECT_LE(found.toi[i], truth.t_lo) << kind_name(kind) << ", t_max " << options.t_max << ": " << lossless(pairs[i]);
    }
    return contacts;
}

/// Bounds relative to an extent underflow there, and the interpolated components on the axis do not.
TEST(ExtremeRange, SubnormalAxis)
{
    Random random{401};
    for (const auto kind : kinds) {
        for (const double t_max : {1.0, 0.7, 0.5, 0.3}) {
            const auto thin = [&](int, int axis) { return axis == 0 ? least * whole(random, 4) : whole(random, 8); };
            same_on_all(kind, make(amount(100'000), thin), over(t_max));
            const auto mixed = [&](int, int axis) { return axis == 0 ? least * whole(random, 4) : symmetric(random); };
            EXPECT_GT(expect_bounded(kind, make(5000, mixed), over(t_max)), 25u);
        }
    }
}

/// The whole motion of such a step is about t_max times smaller than the positions at its end.
TEST(ExtremeRange, ShortStepFromOnePlace)
{
    Random random{402};
    for (const auto kind : kinds)
        for (const int exponent : {-160, -260, -264, -300, -537, -700, -1000}) {
            const double t_max = std::ldexp(1.0, exponent);
            for (const double size : {1.0, 0x1p-70}) {
                const auto near = [&](int end, int) { return end == 0 ? 2 * t_max * size * symmetric(random) : size * symmetric(random); };
                const std::size_t contacts = expect_bounded(kind, make(600, near), over(t_max));
                if (exponent >= -700) {
                    EXPECT_GT(contacts, 4u) << exponent;
                }
            }
        }
}

/// A vertex that drops on a face from `lowest` to 1.2 in units of t_max, at speed 1.
std::vector<oracle::Pair> drops(Random& random, double t_max, std::size_t count, double lowest = 0.0)
{
    std::vector<oracle::Pair> pairs(count);
    for (oracle::Pair& pair : pairs) {
        const double height = std::uniform_real_distribution<double>{lowest, 1.2}(random);
        pair = {{{0.2, 0.2, height * t_max}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
        for (std::size_t point = 0; point < 4; ++point) pair[4 + point] = pair[point];
        pair[4][2] -= 1.0;
    }
    return pairs;
}

/// In steps whose times are subnormal a product with t_max is rounded to a multiple of the least double.
TEST(ExtremeRange, SubnormalTimes)
{
    Random random{403};
    for (const double t_max : {1e-300, 1e-307, 1e-309, 1e-315, 1e-320, 3e-323})
        for (const double tolerance : {1e-9, least})
            EXPECT_GT(expect_bounded(oracle::Kind::vertex_face, drops(random, t_max, 1500), over(t_max, tolerance)), 500u) << t_max;
}

/// Times that differ within the step are then often the same double, and the first of all is the pair that comes first.
TEST(ExtremeRange, EarliestOfEqualSubnormalTimes)
{
    Random random{406};
    for (const double t_max : {1e-309, 1e-321, 3e-323}) {
        const auto pairs = drops(random, t_max, 20'000, 0.3);
        Options options = over(t_max);
        const Answer dense = answer_without_roots(oracle::Kind::vertex_face, interleaved(pairs), options);
        const auto first = std::min_element(dense.toi.begin(), dense.toi.end());
        for (const Isa isa : isas_to_test()) {
            options.isa = isa;
            Contact earliest{};
            ASSERT_TRUE(earliest_contact(PairKind::vertex_face, interleaved(pairs), options, earliest).ok());
            EXPECT_EQ(earliest.toi, *first) << t_max;
            EXPECT_EQ(earliest.pair, static_cast<std::size_t>(first - dense.toi.begin())) << t_max << ' ' << fastccd::name(isa);
        }
    }
}

/// Halving what could overflow at one end of the step must not take the last bits of the other.
TEST(ExtremeRange, HugeAtOneEndSubnormalAtTheOther)
{
    Random random{404};
    for (const auto kind : kinds)
        for (const double huge : {0x1p1021, 0x1.8p1022, std::numeric_limits<double>::max()})
            for (const int huge_end : {0, 1}) {
                const auto thin = [&](int end, int axis) {
                    return axis > 0 ? whole(random, 8) : end == huge_end ? huge : least * whole(random, 20);
                };
                EXPECT_GT(expect_bounded(kind, make(1500, thin), over(1.0)), 100u) << huge;
            }
}

TEST(ExtremeRange, SubnormalMinimumSeparation)
{
    for (const double huge : {0.0, 1e300, 0x1.8p1022}) {
        // A vertex 20 from a point-like face at first and 9 at last, in multiples of the least double, which d is 10 of.
        oracle::Pair pair{};
        for (std::size_t point = 0; point < 4; ++point) pair[point][0] = huge;
        for (std::size_t point = 1; point < 4; ++point) {
            pair[point][1] = 20 * least;
            pair[4 + point][0] = 9 * least;
        }
        Options options;
        options.minimum_separation = 10 * least;
        const double toi = answer(oracle::Kind::vertex_face, interleaved({pair}), options).toi[0];
        EXPECT_GT(toi, 0.0) << huge;
        EXPECT_LE(toi, 1.0) << huge;
    }
}

/// The tolerance is about times: roots within one interval of its width are still told apart.
TEST(ExtremeRange, RootsOfCoarseAnswers)
{
    Random random{405};
    for (const auto kind : kinds) {
        const std::vector<oracle::Pair> pairs = make(amount(20'000), [&](int, int) { return symmetric(random); });
        std::vector<oracle::Verdict> truth;
        for (const oracle::Pair& pair : pairs) truth.push_back(oracle::exact_ccd(kind, pair));
        for (const double tolerance : {1.0, 0.3, 0.1, 1e-3}) {
            const Answer found = same_on_all(kind, pairs, over(1.0, tolerance));
            std::size_t counted = 0;
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if (truth[i].contact_class != oracle::Class::regular || truth[i].at_start || truth[i].at_end) continue;
                ++counted;
                EXPECT_EQ(found.roots[i], truth[i].roots) << tolerance << ": " << lossless(pairs[i]);
            }
            EXPECT_GT(counted, amount(1000));
        }
    }
}

}  // namespace
}  // namespace fastccd::testing
