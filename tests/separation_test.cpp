// Minimum separation, promise by promise, against exact distances.
//
// Never missed, never late: farther than d before toi, or throughout if the pair is not reported. Nothing invented: at toi
// the exact distance is at most
//
//     (1 + distance_tolerance) d + 2^8 u s,   u = 2^-53,   at the start d + 2^8 u s,
//
// s the sum of the extents: per axis the largest |component| of x_i - x_0. Where it comes from: a pair is reported at a time
// at which its computed distance is at most (1 + distance_tolerance) d + 128 u s (SeparationParameters::resolution), and that
// errs by at most 75 u s (SeparationBounds::distance). Or because no direction proves what is left of the distance: SeparationBounds::beyond()
// tells how far it is then. And at the cap on looks the time reached is the answer, a lower bound as always: CapOnLooks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <separation_search.hpp>

#include "amount.hpp"
#include "followed_pairs.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "oracle/exact_distance.hpp"
#include "oracle/exact_separation.hpp"
#include "test_data.hpp"
#include "thin_pairs.hpp"

namespace fastccd::testing {
namespace {

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};
constexpr double u = 0x1p-53;

double size_of(const oracle::Pair& pair) { return oracle::sum_of_extents(pair).get_d(); }

struct Found {
    double toi;
    bool proven, at_start;
};

Found search(oracle::Kind kind, const oracle::Pair& pair, const Options& options)
{
    std::vector<Contact> contacts;
    Summary summary;
    const Status status =
        find_contacts(pair_kind(kind), PairView::interleaved(pair[0].data(), 1), options, contacts, nullptr, &summary);
    if (!status.ok()) throw std::runtime_error(message(status.error));
    EXPECT_EQ(summary.at_start, contacts.empty() ? 0u : static_cast<std::size_t>(contacts[0].at_start));
    if (contacts.empty()) return {std::numeric_limits<double>::infinity(), false, false};
    return {contacts[0].toi, contacts[0].proven, contacts[0].at_start};
}

std::string in_short(double number)
{
    char text[32];
    std::snprintf(text, sizeof text, "%g", number);
    return text;
}

struct Counts {
    std::size_t pairs = 0, reported = 0, proven = 0, at_start = 0, not_shown = 0;
    double worst = 0;

    void report(const char* what) const
    {
        std::printf("%-34s %zu pairs, %zu reported, %zu proven, %zu at the start, beyond d at most %.3g u s; not shown %zu\n",
                    what, pairs, reported, proven, at_start, worst / u, not_shown);
    }
};

constexpr int most_intervals = 5000;  // for the check that nothing is late

void check(oracle::Kind kind, const oracle::Pair& pair, const Options& options, Counts& counts, int intervals = most_intervals)
{
    const mpq_class size = oracle::sum_of_extents(pair);
    const double d = options.minimum_separation;
    const Found found = search(kind, pair, options);
    const auto what = [&] { return std::string(kind_name(kind)) + " d " + in_short(d) + ": " + lossless(pair); };
    ++counts.pairs;
    const bool reported = std::isfinite(found.toi);
    EXPECT_EQ(found.at_start, found.toi == 0.0) << what();
    if (!found.at_start) {
        const double until = reported ? found.toi : options.t_max;
        const oracle::Farther farther = oracle::farther_throughout(kind, pair, d, 0.0, until, 200, intervals);
        EXPECT_NE(farther, oracle::Farther::closer) << (reported ? "late: " : "missed: ") << what();
        counts.not_shown += farther == oracle::Farther::not_shown;
    }
    if (!reported) return;
    ++counts.reported;
    counts.proven += found.proven;
    counts.at_start += found.at_start;
    EXPECT_LE(found.toi, options.t_max);
    if (found.proven) {
        EXPECT_NE(oracle::farther_throughout(kind, pair, d, found.toi, options.t_max), oracle::Farther::certainly) << "not proven: " << what();
    }
    if (sgn(size) == 0) return;
    mpq_class allowed = d;
    if (!found.at_start) allowed *= 1 + mpq_class(options.distance_tolerance);
    counts.worst = std::max(counts.worst, oracle::excess_of_distance(kind, pair, found.toi, allowed, size));
}

constexpr double bound = SeparationBounds::beyond();
static_assert(bound == 0x1p8 * u);

void expect_close(const std::string& what, const Counts& counts)
{
    counts.report(what.c_str());
    EXPECT_LE(counts.worst, bound) << what;
    EXPECT_EQ(counts.not_shown, 0u) << what << ": the check gave up";
}

Options options_for(double d, double t_max = 1.0, double distance_tolerance = 1e-6)
{
    Options options;
    options.minimum_separation = d;
    options.t_max = t_max;
    options.distance_tolerance = distance_tolerance;
    return options;
}

/// Of all families, relative to the size of each pair.
void check_families(double relative, double t_max, double distance_tolerance, std::size_t per_family, std::uint64_t seed)
{
    Counts counts;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, seed, per_family, pairs);
            for (const oracle::Pair& pair : pairs) {
                const double d = relative * size_of(pair);
                if (d > 0.0 && std::isfinite(d)) check(kind, pair, options_for(d, t_max, distance_tolerance), counts);
            }
        }
    const std::string what = "d " + in_short(relative) + " s, t_max " + in_short(t_max) + ", within " + in_short(distance_tolerance);
    expect_close(what, counts);
    EXPECT_GT(counts.reported, t_max < 0.1 ? amount(100) : counts.pairs / 3) << what;
}

