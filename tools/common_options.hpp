// Options that subcommands share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <fastccd/options.hpp>

namespace CLI {
class App;
class Option;
class Validator;
}

namespace fastccd::tools {

/// No machine has more; what is beyond is a slip of the finger.
inline constexpr std::uint64_t most_threads = 4096;

struct CommonOptions {
    Options narrow_phase;
    std::uint64_t threads = 0;  ///< At most most_threads; 0: as many as the machine runs at once.
    std::string hits;           ///< Where to write the contacts; empty: nowhere.
    bool proof = false;         ///< Say of each of them whether it is proven.
    bool json = false;
    bool quiet = false;
};

/// Of the subcommands that answer pairs of one kind, given as coordinates.
struct PairOptions : CommonOptions {
    PairKind kind = PairKind::vertex_face;
    bool parity = false;  ///< Count odd and even contacts.
};

// Each of these adds options to a subcommand; `options` outlives the parse. Values are checked
// there, what machine and build offer included, so that a bad one ends in a CLI::ParseError.

/// How to search: tolerance, t_max, threads, instruction set, reference.
void add_search_options(CLI::App& command, CommonOptions& options);

/// A distance to keep instead of contact. After add_search_options.
void add_separation_options(CLI::App& command, CommonOptions& options);

/// What to tell: hits, whose description ends in `hits_columns`, json, of which it ends in `json_names`, quiet.
void add_report_options(CLI::App& command, CommonOptions& options, const std::string& hits_columns, const std::string& json_names);

/// All options of PairOptions.
void add_pair_options(CLI::App& command, PairOptions& options);

/// Throws CLI::ValidationError if the hits would take the place of one of `inputs`.
void refuse_overwriting_input(const CommonOptions& options, const std::vector<std::string>& inputs);

/// Throws CLI::ValidationError if the hits and `output`, another file that is written, are the same ordinary file.
void refuse_overwriting_output(const CommonOptions& options, const std::filesystem::path& output);

/// Throws CLI::ValidationError if standard output, to which the report goes, is the file that the hits take the place of: `--hits out > out`.
void refuse_overwriting_report(const CommonOptions& options);

/// Refuses the empty string, as of a variable of the shell that is not set.
[[nodiscard]] CLI::Validator not_empty();

/// For files and folders to be written: refuses the empty string, and what begins like an option. CLI11 takes whatever follows as the value, so
/// `--hits --json` would write a file `--json`. What `-` alone means is up to the option.
[[nodiscard]] CLI::Validator output_name();

/// The same for folders alone, which standard output is none of.
[[nodiscard]] CLI::Validator output_folder_name();

/// Adds an option that takes a decimal number in [least, most]. (CLI11 by itself reads 010 as 8.)
CLI::Option* add_whole_number(CLI::App& command, const std::string& option, std::uint64_t& value, std::uint64_t least,
                              std::uint64_t most, const std::string& description);

/// Half-open range of pairs.
struct PairRange {
    std::size_t begin = 0;
    std::size_t end = 0;

    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

/// Reads "A:B", where A left out is 0 and B left out is `pairs`. Throws CLI::ValidationError if it
/// is none, or not within [0, pairs].
[[nodiscard]] PairRange parse_range(const std::string& text, std::size_t pairs);

/// "vertex-face" or "edge-edge".
[[nodiscard]] const char* kind_name(PairKind kind) noexcept;
/// "vf" or "ee": as the command line has it, and files.
[[nodiscard]] constexpr const char* short_name(PairKind kind) noexcept { return kind == PairKind::vertex_face ? "vf" : "ee"; }

}  // namespace fastccd::tools
