// Files that the command writes: what cannot come under its name is refused before any work, or kept.
#include "command_test.hpp"

#include <cstdio>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "input_error.hpp"
#include "output_file.hpp"

namespace fastccd::testing {
namespace {

/// What the error of opening it says; empty if there is none.
std::string refusal(const std::string& target)
{
    try {
        const tools::OutputFile file{target};
        return {};
    } catch (const tools::InputError& error) {
        return error.what();
    }
}

TEST(OutputFile, NamesThatNothingCanHaveAreRefusedAtOnce)
{
    const ScratchDirectory directory;
    EXPECT_EQ(refusal(directory / std::string(255, 'x')), "");
    const std::string too_long = directory / std::string(256, 'x');
    EXPECT_EQ(refusal(too_long), too_long + ": cannot be created: File name too long");
    EXPECT_TRUE(directory.names().empty());
}

std::string refusal_to_commit(tools::OutputFile& file)
{
    try {
        file.commit();
    } catch (const tools::InputError& error) {
        return error.what();
    }
    return "none";
}

/// The name may be taken while there is work, by a folder here. What is complete is not thrown away for that.
TEST(OutputFile, WhatIsCompleteStaysIfItCannotHaveItsName)
{
    const ScratchDirectory directory;
    const std::string target = directory / "hits.csv";
    std::string message;
    {
        tools::OutputFile file{target};
        file.write("all of it\n");
        std::filesystem::create_directory(target);
        message = refusal_to_commit(file);
    }
    std::filesystem::remove(target);
    ASSERT_EQ(directory.names().size(), 1U);
    const std::string kept = directory / directory.names().front();
    EXPECT_EQ(message, target + ": cannot be created: Is a directory; all that was to be in it is in " + kept);
    EXPECT_EQ(read_text(kept), "all of it\n");
}

TEST(OutputFile, SaysThatWhatWasCompleteIsGoneWithItsFolder)
{
    const ScratchDirectory directory;
    const std::string folder = directory / "folder";
    std::filesystem::create_directory(folder);
    tools::OutputFile file{folder + "/hits.csv"};
    std::filesystem::remove_all(folder);
    const std::string message = refusal_to_commit(file);
    EXPECT_EQ(message.rfind(folder + "/hits.csv: cannot be created: No such file or directory; all that was to be in it is lost, as somebody removed " +
                            folder + "/hits.csv.", 0), 0U) << message;
}

/// As a container has a single file that is mounted into it.
TEST(OutputFile, MountPointsAreRefusedAtOnce)
{
    const ScratchDirectory directory;
    const std::string target = directory.write("hits.csv", ""), other = directory.write("other.csv", "");
    constexpr int not_allowed = 77, as_said = 0, otherwise = 1;
    const ::pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {  // in a name space of its own, which ends with it
        if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) ::_exit(not_allowed);
        if (::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) ::_exit(not_allowed);
        if (::mount(other.c_str(), target.c_str(), nullptr, MS_BIND, nullptr) != 0) ::_exit(not_allowed);
        const std::string message = refusal(target);
        if (message == target + ": is a mount point, which no other file can replace; mount its folder instead") ::_exit(as_said);
        std::fprintf(stderr, "%s\n", message.c_str());
        ::_exit(otherwise);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (exit_status(status) == not_allowed) GTEST_SKIP() << "NOT TESTED: this system does not let the test mount a file";
    EXPECT_EQ(exit_status(status), as_said);
    EXPECT_EQ(directory.names().size(), 2U);
}

}  // namespace
}  // namespace fastccd::testing