TEST(Separation, MadePairs)
{
    for (const double relative : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0}) check_families(relative, 1.0, 1e-6, amount(40), 111);
}

TEST(Separation, ShorterSteps)
{
    for (const double t_max : {0.7, 1.0 - 0x1p-53, 1e-3})
        for (const double relative : {1e-9, 1e-3}) check_families(relative, t_max, 1e-6, amount(10), 112);
}

TEST(Separation, DistanceTolerances)
{
    for (const double distance_tolerance : {0.0, 1e-12, 1e-2, 1.0})
        for (const double relative : {1e-9, 1e-2}) check_families(relative, 1.0, distance_tolerance, amount(10), 113);
}

/// d far below and far above the motion, up to the ends of double.
TEST(Separation, ExtremeDistances)
{
    for (const double d : {0x1p-1074, 1e-300, 1e-30, 1e30, 1e300, std::numeric_limits<double>::max()}) {
        Counts counts;
        for (const auto kind : kinds)
            for (const std::string& family : families()) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 114, amount(10), pairs);
                for (const oracle::Pair& pair : pairs)
                    check(kind, pair, options_for(d), counts);
            }
        expect_close("d " + in_short(d), counts);
    }
}

/// Coordinates whose differences overflow, and others that vanish beside them.
TEST(Separation, ExtremeCoordinates)
{
    Counts counts;
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> pairs;
        generate("uniform", kind, 115, 40, pairs);
        for (const oracle::Pair& pair : pairs)
            for (const double scale : {1e-320, 1e-300, 1e-200, 1e200, 8e307})
                for (const bool flat : {false, true}) {
                    oracle::Pair scaled = pair;
                    for (auto& point : scaled)
                        for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = (axis == 2 && flat ? 1e-10 : 2.0) * (point[axis] - 0.5) * scale;
                    for (const double relative : {1e-6, 0.1})
                        if (const double d = relative * scale; d > 0.0) check(kind, scaled, options_for(d), counts);
                }
    }
    expect_close("extreme coordinates", counts);
}

TEST(Separation, ThinPairs)
{
    for (const double relative : {1e-12, 1e-6, 1e-3}) {
        Counts counts;
        for (const auto kind : kinds)
            for (const oracle::Pair& pair : testing::ThinPairs{kind, 116}.next(amount(1500))) check(kind, pair, options_for(relative * size_of(pair)), counts);
        expect_close("thin pairs, d " + in_short(relative) + " s", counts);
    }
}

