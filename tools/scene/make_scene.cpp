#include "make_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <deque>
#include <initializer_list>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "../new_folder.hpp"
#include "../output_file.hpp"

namespace fastccd::tools {
namespace {

constexpr double half_side = 3.0;       // of the cloth; the ball has radius 1 and its centre at 0
constexpr double fall_height = 0.5;     // of the flat cloth above the ball at the beginning
constexpr double fall_share = 0.25;     // of the whole time, before the cloth touches the ball
constexpr double final_grip = 0.9;      // tan(half the angle from the pole down to which it clings)
constexpr unsigned folds = 6;           // around the ball
constexpr double fold_depth = 0.3;      // radially, at great length
constexpr double fold_overturn = 10.0;  // folds close on each other where this times fade > 4.6
constexpr double clearance = 0.01;      // mean distance of the clinging cloth from the ball
constexpr double ripple_height = 0.08;  // more than the clearance: ripples dip into the ball
constexpr double widths_per_step =
    4.0;  // distance in triangle widths that the fastest part may move
constexpr double greatest_speed = 10.0;  // of any vertex, per whole time

// A point of the unit circle is a complex number here: products add angles, powers multiply them,
// and no sine or cosine, which differ between mathematics libraries, is ever needed.
struct Rotation {
    double cosine = 1;
    double sine = 0;
};

Rotation operator*(Rotation a, Rotation b)
{
    return {a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
}

/// The angle whose half has the tangent `t`.
Rotation rotation_from_half_tangent(double t)
{
    const double square = t * t;
    return {(1 - square) / (1 + square), 2 * t / (1 + square)};
}

Rotation power(Rotation rotation, unsigned exponent)
{
    Rotation result;
    for (; exponent != 0; exponent /= 2) {
        if (exponent % 2 == 1) result = result * rotation;
        rotation = rotation * rotation;
    }
    return result;
}

/// The cloth at one instant: a surface of revolution, flat above the ball or clinging to it from
/// the pole down to some angle and hanging along the tangent from there, with ripples and folds.
class Drape {
public:
    /// `progress`: 0 at the beginning, 1 at the end. `phase`: where the ripples are.
    Drape(double progress, Rotation phase) : phase_(phase)
    {
        const double fallen = std::min(progress / fall_share, 1.0);
        height_ = fall_height * (1 - fallen * fallen);
        const double draped = std::max(progress - fall_share, 0.0) / (1 - fall_share);
        grip_ = final_grip * draped;
        overturn_ = draped * fold_overturn;
        edge_ = rotation_from_half_tangent(grip_);
    }

    /// Where the point of the cloth is that lies at (x, y) while the cloth is flat.
    [[nodiscard]] std::array<double, 3> at(double x, double y) const
    {
        const double r = std::sqrt(x * x + y * y);
        const Rotation azimuth = r > 0 ? Rotation{x / r, y / r} : Rotation{};
        const Rotation wave = power(azimuth, folds);

        // Angle from the pole, up to the edge of the clinging part, and the length that hangs
        // below.
        const double half_tangent = 0.5 * r;
        const double hanging = std::max(r - 2 * grip_, 0.0);
        const Rotation polar = hanging > 0 ? edge_ : rotation_from_half_tangent(half_tangent);

        const double ripple =
            ripple_height * (wave * phase_).cosine * half_tangent / (1 + half_tangent);
        const double distance = 1 + (clearance + ripple) / (1 + 4 * hanging * hanging);
        double radius = distance * polar.sine + hanging * polar.cosine;
        const double z = distance * polar.cosine - hanging * polar.sine + height_;

        // The folds: a wave in radius, overturned by a shift along the circle at twice its
        // frequency.
        const double fade = hanging / (1 + hanging) * edge_.sine;
        const double shift =
            overturn_ * fade * radius / (2 * folds) * (2 * wave.sine * wave.cosine);
        radius += fold_depth * fade * wave.cosine;
        return {radius * azimuth.cosine - shift * azimuth.sine,
                radius * azimuth.sine + shift * azimuth.cosine, z};
    }

private:
    Rotation phase_;
    Rotation edge_;  // angle from the pole down to which the cloth clings
    double height_;
    double grip_;
    double overturn_;
};

void append_cloth_faces(int size, std::vector<std::int32_t>& faces)
{
    for (std::int32_t row = 0; row + 1 < size; ++row) {
        for (std::int32_t column = 0; column + 1 < size; ++column) {
            const std::int32_t a = row * size + column;
            const std::int32_t b = a + 1;
            const std::int32_t c = a + size;
            const std::int32_t d = c + 1;
            // Diagonals alternate, so that the cloth has no preferred direction.
            if ((row + column) % 2 == 0) {
                faces.insert(faces.end(), {a, b, d, a, d, c});
            } else {
                faces.insert(faces.end(), {a, b, c, b, d, c});
            }
        }
    }
}

/// An octahedron with `n` segments on each edge, projected on the unit sphere: 4 n^2 + 2 vertices
/// and 8 n^2 faces, outward. Vertices come in rings |x| + |y| = n - |z| of the lattice, z from n
/// down to -n.
class Octasphere {
public:
    explicit Octasphere(std::int32_t n) : n_(n) {}

    [[nodiscard]] std::vector<double> positions() const
    {
        std::vector<double> positions;
        for (std::int32_t z = n_; z >= -n_; --z) {
            const std::int32_t side = n_ - std::abs(z);
            if (side == 0) append(positions, 0, 0, z);
            for (std::int32_t i = 0; i < side; ++i) append(positions, side - i, i, z);
            for (std::int32_t i = 0; i < side; ++i) append(positions, -i, side - i, z);
            for (std::int32_t i = 0; i < side; ++i) append(positions, i - side, -i, z);
            for (std::int32_t i = 0; i < side; ++i) append(positions, i, i - side, z);
        }
        return positions;
    }

    void append_faces(std::int32_t first_vertex, std::vector<std::int32_t>& faces) const
    {
        for (const bool south : {false, true}) {
            const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
                if (south) std::swap(b, c);  // the mirror image turns the other way round
                for (const std::int32_t vertex : {a, b, c}) faces.push_back(first_vertex + vertex);
            };
            for (std::int32_t side = 0; side < n_; ++side) {
                for (std::int32_t quadrant = 0; quadrant < 4; ++quadrant) {
                    for (std::int32_t i = 0; i <= side; ++i) {
                        const std::int32_t inner = index(south, side, quadrant * side + i);
                        const std::int32_t outer =
                            index(south, side + 1, quadrant * (side + 1) + i);
                        const std::int32_t outer_next =
                            index(south, side + 1, quadrant * (side + 1) + i + 1);
                        add(inner, outer, outer_next);
                        if (i < side)
                            add(inner, outer_next, index(south, side, quadrant * side + i + 1));
                    }
                }
            }
        }
    }

private:
    static void append(std::vector<double>& positions, std::int32_t x, std::int32_t y,
                       std::int32_t z)
    {
        const double length = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        for (const std::int32_t coordinate : {x, y, z}) positions.push_back(coordinate / length);
    }

    /// Vertex `i`, counted around and around, of the ring with `side` vertices a quadrant.
    [[nodiscard]] std::int32_t index(bool south, std::int32_t side, std::int32_t i) const
    {
        if (side == 0) return south ? 4 * n_ * n_ + 1 : 0;
        const std::int32_t in_ring = i % (4 * side);
        if (south && side < n_) return 4 * n_ * n_ + 1 - 2 * side * (side + 1) + in_ring;
        return 1 + 2 * side * (side - 1) + in_ring;
    }

    std::int32_t n_;
};

/// Frames of a scene made earlier would be taken for a part of this one, and other meshes too.
void refuse_frames_left_over(int frames, const std::filesystem::path& out_dir)
{
    std::set<std::string> own;
    for (int frame = 0; frame < frames; ++frame) own.insert(frame_name(frame, frames));
    std::error_code error;
    std::filesystem::directory_iterator entry(out_dir, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::filesystem::path& path = entry->path();
        if (!named_as_mesh(path) || own.contains(path.filename().string())) continue;
        throw InputError(
            path,
            "is a frame of another scene, which this one would be mixed up with; name an empty "
            "directory");
    }
    if (error)
        throw InputError(out_dir, fmt::format("the directory cannot be read: {}", error.message()));
}

}  // namespace

ClothBall::ClothBall(int size, int frames) : size_(size), frames_(frames)
{
    if (size < 2 || size > 4096) {
        throw std::invalid_argument(
            fmt::format("a cloth of size {} cannot be made; sizes are 2 to 4096", size));
    }
    if (frames < 1 || frames > 100000) {
        throw std::invalid_argument(
            fmt::format("{} frames cannot be made; 1 to 100000 can", frames));
    }
    append_cloth_faces(size, faces_);
    // The ball's triangles about as wide as the cloth's: a quarter of its girth against the side.
    const Octasphere ball(std::max(2, (size - 1) / 4));
    ball_ = ball.positions();
    ball.append_faces(cloth_vertices(), faces_);
}

double ClothBall::progress(int frame) const
{
    if (frames_ == 1) return 1;
    const double width = 2 * half_side / (size_ - 1);
    const double step = std::min(1.0 / (frames_ - 1), widths_per_step * width / greatest_speed);
    return std::max(1 - (frames_ - 1 - frame) * step, 0.0);
}

std::vector<double> ClothBall::positions(int frame) const
{
    // Both turn by a fixed angle a frame; 4/5 and 3/5 are an exact point of the unit circle.
    const auto turns = static_cast<unsigned>(frame);
    const Drape drape(progress(frame), power({0.8, 0.6}, turns));
    const Rotation spin = power(rotation_from_half_tangent(1.0 / 64), turns);

    std::vector<double> positions;
    positions.reserve(3 * static_cast<std::size_t>(cloth_vertices()) + ball_.size());
    const auto coordinate = [this](int i) { return half_side * (2.0 * i / (size_ - 1) - 1); };
    for (int row = 0; row < size_; ++row) {
        for (int column = 0; column < size_; ++column) {
            const std::array<double, 3> point = drape.at(coordinate(column), coordinate(row));
            positions.insert(positions.end(), point.begin(), point.end());
        }
    }
    for (std::size_t i = 0; i < ball_.size(); i += 3) {
        const Rotation turned = Rotation{ball_[i], ball_[i + 1]} * spin;
        positions.insert(positions.end(), {turned.cosine, turned.sine, ball_[i + 2]});
    }
    return positions;
}

std::string frame_name(int frame, int frames)
{
    const std::size_t digits = std::max<std::size_t>(3, std::to_string(frames - 1).size());
    return fmt::format("frame_{:0{}}.ply", frame, digits);
}

void make_cloth_ball(int size, int frames, const std::filesystem::path& out_dir,
                     const std::function<void()>& on_frame)
{
    const ClothBall scene(size, frames);
    const NewFolder folder(out_dir);
    refuse_frames_left_over(frames, out_dir);

    Mesh mesh{.faces = scene.faces()};
    std::deque<OutputFile> files;  // after the folder: gone before it is found empty
    for (int frame = 0; frame < frames; ++frame) {
        mesh.positions = scene.positions(frame);
        write_ply(files.emplace_back(out_dir / frame_name(frame, frames)), mesh);
        files.back().close();
        if (on_frame) on_frame();
    }
    for (OutputFile& file : files) file.commit();
}

}  // namespace fastccd::tools
