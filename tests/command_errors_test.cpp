// The command `fastccd` end to end: exit codes, messages, no half-written files, streams and signals.
#include "command_test.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <pty.h>
#include <unistd.h>

#include <fastccd/isa.hpp>

namespace fastccd::testing {
namespace {

using Json = nlohmann::json;

// ---- Bad input --------------------------------------------------------------------------------------------

struct BadFile {
    const char* name;
    const char* contents;
    const char* message;
};

TEST(CommandErrors, BadFilesAreNamedAndLeaveNothing)
{
    const std::string seven = "0,1,0,1,0,1\n0,1,0,1,0,1\n0,1,0,1,0,1\n0,1,0,1,0,1\n0,1,0,1,0,1\n0,1,0,1,0,1\n0,1,0,1,0,1\n";
    const std::string third = seven + "1,3,0,1,0,1\n";
    for (const auto& [file, contents, message] :
         {BadFile{"short.npy", "\x93NUMPY", "truncated"}, BadFile{"other.npy", "hello", "not a .npy file"},
          BadFile{"seven.csv", seven.c_str(), "ends after row 7"},
          BadFile{"marked.csv", "\xEF\xBB\xBF" "0,1,0,1,0,1\n", "ends after row 1"},
          BadFile{"words.csv", "a,b,c,d,e,f\n", "row 1, column 1 (x numerator): 'a' is not an integer"},
          BadFile{"third.csv", third.c_str(), "row 8, column 1 (x numerator): 1/3 is not a double"},
          BadFile{"pairs.txt", "", "read from files whose names end in .npy or .csv"}}) {
        const ScratchDirectory directory;
        const std::string path = directory.write(file, contents);
        const std::string good = directory.write("good.csv", "");
        const Outcome outcome = run({"run", good, path, "--kind", "vf", "--hits", directory / "hits.csv"});
        EXPECT_EQ(outcome.status, 1);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.error.rfind("fastccd: " + path + ": ", 0), 0U) << outcome.error;
        EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
        EXPECT_EQ(directory.names().size(), 2U);
    }
    const ScratchDirectory directory;
    EXPECT_NE(run({"run", directory / "none.npy", "--kind", "vf"}).error.find("none.npy: cannot be opened: No such file"),
              std::string::npos);
    EXPECT_EQ(run_json({"run", directory.write("third.csv", third), "--kind", "vf", "--round"})["pairs"], 1);
}

TEST(CommandErrors, HitsThatCannotBeWrittenAreAnError)
{
    const ScratchDirectory directory;
    const Arguments random{"random", "--kind", "vf", "--pairs", "1000", "--hits"};
    for (const auto& [target, message] :
         {std::pair{directory / "none/hits.csv", "cannot be created: No such file"},
          std::pair{directory / ".", "is a directory"}, std::pair{std::string{"/dev/full"}, "No space left"}}) {
        Arguments arguments = random;
        arguments.push_back(target);
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
        EXPECT_EQ(outcome.out, "");
    }
    EXPECT_TRUE(directory.names().empty());

    const std::string input = directory.write("pairs.csv", "");
    const Outcome onto_input = run({"run", input, "--kind", "vf", "--hits", directory / "./pairs.csv"});
    EXPECT_EQ(onto_input.status, 2);
    EXPECT_NE(onto_input.error.find("is an input"), std::string::npos) << onto_input.error;
}

TEST(CommandErrors, HitsReplaceAFileOnlyWhenComplete)
{
    const ScratchDirectory directory;
    const std::string hits = directory.write("hits.csv", "old");
    std::filesystem::permissions(hits, std::filesystem::perms{0640});
    std::filesystem::create_symlink("hits.csv", directory / "link.csv");
    EXPECT_EQ(run({"run", directory.write("bad.csv", "1"), "--kind", "vf", "--hits", hits}).status, 1);
    EXPECT_EQ(read_text(hits), "old");
    EXPECT_EQ(run({"random", "--kind", "vf", "--pairs", "100", "--hits", directory / "link.csv"}).status, 0);
    EXPECT_NE(rows(hits), "");
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "link.csv"));
    EXPECT_EQ(std::filesystem::status(hits).permissions(), std::filesystem::perms{0640});
    EXPECT_EQ(directory.names().size(), 3U);

    // Of a link that leads nowhere yet, what it leads to is created.
    std::filesystem::create_symlink("new.csv", directory / "ahead.csv");
    EXPECT_EQ(run({"random", "--kind", "vf", "--pairs", "100", "--hits", directory / "ahead.csv"}).status, 0);
    EXPECT_EQ(read_text(directory / "new.csv"), read_text(hits));
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "ahead.csv"));

    // Links in a circle lead nowhere ever.
    std::filesystem::create_symlink("b.csv", directory / "a.csv");
    std::filesystem::create_symlink("a.csv", directory / "b.csv");
    const Outcome circle = run({"random", "--kind", "vf", "--pairs", "100", "--hits", directory / "a.csv"});
    EXPECT_EQ(circle.status, 1);
    EXPECT_NE(circle.error.find("a.csv"), std::string::npos) << circle.error;
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "a.csv"));

    const std::string longest = directory / std::string(255, 'x');
    EXPECT_EQ(run({"random", "--kind", "vf", "--pairs", "100", "--hits", longest}).status, 0);
    EXPECT_EQ(read_text(longest), read_text(hits));
}

