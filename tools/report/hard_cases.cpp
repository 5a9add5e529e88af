#include <algorithm>
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <generators.hpp>
#include <test_data.hpp>

#include <fastccd/isa.hpp>

// Not of the public interface: it alone tells how many intervals the search for a pair has examined.
#include <certified_search.hpp>

#include "../common_options.hpp"
#include "../interrupt.hpp"
#include "../narrow_phase_run.hpp"
#include "../pair_slice.hpp"
#include "parts.hpp"
#include "truth.hpp"

namespace fastccd::tools::report {
namespace {

constexpr double tolerance = 1e-9;

struct HardSet {
    std::string name;
    const char* source;
    PairKind kind;
    std::vector<oracle::Pair> pairs;
    Truth truth;

    [[nodiscard]] PairView view() const
    {
        return PairView::interleaved(pairs.empty() ? nullptr : pairs[0][0].data(), pairs.size());
    }
};

HardSet made(const std::string& family, PairKind kind, std::size_t pairs)
{
    HardSet set{family + "_" + short_name(kind), "generated", kind, {}, {}};
    testing::generate(family, oracle_kind(kind), seed, pairs, set.pairs);
    set.truth = exact_truth(kind, set.view(), pairs, [](std::size_t) {});
    return set;
}

/// With the published answers, of the first so many pairs.
HardSet read(testing::QuerySet&& data, std::size_t pairs)
{
    for (auto* const list : {&data.t_lo, &data.t_hi}) list->resize(std::min(list->size(), pairs));
    data.pairs.resize(std::min(data.pairs.size(), pairs));
    data.truth.resize(data.pairs.size());
    HardSet set{data.name, "data", pair_kind(data.kind), std::move(data.pairs), {}};
    set.truth = {std::vector<char>(data.truth.begin(), data.truth.end()), std::move(data.t_lo), std::move(data.t_hi)};
    return set;
}

std::vector<testing::QuerySet> public_sets(const std::filesystem::path& data)
{
    std::vector<testing::QuerySet> sets;
    if (std::filesystem::is_directory(data / "hardcases")) sets = testing::load_hardcases(data);
    if (std::filesystem::is_directory(data / "queries")) std::ranges::move(testing::load_queries(data), std::back_inserter(sets));
    return sets;
}

/// What is wrong without and with the exact verdict, and what it costs on one thread.
Json answer(const HardSet& set, bool exact, std::size_t repeats)
{
    Options options;
    options.tolerance = tolerance;
    options.exact = exact;
    std::vector<double> toi(set.pairs.size());
    Summary totals;
    Timing timing{Timing::Clock::processor};
    // In one call; but the exact verdict takes long, and Ctrl-C should not wait for all of it.
    const std::size_t size = toi.size(), piece = exact ? std::min<std::size_t>(size, 256) : size;
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
        double seconds = 0;
        totals = {};
        for (std::size_t first = 0; first < size; first += piece) {
            check_interrupt();
            const std::size_t end = std::min(first + piece, size);
            Summary summary;
            seconds += processor_seconds([&] {
                throw_unless_ok(time_of_impact(set.kind, slice(set.view(), first, end), options,
                                               std::span{toi}.subspan(first, end - first), &summary));
            });
            totals.add(summary, first);
        }
        timing.add(seconds);
    }
    Json json = compare(set.truth, toi);
    json["proven"] = totals.proven;
    json["certified_search"] = totals.scalar_pairs;
    json["timing"] = timing.json(set.pairs.size());
    return json;
}

Json intervals(const HardSet& set)
{
    const SearchParameters parameters{tolerance, 1.0, false};
    std::size_t sum = 0;
    unsigned most = 0;
    for (const oracle::Pair& pair : set.pairs) {
        const unsigned used = scalar::certified_search(set.kind, pair[0].data(), parameters).intervals;
        sum += used;
        most = std::max(most, used);
    }
    return {{"mean", set.pairs.empty() ? 0.0 : static_cast<double>(sum) / static_cast<double>(set.pairs.size())},
            {"most", most}};
}

bool exact_available()
{
    Options options;
    options.exact = true;
    return time_of_impact(PairKind::vertex_face, PairView{}, options, {}).ok();
}

Json json(const HardSet& set, std::size_t repeats)
{
    const std::size_t exact_repeats = repeats < 5 ? 1 : 3;  // a hundred times slower, and steadier

    return {{"name", set.name},
            {"source", set.source},
            {"kind", short_name(set.kind)},
            {"pairs", set.pairs.size()},
            {"plain", answer(set, false, repeats)},
            {"exact", exact_available() ? answer(set, true, exact_repeats) : Json(nullptr)},
            {"intervals", intervals(set)}};
}

}  // namespace

void check_hard_cases(const std::filesystem::path& data) { static_cast<void>(public_sets(data)); }

Json hard_cases(const Plan& plan, ReportProgress& progress)
{
    const std::vector<std::string>& families = testing::families();
    std::vector<testing::QuerySet> data;
    if (plan.data) data = public_sets(*plan.data);
    const std::size_t total = kinds.size() * families.size() + data.size();
    std::size_t done = 0;
    Json result{{"tolerance", tolerance},
                {"seed", seed},
                {"threads", 1},
                {"isa", name(resolve_isa({}))},
                {"most_intervals", scalar::most_intervals},
                {"sets", Json::array()}};
    for (const std::string& family : families) {
        for (const PairKind kind : kinds) {
            progress.move(done++, total);
            result["sets"].push_back(json(made(family, kind, plan.hard_pairs()), plan.repeats()));
        }
    }
    for (testing::QuerySet& set : data) {
        progress.move(done++, total);
        result["sets"].push_back(json(read(std::move(set), plan.hard_pairs()), plan.repeats()));
    }
    return result;
}

}  // namespace fastccd::tools::report
