// The command `fastccd`.
//
// Exit status: 0 fine (invalid pairs included: they are answered), 1 a file or stream cannot be used, or memory
// or threads are refused, 2 the command line is wrong; otherwise ended by a signal (130 for Ctrl-C and 141 when the
// reader of the output went away, as shells count).
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "commands.hpp"
#include "interrupt.hpp"
#include "shown_text.hpp"

namespace {

constexpr int exit_failure = 1;
constexpr int exit_usage = 2;

/// Files opened later must not get the number of a standard stream that the caller closed: a report
/// would be written into them. To read from such an input and to write to such an output fails, as on a
/// closed one; what there is to say of that goes nowhere.
void open_closed_standard_streams()
{
    for (const auto& [descriptor, mode] : {std::pair{STDIN_FILENO, O_WRONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_RDWR}}) {
        if (::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) (void)::open("/dev/null", mode);
    }
}

/// CLI11 would take the next argument for the value of `--hits=`: a file to read would be written instead.
void refuse_empty_values(const std::vector<std::string_view>& arguments)
{
    for (const std::string_view argument : arguments) {
        if (argument == "--") return;
        if (argument.starts_with("--") && argument.find('=') + 1 == argument.size())
            throw CLI::ArgumentMismatch(fmt::format("{}: the value is empty", argument.substr(0, argument.size() - 1)));
    }
}

int fail(std::string_view message)
{
    // Not fmt::print: it throws when standard error cannot be written, and nobody is left to be told.
    std::fputs(fmt::format("fastccd: {}\n", fastccd::tools::on_one_line(message)).c_str(), stderr);
    return exit_failure;
}

/// What is wrong with the words of a command line that nothing takes, in their order; CLI11 lists them backwards.
std::string unexpected(const CLI::App& app)
{
    const std::vector<std::string> before = app.remaining();
    if (!before.empty() && before.front().starts_with('-')) return fmt::format("not expected before a subcommand: {}", before.front());
    if (!before.empty() && app.get_subcommands().empty()) return fmt::format("there is no subcommand '{}'", before.front());
    return fmt::format("not expected: {}", fmt::join(app.remaining(true), " "));
}

/// CLI11's words for an option without its value are "--pairs: 1 required N missing".
std::string without_value(const std::string& text)
{
    const std::size_t colon = text.find(": 1 required ");
    return colon == std::string::npos || !text.ends_with(" missing") ? text : text.substr(0, colon) + ": the value is missing";
}

/// One line: what is wrong, and where help is.
std::string usage_error(const CLI::App* app, const CLI::Error& error)
{
    std::string command = "fastccd";
    for (const CLI::App* const given : app->get_subcommands()) command += " " + given->get_name();
    // What is missing may be there, but misspelt.
    const bool extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                       (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && app->remaining_size(true) > 0);
    const std::string what = extra ? unexpected(*app) : without_value(error.what());
    return fmt::format("fastccd: {}; see `{} --help`\n", fastccd::tools::on_one_line(what), command);
}

/// The exit status, where the signal cannot end it, see end_by.
int ended_by(int signal)
{
    std::cout.flush();
    fastccd::tools::end_by(signal);
    return 128 + signal;
}

constexpr const char* footer = R"(Examples:
  fastccd random --kind vf --pairs 10000000 --parity
  fastccd random --kind ee --pairs 1000000 --seed 7 --save pairs.npy
  fastccd run pairs.npy --kind ee --hits hits.csv
  fastccd run a.csv b.csv --kind vf --tolerance 1e-6 --json
  fastccd run pairs.npy --kind ee --range 0:500000 --threads 4
  fastccd make-scene cloth-ball --size 100 --frames 10 cloth/
  fastccd scene cloth/frame_*.ply --hits contacts.csv
  fastccd scene a.obj b.obj --save-pairs pairs/ --json
  fastccd report --quick --out report/
  fastccd isa

Exit status: 0 all pairs answered, invalid ones named; 1 a file cannot be used, or
memory or threads are refused; 2 the command line is wrong. Ended by a signal, as
shells count it: 130 by Ctrl-C, 143 by termination, 141 because the reader of the
output went away.)";

}  // namespace

int main(int argc, char** argv)
{
    using namespace fastccd::tools;
    open_closed_standard_streams();
    install_signal_handlers();

    CLI::App app{"Narrow-phase continuous collision detection: which pairs of moving vertices\n"
                 "and faces, or of moving edges, touch during a step, and when first.",
                 "fastccd"};
    app.set_version_flag("--version", "fastccd " FASTCCD_VERSION);
    // Not require_subcommand: it would say that one is missing before it says which word is none.
    app.require_subcommand(0, 1);
    app.callback([&app] {
        if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
    });
    app.footer(footer);
    app.get_formatter()->column_width(24);
    app.failure_message(usage_error);
    add_random_command(app);
    add_run_command(app);
    add_scene_command(app);
    add_make_scene_command(app);
    add_report_command(app);
    add_isa_command(app);

    try {
        refuse_empty_values({argv + std::min(argc, 1), argv + argc});
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        if (app.exit(error) != 0) return exit_usage;
        if (std::cout.flush()) return 0;  // help, or the version
        if (errno == EPIPE) return ended_by(SIGPIPE);
        return fail(fmt::format("standard output: cannot be written: {}", std::generic_category().message(errno)));
    } catch (const Interrupted& interrupted) {
        return ended_by(interrupted.signal);
    } catch (const BrokenPipe&) {
        return ended_by(SIGPIPE);
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}