/// Whether files in this folder can have room before they are written.
bool can_reserve(const std::string& file)
{
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    const bool can = descriptor >= 0 && ::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, 4096) == 0;
    ::close(descriptor);
    ::unlink(file.c_str());
    return can;
}

TEST(CommandErrors, WhatHasNoRoomIsRefusedBeforeItIsWritten)
{
    const ScratchDirectory directory;
    std::vector<std::string> numbers{"144115188075855872"};  // of pairs: more than the largest file there can be
    if (can_reserve(directory / "probe")) numbers.emplace_back("9999999999999");  // two petabytes
    for (const std::string& pairs : numbers) {
        const Outcome outcome = run({"random", "--kind", "vf", "--pairs", pairs, "--save", directory / "pairs.npy"});
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.error.find("pairs.npy: cannot be written"), std::string::npos) << outcome.error;
        EXPECT_EQ(directory.names().size(), 0U);
    }
}

// ---- Command line -----------------------------------------------------------------------------------------

TEST(CommandErrors, UsageErrorsAreOneLineAndStatusTwo)
{
    const ScratchDirectory directory;
    const std::string none = directory.write("none.csv", "");
    const struct {
        Arguments arguments;
        const char* message;
    } table[] = {
        {{}, "A subcommand is required"},
        {{"fly", "--kind", "vf"}, "there is no subcommand 'fly'; see"},
        {{"isa", "--kind", "vf"}, "not expected: --kind vf; see"},
        {{"--kind", "vf"}, "not expected before a subcommand: --kind; see"},
        {{"--kind", "vf", "random"}, "not expected before a subcommand: --kind; see"},
        {{"random"}, "--kind is required"},
        {{"random", "--kin", "vf"}, "not expected: --kin vf; see `fastccd random --help`"},
        {{"run", "-x.npy", "--kind", "vf"}, "not expected: -x.npy; see"},
        {{"random", "--kind", "ve"}, "--kind: 've' is neither vf"},
        {{"random", "--kind", "vf", "--pairs", "-1"}, "--pairs"},
        {{"random", "--kind", "vf", "--pairs"}, "--pairs: the value is missing; see"},
        {{"random", "--kind", "vf", "--save"}, "--save: the value is missing; see"},
        {{"random", "--kind", "vf", "--pairs", "1e6"}, "--pairs: '1e6' is not a whole number"},
        {{"random", "--kind", "vf", "--pairs", "99999999999999999999"}, "--pairs: '99999999999999999999' is not"},
        {{"random", "--kind", "vf", "--seed", "x"}, "--seed: 'x' is not"},
        {{"random", "--kind", "vf", "--tolerance", "0"}, "--tolerance: '0' is not a positive"},
        {{"random", "--kind", "vf", "--tolerance", "nan"}, "--tolerance: 'nan' is not"},
        {{"random", "--kind", "vf", "--tolerance", "inf"}, "--tolerance: 'inf' is not"},
        {{"random", "--kind", "vf", "--tolerance", "1x"}, "--tolerance: '1x' is not"},
        {{"random", "--kind", "vf", "--t-max", "1.5"}, "--t-max: '1.5' is not"},
        {{"random", "--kind", "vf", "--t-max", "0"}, "--t-max: '0' is not"},
        {{"random", "--kind", "vf", "--threads", "0"}, "--threads: '0' is not a whole number from 1"},
        {{"random", "--kind", "vf", "--isa", "mmx"}, "--isa: there is no instruction set 'mmx'; available here: scalar"},
        {{"random", "--kind", "vf", "--nothing"}, "--nothing"},
        {{"random", "--kind", "vf", "--min-separation", "1e-400"}, "--min-separation: '1e-400' is too small"},
        {{"run", "--kind", "vf", "--hits=", none}, "--hits: the value is empty"},
        {{"run", directory / "none.csv", "--kind", "vf", "--hits=" + (directory / "a="), "--range", "x"}, "--range: 'x' is not A:B"},
        {{"random", "--kind", "vf", "--save", "-"}, "--save: the report goes to standard output"},
        {{"random", "--kind", "vf", "--save", directory / "pairs.CSV"}, "--save: what is written is .npy"},
        {{"run", "--kind", "vf"}, "FILE is required"},
        {{"run", "", "--kind", "vf"}, "FILE: the value is empty"},
        {{"run", none}, "--kind is required"},
        {{"run", none, "--kind", "vf", "--range", "0:1"}, "--range: 0:1 ends beyond the last of 0 pairs"},
        {{"run", none, "--kind", "vf", "--range", "1:0"}, "--range: 1:0 begins after its end"},
        {{"run", none, "--kind", "vf", "--range", "5"}, "--range: '5' is not A:B"},
        {{"run", none, "--kind", "vf", "--range", "a:b"}, "--range: 'a:b' is not A:B"},
        {{"run", none, "--kind", "vf", "--range", "0:0:0"}, "--range: '0:0:0' is not A:B"},
        {{"run", none, "--kind", "vf", "--range", "-1:0"}, "--range"},
    };
    for (const auto& [arguments, message] : table) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2) << message;
        EXPECT_EQ(outcome.out, "") << message;
        EXPECT_EQ(outcome.error.rfind("fastccd: ", 0), 0U) << outcome.error;
        EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    }
}

