// All steps of a scene: broad phase, narrow phase, contacts and pairs to files.
#pragma once

#include <string>
#include <vector>

#include "../common_options.hpp"
#include "scene_totals.hpp"

namespace fastccd::tools {

struct SceneOptions {
    CommonOptions common;
    std::vector<std::string> frames;
    std::string save_pairs;  ///< Folder for the candidates as .npy; empty: none.
};

/// Answers all candidates of all steps, with progress bar, hits and saved pairs, on the threads asked for.
/// Memory: two frames, the search trees over one and a list of the invalid vertices, whatever the number of
/// candidates. Throws InputError naming the file at fault, Interrupted after a signal; no file stays behind then.
[[nodiscard]] SceneTotals run_scene(const SceneOptions& options);

}  // namespace fastccd::tools
