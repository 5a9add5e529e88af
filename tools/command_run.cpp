#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "common_options.hpp"
#include "narrow_phase_run.hpp"
#include "pair_files.hpp"
#include "report_totals.hpp"

namespace fastccd::tools {
namespace {

struct RunOptions {
    PairOptions common;
    std::vector<std::string> files;
    std::string range;
    bool round = false;
};

void run_command(const RunOptions& options)
{
    refuse_overwriting_input(options.common, options.files);
    refuse_overwriting_report(options.common);
    const PairFiles files{options.files, options.round ? Rounding::nearest : Rounding::exact_only};
    PairRange range{.begin = 0, .end = files.size()};
    if (!options.range.empty()) range = parse_range(options.range, files.size());

    std::string source = options.files.size() == 1 ? options.files.front()
                                                   : fmt::format("{} files, {} to {}", options.files.size(),
                                                                 options.files.front(), options.files.back());
    Question question{.source = std::move(source), .pairs = range.size(), .files = options.files, .first_pairs = files.first_pairs()};
    if (!options.range.empty()) {
        question.range = range;
        question.source += fmt::format(", pairs {}:{} of {}", range.begin, range.end, with_commas(files.size()));
    }
    const Totals totals = run_narrow_phase(options.common, question, [&](NarrowPhaseRun& run) {
        files.for_each_chunk(range, chunk_pairs,
                             [&run](const PairView& pairs, std::size_t first, std::span<const std::int8_t> truth) {
                                 run.answer(pairs, first, truth);
                             });
    });
    print_report(options.common, question, totals);
}

}  // namespace

void add_run_command(CLI::App& app)
{
    CLI::App* const command = app.add_subcommand("run", "Answer the pairs in files");
    const auto options = std::make_shared<RunOptions>();
    command
        ->add_option("FILE", options->files,
                     ".npy, float64 or float32, shape (N, 8, 3): points x0..x3 at\n"
                     "t = 0, then at t = 1; or (B, 24, 8): blocks of 8 pairs, any\n"
                     "padding of the last one included.\n"
                     ".csv: rationals of the NYU benchmark, 8 rows a pair, with or\n"
                     "without truth.\n"
                     "Pairs of several files are numbered on from one to the next")
        ->required()
        ->check(not_empty())
        ->type_name("");
    command
        ->add_option("--range", options->range,
                     "Only pairs A to B-1 of all files; pairs keep their numbers")
        ->check(not_empty())
        ->type_name("A:B");
    command->add_flag("--round", options->round, "Take the nearest double where a rational is none");
    add_pair_options(*command, options->common);
    command->callback([options] { run_command(*options); });
}

}  // namespace fastccd::tools