/// What is in a file's name drives no terminal by way of an error, and that stays one line.
TEST(CommandErrors, NamesWithControlCharactersAreSpelledOut)
{
    const Outcome file = run({"run", "--kind", "vf", "none\n\x1b[31m\x7f\xc3\xa9\xc2\x9b.csv"});
    EXPECT_EQ(file.status, 1);
    EXPECT_EQ(file.error.rfind("fastccd: none\\x0a\\x1b[31m\\x7f\xc3\xa9\xc2\\x9b.csv: cannot be opened", 0), 0U) << file.error;
    const ScratchDirectory directory;
    const std::string pairs = directory / "a\x1b[2J.npy";
    EXPECT_EQ(run({"random", "--kind", "vf", "--pairs", "1", "--quiet", "--save", pairs}).status, 0);
    const Outcome report = run({"run", "--kind", "vf", pairs});
    EXPECT_EQ(report.status, 0);
    EXPECT_NE(report.out.find("a\\x1b[2J.npy"), std::string::npos) << report.out;
    EXPECT_EQ(report.out.find('\x1b'), std::string::npos) << report.out;
    const Outcome word = run({"random", "--kind", "vf", "--\x1bx"});
    EXPECT_EQ(word.status, 2);
    EXPECT_EQ(word.error.rfind("fastccd: not expected: --\\x1bx; see", 0), 0U) << word.error;
}

