// What a run found, for people and for programs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include "narrow_phase_run.hpp"

namespace fastccd::tools {

/// Lines of text, aligned, newline at the end.
[[nodiscard]] std::string text_report(const PairOptions& options, const Question& question, const Totals& totals);

/// One JSON object on one line, newline at the end. Numbers are finite; what was not asked for (odd,
/// even and uncounted without --parity) or does not exist (earliest without contacts) is null.
[[nodiscard]] std::string json_report(const PairOptions& options, const Question& question, const Totals& totals);

/// Prints the report that `options` ask for on standard output, or on standard error if --hits
/// takes that. Throws as write_all.
void print_report(const PairOptions& options, const Question& question, const Totals& totals);

/// 1234567 as "1,234,567".
[[nodiscard]] std::string with_commas(std::size_t number);

/// "1 contact", "1,234 contacts"; of what has another plural, that too.
[[nodiscard]] std::string counted(std::size_t number, std::string_view thing, std::string_view plural = {});

/// Pairs a second; 0 if no time was measured.
[[nodiscard]] double rate(std::size_t pairs, double seconds);

/// The text of a line "asked": times, `of_what` they are, tolerance and how to search.
[[nodiscard]] std::string what_was_asked(const Options& options, std::string_view of_what = {});

/// The text of a line "narrow phase".
[[nodiscard]] std::string narrow_phase_speed(std::size_t pairs, double seconds, Isa isa, int threads);

/// What all JSON reports say of how pairs were answered.
void add_asked(nlohmann::ordered_json& json, const Options& options, Isa isa, int threads);

/// A line of a report: what it is about, and what there is to say, of which names of files may hold anything.
void append_line(fmt::memory_buffer& report, std::string_view label, std::string_view text);

}  // namespace fastccd::tools
