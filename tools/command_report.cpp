#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "commands.hpp"
#include "common_options.hpp"
#include "output_file.hpp"
#include "report/report.hpp"
#include "shown_text.hpp"

namespace fastccd::tools {

void add_report_command(CLI::App& app)
{
    CLI::App* const command =
        app.add_subcommand("report", "Measure speed against error on this machine, as a page with pictures");
    const auto options = std::make_shared<report::ReportOptions>();
    command->add_option("--out", options->out, "Folder for report.html, report.json and the pictures (.svg)")
        ->check(output_folder_name())
        ->type_name("DIR")
        ->capture_default_str();
    add_whole_number(*command, "--pairs", options->pairs, 1, 1'000'000'000,
                     "Random pairs of the paper's Table 1; other parts use at most so\nmany, the scaling ten times (default: "
                     "10000000, --quick 1000000)");
    command
        ->add_option("--data", options->data,
                     "Also use public data: DIR/hardcases, DIR/queries, DIR/scenes,\nas far as they are there")
        ->check(CLI::ExistingDirectory.description(""))
        ->type_name("DIR");
    command->add_flag("--quick", options->quick, "Fewer pairs, sizes and repeats: a minute instead of several");
    command->add_flag("--quiet", options->quiet, "No progress bar, and nothing on standard output");
    command->add_option("--draw", options->draw, "Measure nothing: draw page and pictures again from an earlier\nreport.json")
        ->check(CLI::ExistingFile.description(""))
        ->excludes("--pairs", "--data", "--quick")
        ->type_name("FILE");
    command->callback([options] {
        report::write_report(*options);
        if (options->quiet) return;
        write_all(STDOUT_FILENO, fmt::format("wrote {}\n", on_one_line((std::filesystem::path{options->out} / "report.html").string())),
                  "standard output");
    });
}

}  // namespace fastccd::tools
