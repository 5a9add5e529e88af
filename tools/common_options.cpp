#include "common_options.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fastccd/isa.hpp>

#include "instruction_sets.hpp"
#include "output_file.hpp"

namespace fastccd::tools {
namespace {

/// A check of a number that also refuses NaN, which passes every comparison CLI11 makes.
CLI::Validator number_check(std::string requirement, std::function<bool(double)> accept)
{
    return {[requirement = std::move(requirement), accept = std::move(accept)](const std::string& text) -> std::string {
                double value = 0;
                if (CLI::detail::lexical_cast(text, value) && accept(value)) return {};
                return fmt::format("'{}' is not {}", text, requirement);
            },
            std::string{}};
}

PairKind parse_kind(const std::string& text)
{
    if (text == "vf") return PairKind::vertex_face;
    if (text == "ee") return PairKind::edge_edge;
    throw CLI::ValidationError("--kind", fmt::format("'{}' is neither vf (vertex-face) nor ee (edge-edge)", text));
}

Isa parse_isa(const std::string& text)
{
    const std::optional<Isa> isa = isa_from_name(text);
    if (!isa) {
        throw CLI::ValidationError("--isa", fmt::format("there is no instruction set '{}'; available here: {}", text,
                                                        available_isas()));
    }
    if (*isa != Isa::automatic && !isa_available(*isa)) {
        throw CLI::ValidationError(
            "--isa", fmt::format("{} is not {}; available here: {}", text,
                                 isa_built(*isa) ? "supported by this machine" : "part of this build", available_isas()));
    }
    return *isa;
}

std::size_t parse_bound(std::string_view bound, std::size_t if_absent, const std::string& range)
{
    if (bound.empty()) return if_absent;
    std::size_t value = 0;
    const char* const end = bound.data() + bound.size();
    const auto [stop, error] = std::from_chars(bound.data(), end, value);
    if (error != std::errc{} || stop != end) {
        throw CLI::ValidationError("--range", fmt::format("'{}' is not A:B with pair numbers A and B", range));
    }
    return value;
}

}  // namespace

CLI::Option* add_whole_number(CLI::App& command, const std::string& option, std::uint64_t& value, std::uint64_t least,
                              std::uint64_t most, const std::string& description)
{
    const auto parse = [option, &value, least, most](const std::string& text) {
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error != std::errc{} || stop != end || value < least || value > most) {
            throw CLI::ValidationError(option,
                                       fmt::format("'{}' is not a whole number from {} to {}", text, least, most));
        }
    };
    return command.add_option_function<std::string>(option, parse, description)->type_name("N");
}

void add_search_options(CLI::App& command, CommonOptions& options)
{
    command
        .add_option("--tolerance", options.narrow_phase.tolerance,
                    "Width of the time interval in which the first contact is\nlocated; the whole step is 1. At least 2^-50 of the time searched")
        ->check(number_check("a positive finite number", [](double x) { return x > 0 && std::isfinite(x); }))
        ->type_name("T")
        ->capture_default_str();
    command.add_option("--t-max", options.narrow_phase.t_max, "Search for contact in [0, T], T at most 1")
        ->check(number_check("a number above 0 and at most 1", [](double x) { return x > 0 && x <= 1; }))
        ->type_name("T")
        ->capture_default_str();
    add_whole_number(command, "--threads", options.threads, 1, most_threads,
                     "Number of threads (default: all the machine has)");
    command
        .add_option_function<std::string>(
            "--isa", [&options](const std::string& text) { options.narrow_phase.isa = parse_isa(text); },
            "Instruction set, see `fastccd isa` (default: the environment\nvariable FASTCCD_ISA, or the widest)")
        ->type_name("NAME");
    command.add_flag("--reference", options.narrow_phase.reference,
                     "Answer every pair by the certified search alone: slower,\nthe same results");
    command.add_flag("--exact", options.narrow_phase.exact,
                     "Settle contacts that rounding leaves possible but not proven\nby rational arithmetic: none reported is a false alarm");
}

void add_separation_options(CLI::App& command, CommonOptions& options)
{
    const auto at_least_zero = number_check("a finite number, at least 0", [](double x) { return x >= 0 && std::isfinite(x); });
    const CLI::Validator not_too_small{
        [](const std::string& text) {
            double value = 0;
            const std::string digits = text.substr(0, text.find_first_of("eEpP"));
            const bool zero = CLI::detail::lexical_cast(text, value) && value == 0;
            if (!zero || digits.find_first_of("123456789") == std::string::npos) return std::string{};
            return fmt::format("'{}' is too small for a double, and would count as 0", text);
        },
        std::string{}};
    command
        .add_option("--min-separation", options.narrow_phase.minimum_separation,
                    "Contact is a distance of at most D, in units of the coordinates;\npairs as close at the start get toi 0")
        ->check(at_least_zero)
        ->check(not_too_small)
        ->type_name("D")
        ->excludes("--exact");
    command
        .add_option("--distance-tolerance", options.narrow_phase.distance_tolerance,
                    "Pairs at most (1 + X) D apart may count as in contact")
        ->check(at_least_zero)
        ->type_name("X")
        ->needs("--min-separation")
        ->capture_default_str();
}

