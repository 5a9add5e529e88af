// One report, made once for all tests that look at it.
#pragma once

#include <string>

#include "command_test.hpp"

namespace fastccd::testing {

/// Pairs of the report: more than of any family of hard pairs, and few enough for seconds; with sanitizers, for a minute.
inline constexpr std::size_t report_pairs = sanitized ? 100 : 20'000;

struct Report {
    ScratchDirectory directory;
    Outcome outcome;
    nlohmann::json json;
    std::string page;

    [[nodiscard]] std::string folder() const { return directory / "report"; }
    [[nodiscard]] std::string file(const std::string& name) const { return folder() + "/" + name; }
};

inline const Report& report()
{
    static Report r;
    static const bool made = [] {
        r.outcome = run({"report", "--quick", "--pairs", std::to_string(report_pairs), "--out", r.folder()});
        if (r.outcome.status != 0) throw std::runtime_error("fastccd report failed: " + r.outcome.error);
        r.json = nlohmann::json::parse(read_text(r.file("report.json")));
        r.page = read_text(r.file("report.html"));
        return true;
    }();
    if (!made) throw std::logic_error("no report");
    return r;
}

/// Names of the files in a folder, without the folder.
inline std::vector<std::string> files_in(const std::string& folder)
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{folder}) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
}

}  // namespace fastccd::testing
