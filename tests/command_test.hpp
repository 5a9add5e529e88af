// Runs the built command as a user does.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "amount.hpp"

namespace fastccd::testing {

using Arguments = std::vector<std::string>;

/// An empty directory that goes with the object, contents included.
class ScratchDirectory {
public:
    ScratchDirectory()
    {
        std::string name = (std::filesystem::temp_directory_path() / "fastccd_command_XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch directory");
        path_ = name;
    }
    ~ScratchDirectory()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchDirectory(const ScratchDirectory&) = delete;
    ScratchDirectory& operator=(const ScratchDirectory&) = delete;

    [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }

    /// Creates a file.
    std::string write(const std::string& name, const std::string& contents) const
    {
        std::ofstream{path_ / name, std::ios::binary} << contents;
        return *this / name;
    }

    /// Names of all files in it.
    [[nodiscard]] std::vector<std::string> names() const
    {
        std::vector<std::string> all;
        for (const auto& entry : std::filesystem::directory_iterator{path_}) all.push_back(entry.path().filename());
        return all;
    }

private:
    std::filesystem::path path_;
};

inline std::string read_text(const std::string& path)
{
    std::ifstream in{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

/// How a run of the command ended. A signal n gives status 1000 + n.
struct Outcome {
    int status = 0;
    std::string out;
    std::string error;
    long peak_kilobytes = 0;  ///< Largest resident size.
};

inline int exit_status(int wait_status)
{
    return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 1000 + WTERMSIG(wait_status);
}

/// Replaces the calling process, a fresh child, by the command. Does not return.
[[noreturn]] inline void become_command(const Arguments& arguments)
{
    std::vector<char*> pointers{const_cast<char*>(FASTCCD_COMMAND)};
    for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    ::execv(FASTCCD_COMMAND, pointers.data());
    ::_exit(127);
}

/// Where standard output of the command goes instead of Outcome::out.
struct OutputTo {
    std::string path = {};  ///< This file; empty: Outcome::out.
    bool closed = false;    ///< It is not open at all.
    bool no_reader = false; ///< A pipe whose reading end is closed.
};

/// Runs the command with `arguments`, `environment` ("NAME=VALUE") added.
inline Outcome run(const Arguments& arguments, const std::vector<std::string>& environment = {},
                   const OutputTo& to = {})
{
    const ScratchDirectory scratch;
    const std::string out = to.path.empty() ? scratch / "out" : to.path;
    const std::string error = scratch / "error";
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot fork");
    if (child == 0) {
        int descriptor = ::open(out.c_str(), O_WRONLY | O_CREAT, 0600);
        if (to.no_reader) {
            int ends[2];
            if (::pipe(ends) != 0) ::_exit(127);
            ::close(ends[0]);
            descriptor = ends[1];
        }
        ::dup2(::open(error.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        ::dup2(descriptor, STDOUT_FILENO);
        if (to.closed) ::close(STDOUT_FILENO);
        ::unsetenv("FASTCCD_ISA");
        for (const std::string& setting : environment) ::putenv(const_cast<char*>(setting.c_str()));
        become_command(arguments);
    }
    int status = 0;
    rusage usage{};
    if (::wait4(child, &status, 0, &usage) != child) throw std::runtime_error("cannot wait");
    return {.status = exit_status(status),
            .out = to.path.empty() ? read_text(out) : std::string{},
            .error = read_text(error),
            .peak_kilobytes = usage.ru_maxrss};
}

/// Runs under a limit that only the command has.
inline Outcome run_limited(int resource, rlim_t limit, const Arguments& arguments)
{
    rlimit before{};
    ::getrlimit(static_cast<__rlimit_resource>(resource), &before);
    const rlimit less{.rlim_cur = limit, .rlim_max = before.rlim_max};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &less);
    const Outcome outcome = run(arguments);
    ::setrlimit(static_cast<__rlimit_resource>(resource), &before);
    return outcome;
}

/// The report of a run that has to succeed.
inline nlohmann::json run_json(Arguments arguments)
{
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return nlohmann::json::parse(outcome.out);
}

/// The rows of a hits file without its header.
inline std::string rows(const std::string& path)
{
    const std::string text = read_text(path);
    EXPECT_EQ(text.rfind("pair,toi\n", 0), 0U) << text.substr(0, 40);
    return text.substr(std::min(text.size(), text.find('\n') + 1));
}

}  // namespace fastccd::testing
