#include "report_totals.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <fastccd/isa.hpp>

#include "output_file.hpp"
#include "shown_text.hpp"

namespace fastccd::tools {
namespace {

/// Percentage with as many digits as tell it from 0 and 100.
std::string share(std::size_t part, std::size_t whole)
{
    return whole == 0 ? "" : fmt::format("  ({:.3g} %)", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

/// Its number; of several files also which, and its number there.
std::string pair_name(const Question& question, std::size_t pair)
{
    if (question.first_pairs.size() < 2) return std::to_string(pair);
    const auto after = std::upper_bound(question.first_pairs.begin(), question.first_pairs.end(), pair);
    const auto file = static_cast<std::size_t>(after - question.first_pairs.begin()) - 1;
    return fmt::format("{} ({} of {})", pair, pair - question.first_pairs[file], question.files[file]);
}

std::string invalid_pairs(const Question& question, const Totals& totals)
{
    const std::size_t more = totals.summary.invalid - totals.first_invalid.size();
    std::string text = fmt::format("NaN or infinity in pair{} ", totals.summary.invalid == 1 ? "" : "s");
    for (std::size_t i = 0; i < totals.first_invalid.size(); ++i)
        text += (i == 0 ? "" : ", ") + pair_name(question, totals.first_invalid[i]);
    if (more > 0) text += fmt::format(" and {} more, which --hits lists", with_commas(more));
    return text;
}

}  // namespace

std::string with_commas(std::size_t number)
{
    std::string text = fmt::format("{}", number);
    for (std::size_t i = text.size(); i > 3;) {
        i -= 3;
        text.insert(i, 1, ',');
    }
    return text;
}

std::string counted(std::size_t number, std::string_view thing, std::string_view plural)
{
    if (number == 1) return fmt::format("1 {}", thing);
    return plural.empty() ? fmt::format("{} {}s", with_commas(number), thing) : fmt::format("{} {}", with_commas(number), plural);
}

double rate(std::size_t pairs, double seconds)
{
    return seconds > 0 ? static_cast<double>(pairs) / seconds : 0.0;
}

std::string what_was_asked(const Options& options, std::string_view of_what)
{
    std::string text = fmt::format("t in [0, {}]{}, tolerance {}", options.t_max, of_what, options.tolerance);
    if (options.reference) text += ", certified search on every pair";
    if (options.exact) text += ", exact verdict";
    if (options.minimum_separation > 0.0)
        text += fmt::format(", minimum separation {} (+ {} of it)", options.minimum_separation, options.distance_tolerance);
    return text;
}

std::string narrow_phase_speed(std::size_t pairs, double seconds, Isa isa, int threads)
{
    return fmt::format("{:.3g} s, {:.3g} million pairs/s ({}, {})", seconds, rate(pairs, seconds) * 1e-6, name(isa),
                       counted(static_cast<std::size_t>(threads), "thread"));
}

void add_asked(nlohmann::ordered_json& json, const Options& options, Isa isa, int threads)
{
    json["isa"] = name(isa);
    json["threads"] = threads;
    json["tolerance"] = options.tolerance;
    json["t_max"] = options.t_max;
    json["reference"] = options.reference;
    json["exact"] = options.exact;
    json["minimum_separation"] = options.minimum_separation;
    json["distance_tolerance"] = options.distance_tolerance;
}

void append_line(fmt::memory_buffer& report, std::string_view label, std::string_view text)
{
    fmt::format_to(std::back_inserter(report), "{:<17}{}\n", label, on_one_line(text));
}

std::string text_report(const PairOptions& options, const Question& question, const Totals& totals)
{
    const Summary& sum = totals.summary;
    fmt::memory_buffer out;
    const auto line = [&out](std::string_view label, std::string_view text) { append_line(out, label, text); };

    line(kind_name(options.kind), question.source);
    line("asked", what_was_asked(options.narrow_phase));
    line("pairs", with_commas(sum.pairs));
    line("contacts", with_commas(sum.contacts) + share(sum.contacts, sum.pairs));
    line("  proven", with_commas(sum.proven));
    line("  possible", with_commas(sum.contacts - sum.proven));
    if (options.narrow_phase.minimum_separation > 0.0) line("  at the start", with_commas(sum.at_start));
    if (options.parity) {
        line("  odd", with_commas(sum.odd));
        line("  even", with_commas(sum.even));
        line("  uncounted", with_commas(sum.contacts - sum.odd - sum.even));
    }
    if (sum.contacts > 0) {
        line("earliest", fmt::format("toi {:.17g} in pair {}", sum.earliest.toi, pair_name(question, sum.earliest.pair)));
    }
    if (totals.truth) {
        line("missed", fmt::format("{} of {} with a known answer{}", with_commas(totals.truth->missed),
                                   counted(totals.truth->pairs, "pair"), totals.truth->missed > 0 ? "; is --kind right?" : ""));
        line("false alarms", with_commas(totals.truth->false_alarms));
    }
    line("invalid", sum.invalid == 0 ? "0" : fmt::format("{}  ({})", with_commas(sum.invalid), invalid_pairs(question, totals)));
    line("certified search", counted(sum.scalar_pairs, "pair") + share(sum.scalar_pairs, sum.pairs));
    line("narrow phase", narrow_phase_speed(sum.pairs, totals.seconds, sum.isa, totals.threads));
    return fmt::to_string(out);
}

std::string json_report(const PairOptions& options, const Question& question, const Totals& totals)
{
    using Json = nlohmann::ordered_json;
    const Summary& sum = totals.summary;
    Json json;
    json["kind"] = short_name(options.kind);
    if (!question.files.empty()) json["files"] = question.files;
    if (question.range) json["range"] = {question.range->begin, question.range->end};
    if (question.seed) json["seed"] = *question.seed;
    json["pairs"] = sum.pairs;
    json["contacts"] = sum.contacts;
    json["proven"] = sum.proven;
    json["possible"] = sum.contacts - sum.proven;
    json["at_start"] = sum.at_start;
    json["odd"] = options.parity ? Json(sum.odd) : Json(nullptr);
    json["even"] = options.parity ? Json(sum.even) : Json(nullptr);
    json["uncounted"] = options.parity ? Json(sum.contacts - sum.odd - sum.even) : Json(nullptr);
    json["invalid"] = sum.invalid;
    json["invalid_pairs"] = totals.first_invalid;
    json["earliest"] = sum.contacts > 0 ? Json{{"toi", sum.earliest.toi}, {"pair", sum.earliest.pair}} : Json(nullptr);
    if (totals.truth) {
        json["truth_pairs"] = totals.truth->pairs;
        json["missed"] = totals.truth->missed;
        json["false_alarms"] = totals.truth->false_alarms;
    }
    json["seconds"] = totals.seconds;
    json["pairs_per_second"] = rate(sum.pairs, totals.seconds);
    add_asked(json, options.narrow_phase, sum.isa, totals.threads);
    json["scalar_pairs"] = sum.scalar_pairs;
    // File names need not be UTF-8, JSON has to be.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_report(const PairOptions& options, const Question& question, const Totals& totals)
{
    const bool to_error = OutputFile::is_standard_output(options.hits);
    const int descriptor = to_error ? STDERR_FILENO : STDOUT_FILENO;
    const char* const stream = to_error ? "standard error" : "standard output";
    const bool text = !options.json && !options.quiet;
    if (options.json) write_all(descriptor, json_report(options, question, totals), stream);
    if (text) write_all(descriptor, text_report(options, question, totals), stream);
    // Not where JSON is, which says so, too, and is to be one object.
    if (!text && totals.summary.invalid > 0 && !(options.json && to_error)) {
        write_all(STDERR_FILENO, fmt::format("fastccd: warning: {}\n", on_one_line(invalid_pairs(question, totals))), "standard error");
    }
}

}  // namespace fastccd::tools
