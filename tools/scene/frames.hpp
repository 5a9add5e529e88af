// The frames of a scene, one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "broad_phase.hpp"

namespace fastccd::tools {

/// Two or more mesh files that hold the same faces and lines over the same number of vertices. Two frames are in
/// memory at a time; frames k and k + 1 are step k.
class Frames {
public:
    /// Reads the first of `paths`, and checks that all others are there. Throws InputError.
    explicit Frames(std::vector<std::string> paths);

    /// Reads the next frame; the step to it from the one before, valid until the next call. To be called
    /// step_count() times. Throws InputError when the frame cannot be read, or is of another mesh.
    [[nodiscard]] Step next_step();

    [[nodiscard]] std::size_t step_count() const { return paths_.size() - 1; }
    [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }
    [[nodiscard]] std::size_t vertex_count() const { return end_.size() / 3; }
    [[nodiscard]] const std::vector<std::int32_t>& faces() const { return faces_; }
    [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }

private:
    std::vector<std::string> paths_;
    std::size_t frames_read_ = 0;
    std::vector<double> start_;  // positions at both ends of the current step
    std::vector<double> end_;
    std::vector<std::int32_t> faces_;
    std::vector<Edge> lines_;
    std::vector<Edge> edges_;
};

}  // namespace fastccd::tools
