#include "narrow_phase_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <CLI/Error.hpp>
#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <fastccd/isa.hpp>

#include "hits_file.hpp"
#include "instruction_sets.hpp"
#include "interrupt.hpp"
#include "mapped_file.hpp"
#include "pair_slice.hpp"
#include "progress.hpp"
#include "threads.hpp"

namespace fastccd::tools {

void throw_unless_ok(const Status& status)
{
    if (status.ok()) return;
    if (status.error == Error::bad_isa_environment) {
        const char* const named = std::getenv("FASTCCD_ISA");
        const std::string isa = named == nullptr ? "" : named;
        throw CLI::ValidationError(fmt::format("{}: '{}'; available here: {}", message(status.error), isa, available_isas()),
                                   CLI::ExitCodes::ValidationError);
    }
    if (status.error == Error::exact_unavailable) throw CLI::ValidationError("--exact", message(status.error));
    throw std::logic_error(message(status.error));
}

Isa resolve_isa(const Options& options)
{
    std::vector<Contact> none;
    Summary summary;
    const Status status = find_contacts(PairKind::vertex_face, PairView{}, options, none, nullptr, &summary);
    throw_unless_ok(status);
    return summary.isa;
}

NarrowPhaseRun::NarrowPhaseRun(const PairOptions& options, HitsFile* hits, Progress* progress)
    : options_{options}, hits_{hits}, progress_{progress}, piece_size_{tbb::this_task_arena::max_concurrency()}
{
    totals_.summary.isa = resolve_isa(options.narrow_phase);
    totals_.threads = tbb::this_task_arena::max_concurrency();
}

void NarrowPhaseRun::answer(const PairView& pairs, std::size_t first_pair, std::span<const std::int8_t> truth)
{
    for (std::size_t begin = 0; begin < pairs.size();) {
        const std::size_t count = std::min(piece_size_.pairs(), pairs.size() - begin);
        const double before = totals_.seconds;
        answer_piece(slice(pairs, begin, begin + count), first_pair + begin,
                     truth.empty() ? truth : truth.subspan(begin, count));
        piece_size_.took(count, totals_.seconds - before);
        begin += count;
    }
}

void NarrowPhaseRun::answer_piece(const PairView& pairs, std::size_t first_pair, std::span<const std::int8_t> truth)
{
    check_interrupt();
    contacts_.clear();
    invalid_.clear();
    Summary part;
    if (options_.parity) {
        find_with_roots(pairs, part);
    } else {
        find(pairs, part);
    }
    check_mapped_files();
    totals_.summary.add(part, first_pair);
    for (const std::size_t i : invalid_) {
        if (totals_.first_invalid.size() == most_invalid_named) break;
        totals_.first_invalid.push_back(first_pair + i);
    }
    // The known answers are about touching, in the whole step.
    if (!truth.empty() && options_.narrow_phase.t_max == 1.0 && options_.narrow_phase.minimum_separation == 0.0) compare(truth);
    if (hits_ != nullptr) hits_->append(contacts_, invalid_, first_pair);
    if (progress_ != nullptr) progress_->advance(pairs.size());
}

void NarrowPhaseRun::find(const PairView& pairs, Summary& summary)
{
    const auto start = std::chrono::steady_clock::now();
    const Status status =
        find_contacts(options_.kind, pairs, options_.narrow_phase, contacts_, &invalid_, &summary);
    totals_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    throw_unless_ok(status);
}

void NarrowPhaseRun::find_with_roots(const PairView& pairs, Summary& summary)
{
    toi_.resize(pairs.size());
    roots_.resize(pairs.size());
    const auto start = std::chrono::steady_clock::now();
    const Status status = time_of_impact(options_.kind, pairs, options_.narrow_phase, toi_, &summary, roots_);
    totals_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    throw_unless_ok(status);
    for (std::size_t i = 0; i < toi_.size(); ++i) {
        if (std::isfinite(toi_[i])) contacts_.push_back({.pair = i, .toi = toi_[i]});
        if (std::isnan(toi_[i])) invalid_.push_back(i);
    }
}

void NarrowPhaseRun::compare(std::span<const std::int8_t> truth)
{
    if (!totals_.truth) totals_.truth.emplace();
    TruthTotals& totals = *totals_.truth;
    totals.pairs += truth.size();
    const auto true_contacts = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 1));
    const auto found = static_cast<std::size_t>(
        std::count_if(contacts_.begin(), contacts_.end(), [&](const Contact& c) { return truth[c.pair] == 1; }));
    totals.missed += true_contacts - found;
    totals.false_alarms += contacts_.size() - found;
}

Totals run_narrow_phase(const PairOptions& options, const Question& question,
                        const std::function<void(NarrowPhaseRun&)>& feed)
{
    Totals totals;
    on_threads(options.threads, [&] {
        std::optional<HitsFile> hits;
        if (!options.hits.empty()) hits.emplace(options.hits, options.proof);
        // Rows on a terminal are progress enough, and would run into the bar.
        const bool rows_on_terminal = OutputFile::is_standard_output(options.hits) && ::isatty(STDOUT_FILENO) != 0;
        Progress progress{question.pairs, !options.quiet && !rows_on_terminal};
        NarrowPhaseRun run{options, hits ? &*hits : nullptr, &progress};
        feed(run);
        check_interrupt();
        if (hits) hits->commit();
        totals = run.totals();
    });
    return totals;
}

}  // namespace fastccd::tools
