#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "common_options.hpp"
#include "narrow_phase_run.hpp"
#include "npy.hpp"
#include "output_file.hpp"
#include "pair_slice.hpp"
#include "random_pairs.hpp"
#include "report_totals.hpp"

namespace fastccd::tools {
namespace {

struct RandomOptions {
    PairOptions common;
    std::uint64_t pairs = 10'000'000;
    std::uint64_t seed = 1;
    std::string save;
};

void random_command(const RandomOptions& options)
{
    const Question question{
        .source = fmt::format("{} in the unit cube, seed {}", counted(options.pairs, "random pair"), options.seed),
        .pairs = options.pairs,
        .seed = options.seed};
    if (!options.save.empty()) refuse_overwriting_output(options.common, options.save);
    refuse_overwriting_report(options.common);
    std::optional<NpyWriter> saved;
    const Totals totals = run_narrow_phase(options.common, question, [&](NarrowPhaseRun& run) {
        if (!options.save.empty()) {
            // Blocks can be used in place later, but have no way to say that the last is not full.
            const bool whole_blocks = options.pairs % block_pairs == 0;
            saved.emplace(options.save, whole_blocks ? PairView::Layout::blocked : PairView::Layout::interleaved,
                          options.pairs);
        }
        PairBuffer pairs{std::min(chunk_pairs, options.pairs)};
        for (std::uint64_t first = 0; first < options.pairs; first += chunk_pairs) {
            const std::size_t size = std::min<std::uint64_t>(chunk_pairs, options.pairs - first);
            fill_random_pairs(options.seed, first, pairs);
            const PairView view = slice(pairs.view(), 0, size);
            run.answer(view, first);
            if (saved) saved->append(view);
        }
        if (saved) saved->close();
    });
    if (saved) saved->commit();  // right after the hits: to be stopped leaves both of them or neither
    print_report(options.common, question, totals);
}

}  // namespace

void add_random_command(CLI::App& app)
{
    CLI::App* const command = app.add_subcommand(
        "random", "Answer random pairs: positions at t = 0 and 1 uniform in the unit cube");
    const auto options = std::make_shared<RandomOptions>();
    add_whole_number(*command, "--pairs", options->pairs, 0, most_random_pairs, "Number of pairs")
        ->default_str(std::to_string(options->pairs));
    add_whole_number(*command, "--seed", options->seed, 0, std::numeric_limits<std::uint64_t>::max(),
                     "Which pairs: pair i depends on seed and i alone")
        ->default_str(std::to_string(options->seed));
    command
        ->add_option("--save", options->save,
                     "Also write the pairs as float64 .npy: shape (N/8, 24, 8), or\n(N, 8, 3) if 8 does not divide N")
        ->check([](const std::string& path) {
            return OutputFile::is_standard_output(path) ? "the report goes to standard output; name a file" : "";
        })
        ->check(output_name())
        ->check([](const std::string& path) {
            const std::string extension = std::filesystem::path{path}.extension().string();
            return CLI::detail::to_lower(extension) == ".csv" ? "what is written is .npy, and `run` would read it as its name says" : "";
        })
        ->type_name("OUT.npy");
    add_pair_options(*command, options->common);
    command->callback([options] { random_command(*options); });
}

}  // namespace fastccd::tools
