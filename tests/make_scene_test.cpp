#include "tools/scene/make_scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/scene/broad_phase.hpp"

namespace fastccd::tools {
namespace {

namespace fs = std::filesystem;

using Vector = std::array<double, 3>;

Vector operator-(const Vector& a, const Vector& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector cross(const Vector& a, const Vector& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Contacts that no rounding can doubt, found by sampling: the vertex changes the side of the face's
// plane, and is well inside the face when it does.
class Crossing {
public:
    Crossing(const std::vector<double>& positions0, const std::vector<double>& positions1)
        : p0_(positions0), p1_(positions1)
    {
    }

    [[nodiscard]] bool certain(std::int32_t vertex, const std::int32_t* face) const
    {
        constexpr int samples = 8;
        double before = volume(vertex, face, 0);
        for (int i = 1; i <= samples; ++i) {
            const double after = volume(vertex, face, i / double{samples});
            if (before * after < 0) {
                double low = (i - 1) / double{samples};
                double high = i / double{samples};
                for (int step = 0; step < 40; ++step) {
                    const double middle = 0.5 * (low + high);
                    (volume(vertex, face, middle) * before > 0 ? low : high) = middle;
                }
                if (well_inside(vertex, face, low)) return true;
            }
            before = after;
        }
        return false;
    }

private:
    [[nodiscard]] Vector at(std::int32_t vertex, double t) const
    {
        const std::size_t i = 3 * static_cast<std::size_t>(vertex);
        Vector x;
        for (std::size_t axis = 0; axis < 3; ++axis)
            x[axis] = (1 - t) * p0_[i + axis] + t * p1_[i + axis];
        return x;
    }

    [[nodiscard]] double volume(std::int32_t vertex, const std::int32_t* face, double t) const
    {
        const Vector a = at(face[0], t);
        return dot(cross(at(face[1], t) - a, at(face[2], t) - a), at(vertex, t) - a);
    }

    [[nodiscard]] bool well_inside(std::int32_t vertex, const std::int32_t* face, double t) const
    {
        const Vector x = at(vertex, t);
        const std::array<Vector, 3> corners{at(face[0], t), at(face[1], t), at(face[2], t)};
        const Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector& a = corners[i];
            const Vector& b = corners[(i + 1) % 3];
            if (dot(cross(b - a, x - a), normal) < 0.01 * dot(normal, normal)) return false;
        }
        return true;
    }

    const std::vector<double>& p0_;
    const std::vector<double>& p1_;
};

struct Contacts {
    int with_ball = 0;
    int with_itself = 0;
};

Contacts count_contacts(const ClothBall& scene, int frame)
{
    const std::vector<double> positions0 = scene.positions(frame);
    const std::vector<double> positions1 = scene.positions(frame + 1);
    const Crossing crossing(positions0, positions1);
    Contacts contacts;
    for (const auto& [vertex, face] :
         vertex_face_candidates({positions0, positions1, scene.faces(), {}})) {
        const std::int32_t* const corners = &scene.faces()[3 * static_cast<std::size_t>(face)];
        if (!crossing.certain(vertex, corners)) continue;
        const bool vertex_of_cloth = vertex < scene.cloth_vertices();
        const bool face_of_cloth = corners[0] < scene.cloth_vertices();
        ++(vertex_of_cloth && face_of_cloth ? contacts.with_itself : contacts.with_ball);
    }
    return contacts;
}

class MakeScene : public testing::Test {
protected:
    MakeScene()
        : directory_(fs::temp_directory_path() /
                     ("fastccd_make_scene_" + std::to_string(::getpid())))
    {
    }
    ~MakeScene() override
    {
        std::error_code ignored;
        fs::remove_all(directory_, ignored);
    }

    fs::path directory_;
};

std::vector<fs::path> files_in(const fs::path& directory)
{
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(directory))
        files.push_back(entry.path().filename());
    std::sort(files.begin(), files.end());
    return files;
}

TEST_F(MakeScene, ClothTouchesBallInEveryStepAndItself)
{
    for (const int size : {20, 50}) {
        const ClothBall scene(size, 6);
        int with_itself = 0;
        for (int frame = 0; frame + 1 < scene.frames(); ++frame) {
            const Contacts contacts = count_contacts(scene, frame);
            EXPECT_GT(contacts.with_ball, 0) << "size " << size << ", frame " << frame;
            with_itself += contacts.with_itself;
        }
        EXPECT_GT(with_itself, 0) << "size " << size;
    }
}

TEST_F(MakeScene, BothSurfacesAreWhole)
{
    for (const int size : {2, 3, 17}) {
        const ClothBall scene(size, 2);
        const std::vector<std::int32_t>& faces = scene.faces();
        std::map<std::pair<std::int32_t, std::int32_t>, int> directed;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            ++directed[{faces[i], faces[i % 3 == 2 ? i - 2 : i + 1]}];
        }
        int cloth_border = 0;
        for (const auto& [edge, times] : directed) {
            EXPECT_EQ(times, 1) << "neighbours turn the same way round";
            if (directed.contains({edge.second, edge.first})) continue;
            EXPECT_LT(edge.first, scene.cloth_vertices()) << "the ball is closed";
            ++cloth_border;
        }
        EXPECT_EQ(cloth_border, 4 * (size - 1));

        const auto cloth_faces = static_cast<std::size_t>(2 * (size - 1) * (size - 1));
        const std::vector<double> positions = scene.positions(0);
        for (std::size_t i = 3 * cloth_faces; i < faces.size(); i += 3) {
            const auto corner = [&](std::size_t k) {
                const auto j = 3 * static_cast<std::size_t>(faces[i + k]);
                return Vector{positions[j], positions[j + 1], positions[j + 2]};
            };
            const Vector a = corner(0);
            EXPECT_NEAR(dot(a, a), 1, 1e-12);
            EXPECT_GT(dot(cross(corner(1) - a, corner(2) - a), a), 0) << "the ball faces outward";
        }
    }
}

TEST_F(MakeScene, CoversTheFallWhenThereAreFramesEnough)
{
    const ClothBall scene(10, 60);
    EXPECT_NEAR(scene.positions(0)[2], 1.5, 0.01) << "flat, half a radius above the ball";
    EXPECT_LT(scene.positions(59)[2], 0) << "corners hang below the middle of the ball";
}

TEST_F(MakeScene, NothingMovesFarInAStep)
{
    const int size = 40;
    for (const int frames : {2, 10, 100}) {
        const ClothBall scene(size, frames);
        for (int frame = 0; frame + 1 < frames; ++frame) {
            const std::vector<double> p0 = scene.positions(frame);
            const std::vector<double> p1 = scene.positions(frame + 1);
            double furthest = 0;
            for (std::size_t i = 0; i < p0.size(); i += 3) {
                furthest = std::max(furthest, std::hypot(p1[i] - p0[i], p1[i + 1] - p0[i + 1],
                                                         p1[i + 2] - p0[i + 2]));
            }
            EXPECT_LT(furthest, 5 * 6.0 / (size - 1)) << frames << " frames, step " << frame;
        }
    }
}

// The same bits on every machine is what the generator promises; this hash is of the positions that
// x86-64 with g++ 12 and -ffp-contract=off gave first. It may only change with the motion itself.
TEST_F(MakeScene, PositionsAreTheSameEverywhere)
{
    const ClothBall scene(12, 5);
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a over the coordinates' bits
    for (int frame = 0; frame < scene.frames(); ++frame) {
        for (const double coordinate : scene.positions(frame)) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x100000001b3;
        }
    }
    EXPECT_EQ(hash, 0x53288d393f98d661);
}

