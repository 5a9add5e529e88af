// Minimum separation, promise by promise, against exact distances.
//
// Never missed, never late: farther than d before toi, or throughout if the pair is not reported. Nothing invented: at toi
// the exact distance is at most
//
//     (1 + distance_tolerance) d + 2^8 u s + 2^8 sqrt(u) s,   u = 2^-53,
//
// s the sum of the extents: the largest |component| per axis of x_i - x_0. The root belongs to faces and edges that are nearly
// degenerate at that moment, as without a separation (nothing_invented_test.cpp): no vector computed for them proves what
// is left of the distance. All other pairs keep the bound without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <separation_search.hpp>

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

/// Sum of the extents; +infinity if that is no double.
double size_of(const oracle::Pair& pair)
{
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double extent = 0.0;
        for (std::size_t i = 0; i < 8; ++i) extent = std::max(extent, std::fabs(pair[i][axis] - pair[i / 4 * 4][axis]));
        sum += extent;
    }
    return sum;
}

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

/// distance - (1 + tolerance) d, in units of s; exact but for the last division.
double excess(oracle::Kind kind, const oracle::Pair& pair, double time, const Options& options, double size)
{
    const mpq_class square = oracle::squared_distance(kind, pair, time);
    const mpq_class allowed = mpq_class(options.minimum_separation) * (1 + mpq_class(options.distance_tolerance));
    if (square <= allowed * allowed) return 0.0;
    // In units of s first: squares of large coordinates have no double.
    const mpq_class relative = square / (mpq_class(size) * mpq_class(size)), threshold = allowed / mpq_class(size);
    const mpf_class root = sqrt(mpf_class(relative, 512)) - mpf_class(threshold, 512);
    return root.get_d();
}

struct Counts {
    std::size_t pairs = 0, reported = 0, proven = 0, at_start = 0, not_shown = 0, thin = 0;
    double worst = 0, worst_thin = 0;

    void report(const char* what) const
    {
        std::printf("%-34s %zu pairs, %zu reported, %zu proven, %zu at the start, beyond d at most %.3g u s; thin %zu: %.3g sqrt(u) s; not shown %zu\n",
                    what, pairs, reported, proven, at_start, worst / u, thin, worst_thin / std::sqrt(u), not_shown);
    }
};

void check(oracle::Kind kind, const oracle::Pair& pair, const Options& options, Counts& counts)
{
    const double size = size_of(pair), d = options.minimum_separation;
    const Found found = search(kind, pair, options);
    const auto what = [&] { return std::string(kind_name(kind)) + " d " + std::to_string(d / size) + " s: " + lossless(pair); };
    ++counts.pairs;
    const bool reported = std::isfinite(found.toi);
    EXPECT_EQ(found.at_start, found.toi == 0.0) << what();
    if (!found.at_start) {
        const double until = reported ? found.toi : options.t_max;
        const oracle::Farther farther = oracle::farther_throughout(kind, pair, d, 0.0, until);
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
    if (size == 0.0) return;
    const double beyond = excess(kind, pair, found.toi, options, size);
    if (beyond > 0x1p8 * u) {
        ++counts.thin;
        counts.worst_thin = std::max(counts.worst_thin, beyond);
    } else {
        counts.worst = std::max(counts.worst, beyond);
    }
}

bool well_shaped(const std::string& family)
{
    for (const char* clear : {"uniform", "scale", "big_offset", "common_velocity", "near_interior", "simcloth"})
        if (family == clear || family == std::string("f32_") + clear) return true;
    return false;
}

TEST(Separation, MadePairs)
{
    for (const double relative : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0}) {
        Counts well, hard;
        for (const auto kind : kinds)
            for (const std::string& family : families()) {
                std::vector<oracle::Pair> pairs;
                generate(family, kind, 111, 25, pairs);
                for (const oracle::Pair& pair : pairs) {
                    Options options;
                    options.minimum_separation = relative * size_of(pair);
                    if (!(options.minimum_separation > 0.0) || std::isinf(options.minimum_separation)) continue;
                    check(kind, pair, options, well_shaped(family) ? well : hard);
                }
            }
        well.report(("ordinary families, d " + std::to_string(relative)).c_str());
        hard.report(("hard families, d " + std::to_string(relative)).c_str());
    }
}

}  // namespace
}  // namespace fastccd::testing