/// Faces and edges along one line but for offsets whose squares vanish: their normal is no unit vector, another vector is.
TEST(Separation, NormalsThatVanish)
{
    std::mt19937_64 bits{121};
    std::uniform_real_distribution<double> uniform{-1.0, 1.0};
    Counts counts;
    for (const double offset : {1e-30, 1e-60, 1e-100, 1e-150, 1e-200})
        for (const auto kind : kinds)
            for (std::size_t n = 0; n < amount(150); ++n) {
                oracle::Pair pair;
                double line[2][3];
                for (std::size_t point = 0; point < 8; ++point) {
                    const std::size_t first = kind == oracle::Kind::vertex_face ? 1 : 2, primitive = point % 4 < first ? 0 : 1;
                    if (point == 0)
                        for (auto& direction : line)
                            for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = axis == 1 ? 0.0 : uniform(bits);
                    if (kind == oracle::Kind::edge_edge) std::copy(line[1], line[1] + 3, line[0]);
                    const double along = uniform(bits);
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        pair[point][axis] = along * line[primitive][axis] + (axis == 1 ? offset * uniform(bits) : axis == 2 && primitive == 0 ? (point < 4 ? 1.5 : -0.5) : 0.0);
                }
                check(kind, pair, options_for(0.01), counts);
            }
    expect_close("normals that vanish", counts);
    EXPECT_GT(counts.reported, counts.pairs / 4);
    EXPECT_LT(counts.at_start, counts.reported);
}

/// The vertex meets a face so small that the weights of its corners add up to 2^-1024 and less, the reciprocal of which is infinite.
TEST(Separation, FacesAsSmallAsTheRootOfWhatVanishes)
{
    Counts counts;
    for (int exponent = -250; exponent >= -270; --exponent) {
        const double h = std::scalbn(1.0, exponent);
        const oracle::Pair pair{{{0, 0, 0}, {2, h, 0}, {2, -h, h}, {2, -h, -h}, {0, 0, 0}, {0, h, 0}, {0, -h, h}, {0, -h, -h}}};
        check(oracle::Kind::vertex_face, pair, options_for(0.5), counts);
    }
    expect_close("tiny faces", counts);
    EXPECT_EQ(counts.proven, counts.pairs);
}

/// The nearest corner belongs to a side 10^6 times as long as it is far away.
TEST(Separation, CornersOfLongSides)
{
    const oracle::Pair pair{{{0, -76170516.75, 16}, {0, 0, 0}, {0, -134217728, 0}, {0, 0, 0},
                             {0, .25, 0}, {0, -76170516.75, 0}, {0, 0, 0}, {0, 0, -67108864}}};
    Counts counts;
    for (const double d : {1e-3, 0.94, 10.0}) check(oracle::Kind::vertex_face, pair, options_for(d), counts);
    expect_close("corners of long sides", counts);
}

/// Edges nearly parallel at the start, the worst that hill climbing led to before the directions of all features were asked: 2e-8 of its size from d.
TEST(Separation, WorstAngle)
{
    const oracle::Pair pair{{{0x1.1e50000000c39p+2, -0x1.92e206179009fp+1, 0x1.7d783f62d944p+23},
                             {0x1.b860000005374p+1, -0x1.3799149e33ad1p+1, 0x1.1e195de4ac8bap+23},
                             {-0x1.ddd83e4e0f295p-29, -0x1.2dffffffddc8bp-2, 0x1.9801af9306424p-2},
                             {0x1.117dd9b0e2f8ap+3, -0x1.7fff954cc3e75p+2, 0x1.7d783fade82acp+24},
                             {0x1.1b55ac79a35ddp+2, 0x0p+0, 0x1.7d783f62d944p+23},
                             {-0x1.5ef4acfdc9393p-49, -0x1.4f243c2d53c57p-51, 0x1.1e195de4ac8bap+23},
                             {0x1.90800000000f8p+0, -0x1.df06d60f54bcbp-26, 0x0p+0},
                             {0x1.072be7133dc14p+0, -0x1.3abf862ce14a4p-26, 0x1.7d783fade82acp+24}}};
    Counts counts;
    check(oracle::Kind::edge_edge, pair, options_for(0x1.846fadef9931dp-13), counts);
    expect_close("worst angle", counts);
}

