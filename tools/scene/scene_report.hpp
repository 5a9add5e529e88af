// What was found in a scene, for people and for programs.
#pragma once

#include <string>

#include "scene_run.hpp"

namespace fastccd::tools {

/// A row for each kind in each step, then the totals; newline at the end.
[[nodiscard]] std::string scene_text_report(const SceneOptions& options, const SceneTotals& totals);

/// One JSON object on one line, newline at the end; an `earliest` that does not exist is null.
[[nodiscard]] std::string scene_json_report(const SceneOptions& options, const SceneTotals& totals);

/// Prints the report that `options` ask for on standard output, or on standard error if --hits takes
/// that; vertices left out are named on standard error in any case. Throws as write_all.
void print_scene_report(const SceneOptions& options, const SceneTotals& totals);

}  // namespace fastccd::tools
