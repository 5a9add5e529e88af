// Scenes in which most contacts are at a side, at an end, or within one plane are decided by lanes (kernels/touching.hpp), with the same bits
// as by the search, which would take a microsecond or two for each.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "amount.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

/// A mesh at both ends of the step.
struct Scene {
    std::vector<double> start, end;
    std::vector<std::int32_t> faces, edges;

    [[nodiscard]] MovingMesh mesh() const
    {
        const std::size_t vertices = start.size() / 3;
        return {PositionView::rows(start.data(), vertices), PositionView::rows(end.data(), vertices),
                IndexView::rows(faces.data(), faces.size() / 3, 3), IndexView::rows(edges.data(), edges.size() / 2, 2)};
    }
};

/// Two square grids of points, turned and moved.
struct Grid : Scene {
    int side;

    /// Two of them, the upper one, moved by `shift` along its rows, falls through the lower one; `turn` about the vertical axis.
    Grid(int points, double turn, double shift, double fall, bool single) : side{points}
    {
        for (int sheet = 0; sheet < 2; ++sheet) {
            const auto base = static_cast<std::int32_t>(sheet * side * side);
            for (int i = 0; i < side; ++i)
                for (int j = 0; j < side; ++j) {
                    const auto put = [&](std::vector<double>& to, double x) { to.push_back(single ? static_cast<float>(x) : x); };
                    const double row = i + sheet * shift;
                    const double x = std::cos(turn) * row - std::sin(turn) * j, y = std::sin(turn) * row + std::cos(turn) * j;
                    for (std::vector<double>* ends : {&start, &end}) {
                        put(*ends, x);
                        put(*ends, y);
                        put(*ends, sheet == 0 ? 0.0 : ends == &start ? 1.0 : 1.0 - fall);
                    }
                    const std::int32_t k = base + i * side + j;
                    if (i + 1 < side) edges.insert(edges.end(), {k, k + side});
                    if (j + 1 < side) edges.insert(edges.end(), {k, k + 1});
                    if (i + 1 < side && j + 1 < side) {
                        edges.insert(edges.end(), {k + 1, k + side});
                        faces.insert(faces.end(), {k, k + 1, k + side, k + 1, k + side + 1, k + side});
                    }
                }
        }
    }
};

/// A wall of bricks, each row on the joints of the one below, in any direction of space.
struct Wall : Scene {
    static constexpr int rows = 6, bricks_per_row = 6, corners = 8;

    /// Turned about two axes; all that `at_end` does is move the points of a row.
    Wall(double turn, auto at_end)
    {
        for (int row = 0; row < rows; ++row)
            for (int brick = 0; brick < bricks_per_row; ++brick) add_brick(row, brick + 0.5 * (row % 2), turn, at_end);
    }

