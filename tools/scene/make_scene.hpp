// Scenes for users without data of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mesh_io.hpp"

namespace fastccd::tools {

/// A square cloth that falls on a spinning ball of radius 1, drapes over it, ripples on its surface
/// and hangs down in folds that close on each other. Procedural motion, no physics: cloth passes
/// into the ball and through itself, so that most steps have contacts of both kinds and of every
/// sort, cloth against ball and cloth against cloth.
///
/// Only + - * / and square root enter the positions: they are the same bits on every IEEE 754
/// machine if the build does not contract expressions (-ffp-contract=off).
class ClothBall {
public:
    /// A cloth of size x size vertices and 2 (size - 1)^2 triangles, a ball of like resolution.
    /// size in [2, 4096], frames in [1, 100000]. Throws std::invalid_argument.
    ClothBall(int size, int frames);

    /// Positions of frame 0 <= `frame` < frames: n x 3, row-major, cloth before ball.
    [[nodiscard]] std::vector<double> positions(int frame) const;

    /// m x 3, row-major; the same in all frames.
    [[nodiscard]] const std::vector<std::int32_t>& faces() const { return faces_; }

    [[nodiscard]] int frames() const { return frames_; }
    [[nodiscard]] int cloth_vertices() const { return size_ * size_; }

private:
    [[nodiscard]] double progress(int frame) const;

    int size_;
    int frames_;
    std::vector<double> ball_;  // positions of the ball before it spins, n x 3
    std::vector<std::int32_t> faces_;
};

/// File name of a frame: frame_000.ply and so on, with as many digits as put all `frames` names in order.
[[nodiscard]] std::string frame_name(int frame, int frames);

/// Writes the frames of ClothBall as OUT_DIR/frame_000.ply, frame_001.ply and so on: binary PLY,
/// double. The directory is created if need be. `on_frame`, if given, is called after each frame.
///
/// With many frames the whole motion is covered; otherwise its end, where the contacts are, in
/// steps of a few widths of a triangle, as a simulation would take them.
///
/// Throws std::invalid_argument as ClothBall does, InputError when a file cannot be written or
/// the directory holds frames that this scene does not replace, and what `on_frame` throws. Frames appear
/// when all are written: in the end all are there, or what was there before.
void make_cloth_ball(int size, int frames, const std::filesystem::path& out_dir,
                     const std::function<void()>& on_frame = {});

}  // namespace fastccd::tools
