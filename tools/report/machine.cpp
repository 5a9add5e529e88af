#include "machine.hpp"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fastccd/isa.hpp>
#include <fastccd_commit.hpp>

#include "../instruction_sets.hpp"

namespace fastccd::tools::report {
namespace {

std::string now()
{
    const std::time_t time = std::time(nullptr);
    std::tm utc{};
    ::gmtime_r(&time, &utc);
    return fmt::format("{}-{:02}-{:02} {:02}:{:02} UTC", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min);
}

std::string operating_system()
{
    std::ifstream release("/etc/os-release");
    for (std::string line; std::getline(release, line);) {
        if (line.starts_with("PRETTY_NAME=\"") && line.size() > 14) return line.substr(13, line.size() - 14);
    }
    utsname names{};
    return ::uname(&names) == 0 ? names.sysname : "unknown";
}

/// The least limit on memory of the control group at `path`, a line of /proc/self/cgroup, and of those it is in. Within a container the
/// path may be that outside of it, and only the root of what is mounted is the container's own.
std::size_t group_limit(const std::filesystem::path& mounted, const std::filesystem::path& path, const char* file)
{
    std::size_t least = std::numeric_limits<std::size_t>::max();
    std::filesystem::path group = mounted;
    const auto look = [&] {
        std::size_t limit = 0;
        if (std::ifstream{group / file} >> limit) least = std::min(least, limit);  // "max" is none
    };
    look();
    for (const std::filesystem::path& part : path.relative_path()) {
        group /= part;
        look();
    }
    return least;
}

}  // namespace

std::string processor()
{
    std::ifstream info("/proc/cpuinfo");
    std::string name, family, model;
    for (std::string line; std::getline(info, line) && !line.empty();) {
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos) continue;
        const std::string value = line.substr(colon + 2);
        if (line.starts_with("model name")) name = value;
        else if (line.starts_with("cpu family")) family = value;
        else if (line.starts_with("model")) model = value;
    }
    if (name.empty()) return "unknown";
    return family.empty() ? name : name + " (family " + family + ", model " + model + ")";
}

std::size_t system_memory()
{
    const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(size) : 0;
}

std::size_t allowed_memory()
{
    std::size_t allowed = system_memory();
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) allowed = std::min(allowed, static_cast<std::size_t>(limit.rlim_cur));
    std::ifstream groups("/proc/self/cgroup");  // number:controllers:path
    for (std::string line; std::getline(groups, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
        if (controllers.empty()) allowed = std::min(allowed, group_limit("/sys/fs/cgroup", path, "memory.max"));
        if (controllers == "memory") allowed = std::min(allowed, group_limit("/sys/fs/cgroup/memory", path, "memory.limit_in_bytes"));
    }
    return allowed;
}

std::size_t resident_memory()
{
    std::ifstream status("/proc/self/statm");
    std::size_t all = 0, resident = 0;
    status >> all >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

Json machine()
{
    Json isas = Json::array();
    for (const Isa isa : all_isas) {
        if (isa_available(isa)) isas.push_back(name(isa));
    }
    double load = 0;
    if (::getloadavg(&load, 1) != 1) load = 0;
    return {{"processor", processor()},
            {"threads", std::thread::hardware_concurrency()},
            {"memory_bytes", system_memory()},
            {"system", operating_system()},
            {"load_average", load},
#if defined(__clang__)
            {"compiler", __VERSION__},
#else
            {"compiler", "g++ " __VERSION__},
#endif
            {"flags", FASTCCD_BUILD_FLAGS},
            {"isas", std::move(isas)},
            {"best_isa", name(best_isa())},
            {"commit", FASTCCD_COMMIT},
            {"date", now()}};
}

}  // namespace fastccd::tools::report