/// (1 + distance_tolerance) d may be beyond the largest double, and the pair's distance, too.
TEST(Separation, DistancesAtTheEndOfDouble)
{
    Counts counts;
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> pairs;
        generate("uniform", kind, 122, amount(200), pairs);
        for (oracle::Pair& pair : pairs) {
            for (auto& point : pair)
                for (double& x : point) x = (2.0 * x - 1.0) * 0.9 * std::numeric_limits<double>::max();
            for (const double d : {1e307, 1e308}) check(kind, pair, options_for(d, 1.0, 0.9), counts);
        }
    }
    expect_close("distances at the end of double", counts);
    EXPECT_GT(counts.reported, counts.at_start + amount(100));
}

/// As d goes to 0, every contact stays, and no later than at distance 0.
TEST(Separation, KeepsEveryContactOfDistanceZero)
{
    std::size_t contacts = 0;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 117, amount(100), pairs);
            for (const double d : {0x1p-1074, 1e-12, 1e-3}) {
                const Answer found = answer(kind, interleaved(pairs), options_for(d));
                for (std::size_t i = 0; i < pairs.size(); ++i) {
                    const oracle::Verdict truth = oracle::exact_ccd(kind, pairs[i]);
                    if (!truth.contact) continue;
                    ++contacts;
                    EXPECT_LE(found.toi[i], truth.t_lo) << family << ' ' << d << ' ' << lossless(pairs[i]);
                }
            }
        }
    EXPECT_GT(contacts, amount(10000));
}

TEST(Separation, KeepsEveryContactOfPublicData)
{
    const auto data = data_directory();
    if (!data) GTEST_SKIP() << no_data_message;
    std::size_t contacts = 0;
    for (const QuerySet& set : load_hardcases(*data))
        for (const double d : {1e-300, 1e-9, 1e-3}) {
            const Answer found = answer(set.kind, interleaved(set.pairs), options_for(d));
            for (std::size_t i = 0; i < set.pairs.size(); ++i) {
                if (set.truth[i] == 0) continue;
                ++contacts;
                EXPECT_LE(found.toi[i], set.t_lo[i]) << set.name << ' ' << d << ' ' << lossless(set.pairs[i]);
            }
        }
    for (const QuerySet& set : load_queries(*data)) {
        const Answer found = answer(set.kind, interleaved(set.pairs), options_for(1e-12));
        for (std::size_t i = 0; i < set.pairs.size(); ++i) {
            contacts += set.truth[i] == 1;
            EXPECT_TRUE(set.truth[i] == 0 || found.toi[i] <= 1.0) << set.name << ' ' << lossless(set.pairs[i]);
        }
    }
    std::printf("%zu contacts kept\n", contacts);
    EXPECT_GT(contacts, 300000u);
}

unsigned looks_at(oracle::Kind kind, const oracle::Pair& pair, double d, double distance_tolerance = 1e-6)
{
    const SearchParameters parameters{1e-9, 1.0, false, SeparationParameters{d, distance_tolerance}};
    return scalar::separation_search(pair_kind(kind), pair[0].data(), parameters).intervals;
}

/// Larger distances are reached no later, but for the tolerance, and with far fewer looks than the cap.
TEST(Separation, BoundedLooks)
{
    for (const double relative : {1e-12, 1e-9, 1e-6, 1e-3, 0.1}) {
        unsigned most = 0;
        std::size_t pairs_in_all = 0, looks = 0, followed = 0;
        for (const auto kind : kinds)
            for (const std::string& family : families()) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 118, amount(200), pairs);
                for (const oracle::Pair& pair : pairs) {
                    const double d = relative * size_of(pair);
                    if (!(d > 0.0) || std::isinf(d)) continue;
                    const unsigned count = looks_at(kind, pair, d);
                    most = std::max(most, count);
                    ++pairs_in_all;
                    looks += count;
                    followed += count > 64;
                }
            }
        std::printf("d %g s: %.1f looks a pair, at most %u; more than 64 for %zu of %zu pairs\n", relative,
                    static_cast<double>(looks) / static_cast<double>(pairs_in_all), most, followed, pairs_in_all);
        EXPECT_LE(most, 512u);  // hill climbing from random pairs came to 296
    }
}