    [[nodiscard]] bool next_to_each_other(std::int32_t v, std::int32_t w) const
    {
        const int a = v / corners, b = w / corners;
        return a != b && std::abs(a / bricks_per_row - b / bricks_per_row) <= 1 && std::abs(a % bricks_per_row - b % bricks_per_row) <= 1;
    }

private:
    void add_brick(int row, double left, double turn, auto at_end)
    {
        const auto first = static_cast<std::int32_t>(start.size() / 3);
        for (int corner = 0; corner < corners; ++corner) {
            const std::array<double, 3> point{left + (corner & 1), 0.75 * (corner >> 1 & 1), 0.5 * (row + (corner >> 2 & 1))};
            put(start, point, turn);
            put(end, at_end(row, point), turn);
            for (const int other : {corner | 1, corner | 2, corner | 4})
                if (other != corner) edges.insert(edges.end(), {first + corner, first + other});
        }
        for (const auto& [a, b, c, d] : {std::array{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
            faces.insert(faces.end(), {first + a, first + b, first + c, first + a, first + c, first + d});
            edges.insert(edges.end(), {first + a, first + c});
        }
    }

    static void put(std::vector<double>& to, const std::array<double, 3>& point, double turn)
    {
        const double c = std::cos(turn), s = std::sin(turn), y = c * point[1] - s * point[2];
        to.insert(to.end(), {c * point[0] - s * y, s * point[0] + c * y, s * point[1] + c * point[2]});
    }
};

/// Of the upper sheet against what begins in the same cell of the lower one or next to it, by the first vertex of primitive i.
template <class Pair>
std::vector<Pair> neighbours(const Grid& grid, std::size_t first_begin, std::size_t first_end, std::size_t second_end, auto first_vertex,
                             auto second_vertex)
{
    std::vector<Pair> pairs;
    const int sheet = grid.side * grid.side;
    for (std::size_t a = first_begin; a < first_end; ++a)
        for (std::size_t b = 0; b < second_end; ++b) {
            const int v = first_vertex(a) - sheet, w = second_vertex(b);
            if (v < 0 || w >= sheet) continue;
            if (std::abs(v / grid.side - w / grid.side) > 1 || std::abs(v % grid.side - w % grid.side) > 1) continue;
            pairs.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
        }
    return pairs;
}

/// But for this share of the contacts, and one in a hundred pairs at most.
template <class Pairs>
void expect_no_search(const Scene& scene, const Pairs& pairs, double share, double tolerance, double t_max, const std::string& what)
{
    Options options;
    options.tolerance = tolerance;
    options.t_max = t_max;
    options.reference = true;
    std::vector<double> expected(pairs.size()), found(pairs.size());
    const MovingMesh mesh = scene.mesh();
    Summary searched, summary;
    ASSERT_TRUE(time_of_impact(mesh, pairs, options, expected, &searched).ok());
    EXPECT_GT(searched.contacts, pairs.size() / 16) << what;
    options.reference = false;
    for (const Isa isa : isas_to_test()) {
        options.isa = isa;
        ASSERT_TRUE(time_of_impact(mesh, pairs, options, found, &summary).ok());
        EXPECT_EQ(0, std::memcmp(expected.data(), found.data(), found.size() * sizeof(double))) << what << ' ' << name(isa);
        EXPECT_EQ(searched.proven, summary.proven) << what << ' ' << name(isa);
        EXPECT_LE(100 * summary.scalar_pairs, pairs.size()) << what << ' ' << name(isa) << ": of " << searched.contacts << " contacts";
        EXPECT_LE(static_cast<double>(summary.scalar_pairs), share * static_cast<double>(searched.contacts)) << what << ' ' << name(isa) << ": of " << searched.contacts << " contacts";
    }
}

/// Each of these contacts is at a side, an end, or along a whole edge: a microsecond each, if they were left to the search.
TEST(Touching, MeshesOnOneGridAreDecidedByLanes)
{
    struct Place {
        double turn, shift;
    };
    for (const bool single : {false, true})
        for (const auto& [turn, shift] : {Place{0.0, 0.0}, {0.3, 0.0}, {0.0, 0.5}, {0.0, 0.25}})
            for (const double fall : {2.0, 1.7})  // at 0.5, between two leaves, and anywhere
                for (const double tolerance : {1e-6, 1e-9, 1e-12})
                    for (const double t_max : {1.0, 0.9}) {
                        const Grid grid{12, turn, shift, fall, single};
                        const std::string what = "turn " + std::to_string(turn) + ", shift " + std::to_string(shift) + ", fall " +
                                                 std::to_string(fall) + ", E_tol " + std::to_string(std::log10(tolerance)) + ", t_max " +
                                                 std::to_string(t_max);
                        const auto sheet = static_cast<std::size_t>(grid.side * grid.side);
                        const auto edge_start = [&](std::size_t e) { return grid.edges[2 * e]; };
                        const auto vf = neighbours<VertexFace>(grid, sheet, 2 * sheet, grid.faces.size() / 3,
                                                               [](std::size_t v) { return static_cast<int>(v); },
                                                               [&](std::size_t f) { return grid.faces[3 * f]; });
                        const auto ee = neighbours<EdgeEdge>(grid, 0, grid.edges.size() / 2, grid.edges.size() / 2, edge_start, edge_start);
                        expect_no_search(grid, vf, 0.02, tolerance, t_max, "vertex-face " + what);
                        expect_no_search(grid, ee, 0.02, tolerance, t_max, "edge-edge " + what);
                    }
}

/// Surfaces in contact from the start on, over faces and along edges; where they are turned, a contact or none by rounding, and
/// edges in line but for rounding.
TEST(Touching, BricksOnOneAnotherAreDecidedByLanes)
{
    using Point = std::array<double, 3>;
    const auto rest = [](int, const Point& point) { return point; };
    const auto move = [](int, const Point& point) { return Point{point[0] + 0.1, point[1] + 0.03, point[2] + 0.01}; };
    const auto slide = [](int row, const Point& point) { return Point{point[0] + 0.13 * (row % 3), point[1], point[2]}; };
    const auto press = [](int row, const Point& point) { return Point{point[0], point[1], point[2] - 0.001 * row}; };
    for (const double turn : {0.0, 0.3})
        for (const auto& [how, wall] : {std::pair{"at rest", Wall{turn, rest}}, {"moved", Wall{turn, move}}, {"sliding", Wall{turn, slide}},
                                        {"pressed", Wall{turn, press}}}) {
            std::vector<VertexFace> vf;
            std::vector<EdgeEdge> ee;
            for (std::int32_t v = 0; 3 * v < std::ssize(wall.start); ++v)
                for (std::int32_t f = 0; 3 * f < std::ssize(wall.faces); ++f)
                    if (wall.next_to_each_other(v, wall.faces[static_cast<std::size_t>(3 * f)])) vf.push_back({v, f});
            for (std::int32_t a = 0; 2 * a < std::ssize(wall.edges); ++a)
                for (std::int32_t b = 0; b < a; ++b)
                    if (wall.next_to_each_other(wall.edges[static_cast<std::size_t>(2 * a)], wall.edges[static_cast<std::size_t>(2 * b)])) ee.push_back({a, b});
            const std::string what = std::string{how} + ", turn " + std::to_string(turn);
            for (const double tolerance : {1e-6, 1e-9}) {
                expect_no_search(wall, vf, 0.015, tolerance, 1.0, "vertex-face " + what);
                expect_no_search(wall, ee, turn == 0.0 ? 0.0 : 0.005, tolerance, 1.0, "edge-edge " + what);
            }
        }
}

/// In one plane z = height, turned about an axis.
std::vector<oracle::Pair> pairs_in_one_plane(std::size_t count, double height, double turn, bool single)
{
    std::mt19937_64 bits{820};
    const auto uniform = [&] { return std::ldexp(static_cast<double>(bits() >> 11), -53); };
    std::vector<oracle::Pair> pairs(count);
    for (oracle::Pair& pair : pairs)
        for (auto& point : pair) {
            const double x = uniform(), y = uniform();
            const double turned[] = {x, std::cos(turn) * y - std::sin(turn) * height, std::sin(turn) * y + std::cos(turn) * height};
            for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = single ? static_cast<float>(turned[axis]) : turned[axis];
        }
    return pairs;
}

/// As in scenes of two dimensions, where nothing but edge functions and gaps tells when a pair meets. What is thin then is left to the search.
TEST(Touching, PairsInOnePlaneAreDecidedByLanes)
{
    struct Plane {
        double height, turn;
    };
    const std::size_t count = amount(4000);
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const auto& [height, turn] : {Plane{0.0, 0.0}, {0.25, 0.0}, {0.25, 0.9}})
            for (const bool single : {false, true})
                for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
                    if (single && turn != 0.0) continue;  // rounded to floats they are in no plane
                    const std::vector<oracle::Pair> pairs = pairs_in_one_plane(count, height, turn, single);
                    Options options;
                    options.tolerance = tolerance;
                    options.reference = true;
                    const Answer expected = answer_without_roots(kind, interleaved(pairs), options);
                    EXPECT_GT(3 * expected.summary.contacts, count);
                    options.reference = false;
                    for (const Isa isa : isas_to_test()) {
                        options.isa = isa;
                        const Answer found = answer_without_roots(kind, interleaved(pairs), options);
                        EXPECT_EQ(0, std::memcmp(expected.toi.data(), found.toi.data(), count * sizeof(double))) << kind_name(kind) << ' ' << name(isa);
                        EXPECT_EQ(expected.summary.proven, found.summary.proven) << kind_name(kind) << ' ' << name(isa);
                        EXPECT_LE(25 * found.summary.scalar_pairs, count)
                            << kind_name(kind) << ' ' << name(isa) << ", height " << height << ", turn " << turn << ", E_tol " << tolerance;
                    }
                }
}

}  // namespace
}  // namespace fastccd::testing
