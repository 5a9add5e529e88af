// What happens to the command in the midst of its work: it is held there by a pipe of --hits that nobody reads for a while.
#include "command_test.hpp"

#include <csignal>
#include <string_view>

#include <poll.h>
#include <sys/stat.h>

#include "tools/mapped_file.hpp"

namespace fastccd::testing {
namespace {

using tools::InputError;
using tools::MappedFile;
using tools::check_mapped_files;

/// Runs with --hits to a pipe, calls `meanwhile` with the process once rows have come and no more go in, then reads all.
template <class Meanwhile>
Outcome run_held(const ScratchDirectory& directory, Arguments arguments, Meanwhile meanwhile)
{
    const std::string pipe = directory / "hits_pipe", error = directory / "error";
    if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
    arguments.insert(arguments.end(), {"--hits", pipe});
    // Both ends, so that the command opens its own at once.
    const int reader = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot fork");
    if (child == 0) {
        ::dup2(::open(error.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        become_command(arguments);
    }
    pollfd rows{.fd = reader, .events = POLLIN, .revents = 0};
    if (::poll(&rows, 1, 60'000) != 1) ADD_FAILURE() << "no rows";
    meanwhile(child);
    int status = 0;
    char buffer[1 << 16];
    while (::waitpid(child, &status, WNOHANG) == 0) {
        if (::read(reader, buffer, sizeof buffer) <= 0) ::usleep(1000);
    }
    ::close(reader);
    const Outcome outcome{.status = exit_status(status), .out = {}, .error = read_text(error)};
    std::filesystem::remove(pipe);
    std::filesystem::remove(error);
    return outcome;
}

/// As by numpy.save() of the next pairs into the same file.
TEST(HeldCommand, NamesAFileThatIsCutShortWhileItsPairsAreAnswered)
{
    const ScratchDirectory directory;
    const std::string pairs = directory / "pairs.npy";
    // As many as are got off the disk at once. All are in contact, at the start: of half of them there is more to write than a pipe holds.
    ASSERT_EQ(run({"random", "--kind", "ee", "--pairs", "262144", "--quiet", "--save", pairs}).status, 0);
    const std::string whole = read_text(pairs);
    for (const Arguments& more : {Arguments{}, {"--threads", "1"}, {"--reference"}}) {
        directory.write("pairs.npy", whole);
        Arguments arguments{"run", pairs, "--kind", "ee", "--quiet", "--min-separation", "2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run_held(directory, arguments, [&](pid_t) { std::filesystem::resize_file(pairs, 1'000'000); });
        EXPECT_EQ(outcome.status, 1) << outcome.error;
        EXPECT_EQ(outcome.error.rfind("fastccd: " + pairs + ": cannot be read ", 0), 0U) << outcome.error;
        EXPECT_NE(outcome.error.find("the file was cut short meanwhile, or its disk fails\n"), std::string::npos) << outcome.error;
        EXPECT_EQ(directory.names(), std::vector<std::string>{"pairs.npy"});
    }
}

/// A result of this run beside one of another would be neither.
TEST(HeldCommand, ASignalLeavesBothFilesOfBeforeWhileTheSecondIsWritten)
{
    for (const int signal : {SIGINT, SIGTERM}) {
        const ScratchDirectory directory;
        const std::string saved = directory.write("saved.npy", "old");
        // Rows that go into the pipe at the very end, but more than it holds.
        const Outcome outcome = run_held(directory, {"random", "--kind", "ee", "--pairs", "40000", "--quiet", "--save", saved},
                                         [&](pid_t child) { ::kill(child, signal); });
        EXPECT_EQ(outcome.status, 1000 + signal) << outcome.error;
        EXPECT_TRUE(read_text(saved) == "old");
        EXPECT_EQ(directory.names(), std::vector<std::string>{"saved.npy"});
    }
}

/// A file of ones with many pages, which is cut short.
class CutFile {
public:
    CutFile() : path_{directory_.write("ones", std::string(size, '1'))} {}
    void cut() const { std::filesystem::resize_file(path_, left); }
    [[nodiscard]] const std::string& path() const { return path_; }

    static constexpr std::size_t size = 1'000'000, left = 1 << 16;

private:
    ScratchDirectory directory_;
    std::string path_;
};

std::string error_of_check()
{
    try {
        check_mapped_files();
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST(MappedFile, PutsZerosInThePlaceOfWhatIsCutOffAndSaysSo)
{
    const CutFile file, whole;
    const MappedFile before{whole.path()};
    {
        const MappedFile map{file.path()};
        const MappedFile after{whole.path()};
        map.load(0, CutFile::size);
        file.cut();
        EXPECT_EQ(map.bytes()[CutFile::left - 1], '1');
        EXPECT_EQ(error_of_check(), "none");
        EXPECT_EQ(map.bytes()[CutFile::size - 1], '\0');
        EXPECT_NE(error_of_check().find(file.path() + ": cannot be read from byte "), std::string::npos) << error_of_check();
        EXPECT_EQ(map.bytes()[CutFile::left], '\0');
        EXPECT_NE(error_of_check().find("from byte 65536 on: the file was cut short"), std::string::npos) << error_of_check();
        EXPECT_EQ(map.bytes()[CutFile::left - 1], '1') << "what is there is left alone";
        EXPECT_EQ(after.bytes()[CutFile::size - 1], '1');
    }
    EXPECT_EQ(error_of_check(), "none") << "of files in use alone";
    EXPECT_EQ(before.bytes()[CutFile::size - 1], '1');
}

TEST(MappedFile, ParsersOfZerosSayThatTheFileWasCutShort)
{
    const CutFile file;
    const MappedFile map{file.path()};
    file.cut();
    const auto last = [](std::string_view bytes) { return bytes.back(); };
    const auto fails = [](std::string_view bytes) -> char { throw InputError{"a", bytes.back() == '\0' ? "zeros" : "ones"}; };
    for (int i = 0; i < 2; ++i) {
        try {
            (void)(i == 0 ? map.parsed(last) : map.parsed(fails));
            ADD_FAILURE() << "nothing said";
        } catch (const InputError& error) {
            EXPECT_NE(std::string{error.what()}.find(file.path() + ": cannot be read from byte "), std::string::npos) << error.what();
        }
    }
}

TEST(MappedFileDeathTest, WhatElseRaisesTheSignalEndsTheProcess)
{
    const CutFile file;
    const MappedFile map{file.path()};
    EXPECT_EXIT(std::raise(SIGBUS), ::testing::KilledBySignal(SIGBUS), "");
}

}  // namespace
}  // namespace fastccd::testing