void add_report_options(CLI::App& command, CommonOptions& options, const std::string& hits_columns, const std::string& json_names)
{
    command
        .add_option("--hits", options.hits,
                    fmt::format("Write the contacts as CSV: {}.\n"
                                "- is standard output, and moves the report to standard error",
                                hits_columns))
        ->check(output_name())
        ->type_name("OUT.csv");
    command.add_flag("--proof", options.proof, "A last column proven in --hits: 1, or 0 for a contact that is\npossible to within rounding")
        ->needs("--hits");
    command.add_flag("--json", options.json, fmt::format("Report as one JSON object ({})", json_names));
    command.add_flag("--quiet", options.quiet, "No progress bar, and no report unless --json");
}

void add_pair_options(CLI::App& command, PairOptions& options)
{
    command
        .add_option_function<std::string>(
            "--kind", [&options](const std::string& text) { options.kind = parse_kind(text); },
            "What the pairs are: vertex-face or edge-edge")
        ->required()
        ->type_name("vf|ee");
    add_search_options(command, options);
    add_separation_options(command, options);
    add_report_options(command, options, "pair,toi, invalid pairs with nan", "of invalid pairs it names the first ten");
    command.add_flag("--parity", options.parity, "Also count contacts at an odd and at an even number of roots")
        ->excludes("--proof")
        ->excludes("--min-separation");
}

void refuse_overwriting_input(const CommonOptions& options, const std::vector<std::string>& inputs)
{
    for (const std::string& input : inputs) {
        std::error_code not_both_exist;
        if (std::filesystem::equivalent(options.hits, input, not_both_exist)) {
            throw CLI::ValidationError("--hits", fmt::format("{} is an input", options.hits));
        }
    }
}

void refuse_overwriting_report(const CommonOptions& options)
{
    if (options.quiet && !options.json) return;
    struct stat standard_output {}, hits {};
    if (::fstat(STDOUT_FILENO, &standard_output) != 0 || !S_ISREG(standard_output.st_mode) || ::stat(options.hits.c_str(), &hits) != 0) return;
    if (OutputFile::is_standard_output(options.hits) || standard_output.st_dev != hits.st_dev || standard_output.st_ino != hits.st_ino) return;
    throw CLI::ValidationError("--hits", fmt::format("the report goes to {}, as that is standard output; --hits - writes the rows there", options.hits));
}

void refuse_overwriting_output(const CommonOptions& options, const std::filesystem::path& output)
{
    if (options.hits.empty() || OutputFile::is_standard_output(options.hits)) return;
    std::error_code unknown;
    // What is no ordinary file, such as /dev/null, takes both.
    if (OutputFile::place(options.hits) != OutputFile::place(output) || std::filesystem::is_other(options.hits, unknown)) return;
    throw CLI::ValidationError("--hits", fmt::format("{} is written already, by another option", options.hits));
}

CLI::Validator not_empty()
{
    return {[](std::string& text) { return text.empty() ? std::string{"the value is empty"} : std::string{}; }, std::string{}};
}

CLI::Validator output_name()
{
    const CLI::Validator not_like_an_option{
        [](std::string& text) -> std::string {
            if (text.size() < 2 || text.front() != '-') return {};
            return fmt::format("'{0}' begins like an option; a file or folder of that name is ./{0}", text);
        },
        std::string{}};
    return not_empty() & not_like_an_option;
}

CLI::Validator output_folder_name()
{
    const CLI::Validator not_standard_output{
        [](std::string& text) { return OutputFile::is_standard_output(text) ? std::string{"is to be a folder"} : std::string{}; }, std::string{}};
    return output_name() & not_standard_output;
}

PairRange parse_range(const std::string& text, std::size_t pairs)
{
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) {
        throw CLI::ValidationError("--range", fmt::format("'{}' is not A:B with pair numbers A and B", text));
    }
    const std::string_view whole{text};
    const PairRange range{.begin = parse_bound(whole.substr(0, colon), 0, text),
                          .end = parse_bound(whole.substr(colon + 1), pairs, text)};
    if (range.end > pairs) {
        throw CLI::ValidationError("--range", fmt::format("{} ends beyond the last of {} pairs", text, pairs));
    }
    if (range.begin > range.end) {
        throw CLI::ValidationError("--range", fmt::format("{} begins after its end, {}", text, range.end));
    }
    return range;
}

const char* kind_name(PairKind kind) noexcept
{
    return kind == PairKind::vertex_face ? "vertex-face" : "edge-edge";
}

}  // namespace fastccd::tools
