#include "truth.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <oracle/exact_ccd.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "../pair_slice.hpp"

namespace fastccd::tools::report {
namespace {

oracle::Pair oracle_pair(const PairView& pairs, std::size_t i)
{
    oracle::Pair pair;
    for (std::size_t c = 0; c < pair_coordinates; ++c) pair[c / 3][c % 3] = coordinate(pairs, i, c);
    return pair;
}

/// The value that a share of all is not above.
double percentile(const std::vector<double>& sorted, double share)
{
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// toi minus exact time: negative is early. Exact but for less than one unit in the last place.
double signed_error(double toi, double t_lo, double t_hi) { return toi > t_lo ? toi - t_hi : toi - t_lo; }

}  // namespace

oracle::Kind oracle_kind(PairKind kind) noexcept
{
    return kind == PairKind::vertex_face ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
}

PairKind pair_kind(oracle::Kind kind) noexcept
{
    return kind == oracle::Kind::vertex_face ? PairKind::vertex_face : PairKind::edge_edge;
}

Truth exact_truth(PairKind kind, const PairView& pairs, std::size_t count, const std::function<void(std::size_t)>& done)
{
    constexpr std::size_t piece = 2048;  // tens of microseconds each: Ctrl-C does not wait for more than some of them
    Truth truth{std::vector<char>(count), std::vector<double>(count), std::vector<double>(count)};
    for (std::size_t first = 0; first < count; first += piece) {
        done(first);
        const tbb::blocked_range<std::size_t> range{first, std::min(first + piece, count), 16};
        tbb::parallel_for(range, [&](const auto& part) {
            for (std::size_t i = part.begin(); i != part.end(); ++i) {
                const oracle::Verdict verdict = oracle::exact_ccd(oracle_kind(kind), oracle_pair(pairs, i));
                truth.contact[i] = verdict.contact ? 1 : 0;
                truth.t_lo[i] = verdict.t_lo;
                truth.t_hi[i] = verdict.t_hi;
            }
        });
    }
    done(count);
    return truth;
}

Json compare(const Truth& truth, std::span<const double> toi)
{
    std::size_t contacts = 0, reported = 0;
    std::vector<std::size_t> missed, late, false_alarms;
    std::vector<double> errors;
    for (std::size_t i = 0; i < truth.contact.size(); ++i) {
        const bool found = !std::isinf(toi[i]);
        const bool contact = truth.contact[i] != 0;
        contacts += contact;
        reported += found;
        if (contact && !found) missed.push_back(i);
        if (!contact && found) false_alarms.push_back(i);
        if (!contact || !found || truth.t_lo.empty() || std::isnan(toi[i])) continue;
        if (toi[i] > truth.t_hi[i]) late.push_back(i);
        errors.push_back(signed_error(toi[i], truth.t_lo[i], truth.t_hi[i]));
    }

    Json json{
        {"pairs", truth.contact.size()},     {"contacts", contacts},          {"reported", reported},
        {"missed", missed.size()},           {"late", late.size()},           {"false_alarms", false_alarms.size()},
        {"missed_pairs", std::move(missed)}, {"late_pairs", std::move(late)}, {"false_alarm_pairs", std::move(false_alarms)},
        {"signed_error", nullptr},           {"absolute_error", nullptr}};
    if (errors.empty()) return json;
    std::ranges::sort(errors);
    json["signed_error"] = {{"earliest", errors.front()},
                            {"p1", percentile(errors, 0.01)},
                            {"median", percentile(errors, 0.5)},
                            {"p99", percentile(errors, 0.99)},
                            {"latest", errors.back()}};
    std::ranges::for_each(errors, [](double& error) { error = std::abs(error); });
    std::ranges::sort(errors);
    json["absolute_error"] = {{"median", percentile(errors, 0.5)}, {"p99", percentile(errors, 0.99)}, {"worst", errors.back()}};
    return json;
}

}  // namespace fastccd::tools::report