TEST(CommandErrors, HelpAndVersion)
{
    for (const Arguments& arguments : {Arguments{"--help"}, {"run", "--help"}, {"random", "-h"}, {"isa", "--help"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0);
        EXPECT_NE(outcome.out.find("Examples:\n  fastccd random"), std::string::npos) << outcome.out;
    }
    EXPECT_EQ(run({"--version"}).out.rfind("fastccd ", 0), 0U);
}

TEST(CommandErrors, InstructionSetsAreListedForcedAndRefused)
{
    const Json list = run_json({"isa"});
    EXPECT_EQ(list["used"], name(best_isa()));
    for (const Json& isa : list["isas"]) {
        const std::string chosen = isa["name"];
        const Arguments arguments{"random", "--kind", "vf", "--pairs", "100", "--json"};
        Arguments forced = arguments;
        forced.insert(forced.end(), {"--isa", chosen});
        const Outcome option = run(forced);
        const Outcome environment = run(arguments, {"FASTCCD_ISA=" + chosen});
        if (isa["available"]) {
            EXPECT_EQ(Json::parse(option.out)["isa"], chosen);
            EXPECT_EQ(Json::parse(environment.out)["isa"], chosen);
        } else {
            for (const Outcome& refused : {option, environment}) {
                EXPECT_EQ(refused.status, 2);
                EXPECT_NE(refused.error.find("available here: scalar"), std::string::npos) << refused.error;
            }
        }
    }
    EXPECT_NE(run({"isa"}).out.find(std::string{name(best_isa())}), std::string::npos);
    EXPECT_EQ(run({"isa"}, {"FASTCCD_ISA=mmx"}).status, 2);
    const Outcome named = run({"random", "--kind", "vf", "--pairs", "1"}, {"FASTCCD_ISA=mmx"});
    EXPECT_EQ(named.status, 2);
    EXPECT_NE(named.error.find("available on this machine: 'mmx'; available here: scalar"), std::string::npos) << named.error;
}

// ---- Streams and signals ----------------------------------------------------------------------------------

TEST(CommandErrors, HitsOnStandardOutputMoveTheReport)
{
    for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
        SCOPED_TRACE(name);
        const Outcome outcome = run({"random", "--kind", "vf", "--pairs", "1000", "--hits", name, "--json"});
        EXPECT_EQ(outcome.status, 0);
        EXPECT_EQ(outcome.out.rfind("pair,toi\n", 0), 0U);
        const auto lines = std::count(outcome.out.begin(), outcome.out.end(), '\n');
        EXPECT_EQ(Json::parse(outcome.error)["contacts"], lines - 1);
    }
}

