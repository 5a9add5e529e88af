// Small scenes for tests of `fastccd scene`.
#pragma once

#include "command_test.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace fastccd::testing {

/// A large resting face, and above it a small one that points down with its tip at height `tip`.
inline std::string two_faces(const std::string& tip, const std::string& top)
{
    return "v -1 -1 0\nv 2 -1 0\nv -1 2 0\nv 0 0 " + tip + "\nv 0.1 0 " + top + "\nv 0 0.1 " + top +
           "\nf 1 2 3\nf 4 5 6\n";
}

/// The paths of all files in a folder, in order.
inline std::vector<std::string> files_in(const std::string& folder)
{
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::directory_iterator{folder}) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

/// `scene` over these frames.
inline Arguments scene(const std::vector<std::string>& frames, const Arguments& more = {})
{
    Arguments arguments{"scene"};
    arguments.insert(arguments.end(), frames.begin(), frames.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// Frames of the cloth and the ball.
inline std::vector<std::string> make_scene(const ScratchDirectory& directory, const std::string& size, const std::string& count)
{
    const std::string folder = directory / "cloth";
    EXPECT_EQ(run({"make-scene", "cloth-ball", "--size", size, "--frames", count, folder, "--quiet"}).status, 0);
    return files_in(folder);
}

}  // namespace fastccd::testing
