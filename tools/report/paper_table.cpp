#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/task_arena.h>

#include <fastccd/isa.hpp>

#include "../common_options.hpp"
#include "../large_array.hpp"
#include "../narrow_phase_run.hpp"
#include "../pair_slice.hpp"
#include "../random_pairs.hpp"
#include "parts.hpp"

namespace fastccd::tools::report {
namespace {

/// The paper's Table 1: 10 million random vertex-face pairs, one core of an Intel Core i5 at 3.2 GHz.
constexpr std::size_t paper_pairs = 10'000'000;
constexpr std::array<double, 8> paper_seconds{7.85, 7.9, 8.396, 8.6, 9, 9.4, 9.8, 10};
constexpr std::array<std::size_t, 8> paper_odd{750127, 750005, 749987, 749985, 749985, 749985, 749985, 749985};
constexpr std::array<std::size_t, 8> paper_even{22790, 22779, 22779, 22779, 22779, 22779, 22779, 22779};

/// How many standard deviations the count lies from the paper's: both are drawn from the same, binomial distribution, the
/// probability of which is estimated from the paper.
double deviations(std::size_t count, std::size_t pairs, std::size_t paper_count)
{
    const double p = static_cast<double>(paper_count) / static_cast<double>(paper_pairs), n = static_cast<double>(pairs);
    const double variance = p * (1 - p) * n * (1 + n / static_cast<double>(paper_pairs));
    return (static_cast<double>(count) - p * n) / std::sqrt(variance);
}

/// One row: the sums over all pieces, in every repeat and on one and on all threads.
struct PaperRow {
    Summary summary;
    std::vector<std::array<double, 2>> seconds;
};

std::array<PaperRow, tolerances.size()> answer_all(const Plan& plan, PairKind kind, ReportProgress& progress)
{
    const std::size_t repeats = std::min<std::size_t>(plan.repeats(), 3);
    const int all_threads = tbb::this_task_arena::max_concurrency();
    std::array<PaperRow, tolerances.size()> rows;
    for (PaperRow& row : rows) row.seconds.resize(repeats);

    PairBuffer buffer{std::min(chunk_pairs, plan.pairs)};
    LargeArray<double> toi{buffer.size()};
    std::vector<std::uint8_t> roots(buffer.size());
    // Piece by piece, so that all rows see the same moods of the machine, and memory does not limit the number of pairs.
    for (std::size_t first = 0; first < plan.pairs; first += buffer.size()) {
        const std::size_t size = std::min(buffer.size(), plan.pairs - first);
        fill_random_pairs(seed, first, buffer);
        const PairView pairs = slice(buffer.view(), 0, size);
        for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
            for (std::size_t t = 0; t < tolerances.size(); ++t) {
                Options options;
                options.tolerance = tolerances[t];
                Summary summary;
                const auto answer = [&] {
                    throw_unless_ok(time_of_impact(kind, pairs, options, toi.span().first(size), &summary,
                                                   std::span{roots}.first(size)));
                };
                rows[t].seconds[repeat][0] += processor_seconds(answer);
                rows[t].seconds[repeat][1] += seconds_on(all_threads, answer);
                if (repeat > 0) continue;
                rows[t].summary.add(summary, first);
            }
            progress.move((kind == PairKind::edge_edge ? plan.pairs : 0) + first + size * (repeat + 1) / repeats,
                          2 * plan.pairs);
        }
    }
    return rows;
}

Json row_json(const Plan& plan, PairKind kind, std::size_t t, const PaperRow& row)
{
    Timing one{Timing::Clock::processor}, all;
    for (const auto& seconds : row.seconds) {
        one.add(seconds[0]);
        all.add(seconds[1]);
    }
    Json json{{"tolerance", tolerances[t]},
              {"contacts", row.summary.contacts},
              {"odd", row.summary.odd},
              {"even", row.summary.even},
              {"uncounted", row.summary.contacts - row.summary.odd - row.summary.even},
              {"certified_search", row.summary.scalar_pairs},
              {"one_thread", one.json(plan.pairs)},
              {"all_threads", all.json(plan.pairs)}};
    if (kind == PairKind::vertex_face) {
        json["paper"] = {{"seconds", paper_seconds[t]}, {"odd", paper_odd[t]}, {"even", paper_even[t]}};
        json["deviations"] = {{"odd", deviations(row.summary.odd, plan.pairs, paper_odd[t])},
                              {"even", deviations(row.summary.even, plan.pairs, paper_even[t])}};
    }
    return json;
}

}  // namespace

Json paper_table(const Plan& plan, ReportProgress& progress)
{
    Json json{{"pairs", plan.pairs},
              {"seed", seed},
              {"isa", name(resolve_isa({}))},
              {"threads", tbb::this_task_arena::max_concurrency()},
              {"paper",
               {{"pairs", paper_pairs},
                {"exactCCD_odd", 749'985},
                {"exactCCD_seconds", 37.4},
                {"safeCCD_contacts", 918'663},
                {"safeCCD_seconds", 13.6}}}};
    for (const PairKind kind : kinds) {
        const auto rows = answer_all(plan, kind, progress);
        for (std::size_t t = 0; t < rows.size(); ++t) json[short_name(kind)].push_back(row_json(plan, kind, t, rows[t]));
    }
    return json;
}

}  // namespace fastccd::tools::report
