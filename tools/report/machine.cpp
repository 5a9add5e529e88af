#include "machine.hpp"

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fastccd/isa.hpp>
#include <fastccd_commit.hpp>

#include "../common_options.hpp"

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