TEST(CommandErrors, HitsOnADescriptorThatIsNotOpen)
{
    const Outcome outcome = run({"random", "--kind", "vf", "--pairs", "1000", "--hits", "/dev/fd/99"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.error, "fastccd: /dev/fd/99: cannot be opened: Bad file descriptor\n");
    EXPECT_EQ(outcome.out, "");
}

TEST(CommandErrors, OutputThatGoesNowhere)
{
    const Arguments random{"random", "--kind", "vf", "--pairs", "1000"};
    const Outcome no_reader = run(random, {}, {.no_reader = true});
    EXPECT_EQ(no_reader.status, 1000 + SIGPIPE);
    EXPECT_EQ(no_reader.error, "");
    for (const Arguments& arguments : {random, {"random", "--kind", "vf", "--quiet", "--hits", "-"}, {"isa"}, {"--help"}}) {
        const Outcome closed = run(arguments, {}, {.closed = true});
        EXPECT_EQ(closed.status, 1);
        EXPECT_EQ(closed.error, "fastccd: standard output: cannot be written: Bad file descriptor\n");
    }
    EXPECT_EQ(run({"random", "--kind", "vf", "--quiet"}, {}, {.closed = true}).status, 0) << "there was nothing to write";
    const Outcome full = run(random, {}, {.path = "/dev/full"});
    EXPECT_EQ(full.status, 1);
    EXPECT_EQ(full.error, "fastccd: standard output: cannot be written: No space left on device\n");
}

/// Whoever shares a pipe with the command may have made it one that does not wait.
TEST(CommandErrors, OutputThatDoesNotWait)
{
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_NONBLOCK), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        ::dup2(ends[1], STDOUT_FILENO);
        ::close(ends[0]);
        become_command({"random", "--kind", "ee", "--pairs", "100000", "--quiet", "--hits", "-"});
    }
    ::close(ends[1]);
    ::usleep(200'000);  // the pipe is full by then
    ::fcntl(ends[0], F_SETFL, 0);
    std::string out;
    char buffer[4096];
    for (ssize_t n = 0; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) out.append(buffer, static_cast<std::size_t>(n));
    ::close(ends[0]);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(exit_status(status), 0);
    EXPECT_EQ(out, run({"random", "--kind", "ee", "--pairs", "100000", "--quiet", "--hits", "-"}).out);
    EXPECT_GT(out.size(), 100'000U) << "more than a pipe holds";
}

/// Runs on a terminal of its own and sends `signal` once the progress bar is there.
Outcome run_on_terminal(const Arguments& arguments, int signal)
{
    int terminal = -1;
    const winsize size{.ws_row = 24, .ws_col = 70, .ws_xpixel = 0, .ws_ypixel = 0};
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
    if (child < 0) throw std::runtime_error("cannot fork");
    if (child == 0) {
        ::setenv("TERM", "xterm", 1);
        become_command(arguments);
    }
    Outcome outcome;
    bool sent = false;
    char buffer[4096];
    for (ssize_t n = 0; (n = ::read(terminal, buffer, sizeof buffer)) > 0;) {
        outcome.out.append(buffer, static_cast<std::size_t>(n));
        if (!sent && outcome.out.find('%') != std::string::npos) {
            if (signal == SIGINT) {
                const char control_c = 3;
                sent = ::write(terminal, &control_c, 1) == 1;
            } else {
                sent = ::kill(child, signal) == 0;
            }
        }
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(terminal);
    outcome.status = exit_status(status);
    return outcome;
}

TEST(CommandErrors, SignalsEndItCleanly)
{
    for (const int signal : {SIGINT, SIGTERM}) {
        const ScratchDirectory directory;
        const std::string hits = directory.write("hits.csv", "old");
        const Outcome outcome =
            run_on_terminal({"random", "--kind", "vf", "--pairs", "10000000000", "--hits", hits}, signal);
        EXPECT_EQ(outcome.status, 1000 + signal);
        EXPECT_NE(outcome.out.find("\r\x1b[K["), std::string::npos) << outcome.out;
        EXPECT_NE(outcome.out.find(" M pairs/s  "), std::string::npos) << outcome.out;
        // The last thing on the terminal is an erased line.
        EXPECT_EQ(outcome.out.substr(outcome.out.size() - 4), "\r\x1b[K");
        EXPECT_EQ(directory.names(), std::vector<std::string>{"hits.csv"});
        EXPECT_EQ(read_text(hits), "old");
    }
}

/// As from `timeout`, which sends a signal to its child and then to the group.
TEST(CommandErrors, TheSameSignalTwiceAtOnceEndsItCleanly)
{
    for (const int signal : {SIGINT, SIGTERM}) {
        const ScratchDirectory directory;
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            become_command({"random", "--kind", "vf", "--pairs", "10000000000", "--quiet", "--hits", directory / "hits.csv"});
        }
        while (directory.names().empty()) ::usleep(1000);  // until it writes
        ::kill(child, signal);
        ::usleep(100);
        ::kill(child, signal);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_EQ(exit_status(status), 1000 + signal);
        EXPECT_TRUE(directory.names().empty());
    }
}

TEST(CommandErrors, FilesTooLargeLeaveNothing)
{
    const ScratchDirectory directory;
    const Outcome outcome =
        run_limited(RLIMIT_FSIZE, 100'000, {"random", "--kind", "vf", "--pairs", "300000", "--quiet", "--save", directory / "large.npy"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.error, "fastccd: " + (directory / "large.npy") + ": cannot be written: File too large\n");
    EXPECT_TRUE(directory.names().empty());
}

/// oneTBB would end the process when a worker cannot start another.
TEST(CommandErrors, RefusedThreadsAreNamed)
{
    if (sanitized) GTEST_SKIP() << "NOT TESTED: a sanitizer needs more memory than the limit; refused threads were not checked here";
    const ScratchDirectory directory;
    const Outcome outcome = run_limited(RLIMIT_AS, 2'000'000'000,
                                        {"random", "--kind", "vf", "--pairs", "300000", "--threads", "4096", "--hits", directory / "hits.csv"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.error, "fastccd: the system refuses 4096 threads (a limit on processes or memory?); ask for fewer with --threads\n");
    EXPECT_TRUE(directory.names().empty());
}

/// Room is made for as many pairs as there is text for, 96 MB here, not for one every eight lines, 1.15 GB.
TEST(CommandErrors, BlankLinesAreRefusedByTheirRowNotForWantOfMemory)
{
    if (sanitized) GTEST_SKIP() << "NOT TESTED: a sanitizer needs more memory than the limit; blank lines were not refused under one here";
    const ScratchDirectory directory;
    const std::string blank = directory.write("blank.csv", std::string(48'000'000, '\n') + "1,1,1,1,1,1\n");
    const Outcome outcome = run_limited(RLIMIT_AS, 1'000'000'000, {"run", "--kind", "vf", "--quiet", blank});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.error, "fastccd: " + blank + ": row 1 has 0 columns; expected 6, or 7 with the truth\n");
}

TEST(CommandErrors, OutputsOfOneNameAndOfNoneAreRefused)
{
    const ScratchDirectory directory;
    const std::string file = directory / "file";
    const auto refused = [&](const Arguments& more, const std::string& words) {
        Arguments arguments{"random", "--kind", "vf", "--pairs", "16", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_NE(outcome.error.find(words), std::string::npos) << outcome.error;
    };
    refused({"--hits", file, "--save", file}, "written already");
    refused({"--hits", directory / "./file", "--save", file}, "written already");
    refused({"--hits", file, "--save", std::filesystem::relative(file)}, "written already");
    refused({"--hits", ""}, "--hits: the value is empty");
    refused({"--hits=", file}, "--hits: the value is empty");
    refused({"--save=", file}, "--save: the value is empty");
    refused({"--save", ""}, "--save: the value is empty");
    refused({"--hits", "--json"}, "--hits: '--json' begins like an option; a file or folder of that name is ./--json");
    refused({"--save", "--parity"}, "--save: '--parity' begins like an option");
    refused({"--save", "-q"}, "--save: '-q' begins like an option");
    EXPECT_FALSE(std::filesystem::exists("--json") || std::filesystem::exists("--parity") || std::filesystem::exists("-q"));
    EXPECT_TRUE(directory.names().empty());
    EXPECT_EQ(run({"random", "--kind", "vf", "--pairs", "16", "--quiet", "--hits", "/dev/null", "--save", "/dev/null"}).status, 0);

    // Nor may the report be lost, with the file that standard output was.
    for (const char* kind : {"--json", "--parity"}) {
        const Outcome both = run({"random", "--kind", "vf", "--pairs", "16", kind, "--hits", file}, {}, {.path = file});
        EXPECT_EQ(both.status, 2);
        EXPECT_NE(both.error.find("--hits: the report goes to " + file), std::string::npos) << both.error;
    }
    EXPECT_EQ(run({"random", "--kind", "vf", "--pairs", "16", "--quiet", "--hits", file}, {}, {.path = file}).status, 0) << "there is no report";
    EXPECT_EQ(read_text(file).rfind("pair,toi\n", 0), 0U);
    std::filesystem::remove(file);

    // Links to a file that is to be created.
    std::filesystem::create_symlink("file", directory / "link");
    std::filesystem::create_symlink(directory / "link", directory / "other_link");
    refused({"--hits", directory / "link", "--save", file}, "written already");
    refused({"--hits", file, "--save", directory / "link"}, "written already");
    refused({"--hits", directory / "link", "--save", directory / "other_link"}, "written already");
    EXPECT_EQ(directory.names().size(), 2U);
}

TEST(CommandErrors, HelpThatNobodyGetsIsAnError)
{
    for (const char* option : {"--help", "--version"}) {
        const Outcome full = run({option}, {}, {.path = "/dev/full"});
        EXPECT_EQ(full.status, 1);
        EXPECT_EQ(full.error, "fastccd: standard output: cannot be written: No space left on device\n");
        EXPECT_EQ(run({option}, {}, {.no_reader = true}).status, 1000 + SIGPIPE);
    }
}

}  // namespace
}  // namespace fastccd::testing
