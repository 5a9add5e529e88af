#include "report.hpp"

#include <cerrno>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "../input_error.hpp"
#include "../mapped_file.hpp"
#include "../new_folder.hpp"
#include "../output_file.hpp"
#include "../threads.hpp"
#include "machine.hpp"
#include "page.hpp"
#include "parts.hpp"
#include "pictures.hpp"

namespace fastccd::tools::report {
namespace {

namespace fs = std::filesystem;

/// The folder for the files.
class OutputFolder {
public:
    explicit OutputFolder(const fs::path& path) : path_{path}, folder_{path}
    {
        // Hours of measuring shall not end at it.
        if (::access(path_.c_str(), W_OK | X_OK) != 0)
            throw InputError(path_, "cannot be written into: " + std::generic_category().message(errno));
    }

    /// Files by name, all under their names or none unless the disk fails in between; the last one comes last.
    void write(const std::vector<std::pair<std::string, std::string>>& contents) const
    {
        std::deque<OutputFile> files;
        for (const auto& [name, text] : contents) {
            files.emplace_back(path_ / name).write(text);
            files.back().close();
        }
        for (OutputFile& file : files) file.commit();
    }

private:
    fs::path path_;
    NewFolder folder_;
};

Json measure(const ReportOptions& options)
{
    Plan plan;
    plan.quick = options.quick;
    plan.pairs = options.pairs != 0 ? options.pairs : options.quick ? 1'000'000 : 10'000'000;
    if (!options.data.empty()) {
        plan.data = options.data;
        check_hard_cases(*plan.data);
        check_scenes(*plan.data);
    }
    ReportProgress progress{!options.quiet};
    Json json{{"format", 1},
              {"machine", machine()},
              {"quick", plan.quick},
              {"pairs", plan.pairs},
              {"public_data", plan.data.has_value()}};
    const auto add = [&](const char* key, const char* place, double share, Json (*part)(const Plan&, ReportProgress&)) {
        progress.begin(place, share);
        json["seconds"][key] = seconds_of([&] { json[key] = part(plan, progress); });
    };
    add("paper_table", "1 of 5, the paper's table", 0.25, paper_table);
    add("speed_and_error", "2 of 5, speed against error", 0.35, speed_and_error);
    add("hard_cases", "3 of 5, hard cases", 0.1, hard_cases);
    add("scenes", "4 of 5, scenes", 0.2, scenes);
    add("scaling", "5 of 5, scaling", 0.1, scaling);
    return json;
}

Json read_json(const fs::path& path)
{
    const MappedFile file{path};
    Json json = file.parsed([](std::string_view text) { return Json::parse(text, nullptr, false); });
    if (!json.is_object() || !json.contains("format") || json["format"] != 1) {
        throw InputError(path, "is no report.json of this version");
    }
    return json;
}

}  // namespace

void write_report(const ReportOptions& options)
{
    const OutputFolder folder{options.out};
    Json json;
    const auto json_file = [&] {
        return std::pair<std::string, std::string>{"report.json", json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"};
    };
    if (options.draw.empty()) {
        on_threads(0, [&] { json = measure(options); });
        folder.write({json_file()});  // whatever becomes of the drawing
    } else {
        json = read_json(options.draw);
    }
    std::vector<std::pair<std::string, std::string>> files;
    try {
        const std::vector<Picture> pictures = draw_pictures(json);
        for (const Picture& picture : pictures) files.emplace_back(picture.name + ".svg", picture.svg);
        files.push_back(json_file());
        files.emplace_back("report.html", html_page(json, pictures));
    } catch (const Json::exception& error) {
        if (options.draw.empty()) throw;
        throw InputError(options.draw, std::string{"is no report.json of this version: "} + error.what());
    }
    folder.write(files);
}

}  // namespace fastccd::tools::report
