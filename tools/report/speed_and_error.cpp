#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fastccd/isa.hpp>
#if defined(FASTCCD_HAVE_PEERS)
#include <peers/peers.hpp>
#endif

#include "../large_array.hpp"
#include "../narrow_phase_run.hpp"
#include "../pair_slice.hpp"
#include "../random_pairs.hpp"
#include "parts.hpp"
#include "truth.hpp"

namespace fastccd::tools::report {
namespace {

/// One instruction set at one E_tol.
struct Point {
    Isa isa;
    double tolerance;
    Timing timing{Timing::Clock::processor};
    Json comparison;
};

Json json(const Point& point, std::size_t pairs)
{
    Json json{{"isa", name(point.isa)}, {"tolerance", point.tolerance}, {"timing", point.timing.json(pairs)}};
    json.update(point.comparison);
    return json;
}

#if defined(FASTCCD_HAVE_PEERS)

/// A peer on the pairs that have exact truth.
Json peer_json(const peers::NamedPeer& named, const PairBuffer& pairs, const Truth& truth, std::size_t repeats,
               ReportProgress& progress, std::size_t done, std::size_t total)
{
    constexpr std::size_t batch = 128;  // so that its own structures, up to 2 KB a pair, stay in cache
    const std::size_t size = truth.contact.size();
    std::vector<double> coordinates(size * pair_coordinates), toi(size);
    for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] = pairs.at(i / pair_coordinates, i % pair_coordinates);

    const std::unique_ptr<peers::Peer> peer = named.make();
    Timing timing{Timing::Clock::processor};
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
        double seconds = 0;
        for (std::size_t first = 0; first < size; first += batch) {
            const std::size_t count = std::min(batch, size - first);
            peer->prepare(&coordinates[first * pair_coordinates], count);
            seconds += processor_seconds([&] { peer->run(&toi[first]); });
            if (first % (64 * batch) == 0) progress.move(done, total);
        }
        timing.add(seconds);
    }
    Json json{{"name", named.name}, {"timing", timing.json(size)}};
    json.update(compare(truth, toi));
    return json;
}

Json peers_json(PairKind kind, const PairBuffer& pairs, const Truth& truth, std::size_t repeats, ReportProgress& progress,
                std::size_t done, std::size_t total)
{
    Json all = Json::array();
    for (const auto& list : {peers::fcl_peers(), peers::bullet_peers()}) {
        for (const peers::NamedPeer& peer : list) {
            if (peer.kind == kind) all.push_back(peer_json(peer, pairs, truth, repeats, progress, done, total));
        }
    }
    return all;
}

#else

Json peers_json(PairKind, const PairBuffer&, const Truth&, std::size_t, ReportProgress&, std::size_t, std::size_t)
{
    return Json::array();
}

#endif

Json kind_json(const Plan& plan, PairKind kind, ReportProgress& progress)
{
    // Of each kind: exact truth a third, timing a half, peers the rest.
    constexpr std::size_t units = 12'000;
    const std::size_t begin = kind == PairKind::vertex_face ? 0 : units;
    PairBuffer buffer{plan.speed_pairs()};
    fill_random_pairs(seed, 0, buffer);
    const Truth truth = exact_truth(kind, buffer.view(), plan.truth_pairs(), [&](std::size_t done) {
        progress.move(begin + units / 3 * done / plan.truth_pairs(), 2 * units);
    });

    std::vector<Point> points;
    for (const Isa isa : available()) {
        for (const double tolerance : tolerances) points.push_back({.isa = isa, .tolerance = tolerance, .comparison = {}});
    }
    LargeArray<double> toi{buffer.size()};
    const auto answer = [&](const Point& point) {
        Options options;
        options.isa = point.isa;
        options.tolerance = point.tolerance;
        return processor_seconds([&] { throw_unless_ok(time_of_impact(kind, buffer.view(), options, toi.span())); });
    };
    // Rounds over all points, so that all see the same moods of the machine. The first one warms up and gives the answers.
    for (std::size_t round = 0; round <= plan.repeats(); ++round) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double seconds = answer(points[i]);
            if (round == 0) {
                points[i].comparison = compare(truth, toi.span().first(plan.truth_pairs()));
            } else {
                points[i].timing.add(seconds);
            }
            const std::size_t step = round * points.size() + i, steps = (plan.repeats() + 1) * points.size();
            progress.move(begin + units / 3 + units / 2 * step / steps, 2 * units);
        }
    }

    Json result{{"points", Json::array()}};
    for (const Point& point : points) result["points"].push_back(json(point, buffer.size()));
    result["peers"] = peers_json(kind, buffer, truth, plan.repeats(), progress, begin + units / 6 * 5, 2 * units);
    return result;
}

}  // namespace

Json speed_and_error(const Plan& plan, ReportProgress& progress)
{
    Json json{{"timed_pairs", plan.speed_pairs()}, {"truth_pairs", plan.truth_pairs()}, {"seed", seed}, {"threads", 1}};
    for (const PairKind kind : kinds) json[short_name(kind)] = kind_json(plan, kind, progress);
    return json;
}

}  // namespace fastccd::tools::report