TEST_F(MakeScene, WritesFramesThatReadBack)
{
    const fs::path out = directory_ / "new" / "scene";
    make_cloth_ball(6, 3, out);
    EXPECT_EQ(files_in(out),
              (std::vector<fs::path>{"frame_000.ply", "frame_001.ply", "frame_002.ply"}));
    const ClothBall scene(6, 3);
    for (int frame = 0; frame < 3; ++frame) {
        const Mesh mesh = read_mesh(out / ("frame_00" + std::to_string(frame) + ".ply"));
        EXPECT_EQ(mesh.faces, scene.faces());
        EXPECT_EQ(mesh.positions, scene.positions(frame));
    }
    make_cloth_ball(7, 3, out);  // the same files, replaced
    EXPECT_EQ(read_mesh(out / "frame_002.ply").faces, ClothBall(7, 3).faces());
    EXPECT_THROW(make_cloth_ball(6, 2, out), InputError) << "frame_002.ply would be left over";
}

TEST_F(MakeScene, RefusesWhatItCannotMake)
{
    EXPECT_THROW(ClothBall(1, 3), std::invalid_argument);
    EXPECT_THROW(ClothBall(-5, 3), std::invalid_argument);
    EXPECT_THROW(ClothBall(5000, 3), std::invalid_argument);
    EXPECT_THROW(ClothBall(10, 0), std::invalid_argument);
    EXPECT_NO_THROW(ClothBall(2, 1));

    fs::create_directories(directory_);
    std::ofstream(directory_ / "file") << "in the way";
    EXPECT_THROW(make_cloth_ball(4, 2, directory_ / "file"), InputError);
}

}  // namespace
}  // namespace fastccd::tools