/// The first look, one at the guess, and the one for the proof: where the planes close, as for most contacts, little more is needed.
TEST(Separation, GuessesAreGoodForMostContacts)
{
    for (const auto kind : kinds) {
        std::vector<oracle::Pair> pairs;
        generate("uniform", kind, 119, 4000, pairs);
        for (const double relative : {1e-6, 1e-3}) {
            std::size_t contacts = 0, looks = 0, few = 0;
            for (const oracle::Pair& pair : pairs) {
                const double d = relative * size_of(pair), toi = search(kind, pair, options_for(d)).toi;
                if (!(toi > 0.0 && toi <= 1.0)) continue;
                const unsigned count = looks_at(kind, pair, d);
                ++contacts;
                looks += count;
                few += count <= 4;
            }
            std::printf("d %g s: %zu contacts, %.2f looks each, at most 4 for %zu\n", relative, contacts,
                        static_cast<double>(looks) / static_cast<double>(contacts), few);
            EXPECT_GT(contacts, 200u);
            EXPECT_LT(looks, 6 * contacts);  // without guesses more than eight each
            EXPECT_GT(2 * few, contacts);
        }
    }
}

TEST(Separation, FollowedPairs)
{
    for (const auto& [kind, distance, pair] : followed_pairs) {
        const unsigned looks = looks_at(kind, pair, distance);
        std::printf("d %.2g s: %u looks\n", distance / size_of(pair), looks);
        EXPECT_LE(looks, 150u);
        EXPECT_EQ(search(kind, pair, options_for(distance)).toi, std::numeric_limits<double>::infinity());
        EXPECT_EQ(oracle::farther_throughout(kind, pair, distance, 0.0, 1.0, 200, 10 * most_intervals), oracle::Farther::certainly);
    }
}

/// A line that moves with both its points along straight lines has a parabola for its envelope. This one is (x, 1 - x^2/2), which
/// has the curvature of the unit circle at its top: tangents at x are at some 1 + x^4/8 from the axis of the circle, longer near 1 while
/// they turn than those of a parabola of another curvature. Without a tolerance such a pair comes to the cap on looks, and the time reached is the
/// answer: not late, and beyond d by 1e-12 d.
TEST(Separation, CapOnLooks)
{
    const auto corner = [](double x, double side) { return std::array<double, 3>{0.5 * (x + side), 1.0 - 0.5 * x * side, 0.125}; };
    const oracle::Pair pair{{{0, 0, -1}, {0, 0, 1}, corner(-1, -4), corner(-1, 4), {0, 0, -1}, {0, 0, 1}, corner(1, -4), corner(1, 4)}};
    const oracle::Kind kind = oracle::Kind::edge_edge;
    const double d = 1.0 - 1e-12;
    for (const double distance_tolerance : {1e-6, 1e-9, 0.0}) {
        const unsigned looks = looks_at(kind, pair, d, distance_tolerance);
        Counts counts;
        check(kind, pair, options_for(d, 1.0, distance_tolerance), counts, 10 * most_intervals);
        std::printf("distance_tolerance %g: %u looks\n", distance_tolerance, looks);
        counts.report("the cap on looks");
        EXPECT_EQ(counts.reported, 1u);
        EXPECT_EQ(counts.not_shown, 0u);
        if (distance_tolerance > 0.0) {
            EXPECT_LE(looks, distance_tolerance < 1e-7 ? 2048u : 256u);
            EXPECT_LE(counts.worst, bound);
        } else {
            EXPECT_GE(looks, 4096u);
            EXPECT_LE(looks, 4098u);
            EXPECT_LE(counts.worst, 1e-12);
        }
    }
}

}  // namespace
}  // namespace fastccd::testing
