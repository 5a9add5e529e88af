// What it is all for: two cloths are thrown at one another and crumpled, by nearly all of the steps that collision_free_step
// allows, and never tear. After each step, exactly, no edge passes through a face; and with a minimum separation all is that
// far apart. Whole frames of the same motion tear them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "amount.hpp"
#include "oracle/exact_distance.hpp"

namespace fastccd::testing {
namespace {

using Point = std::array<double, 3>;

/// Sign of the volume of a tetrahedron.
int side(const oracle::IntegerVector& a, const oracle::IntegerVector& b, const oracle::IntegerVector& c, const oracle::IntegerVector& d)
{
    std::array<oracle::IntegerVector, 3> v{b, c, d};
    for (oracle::IntegerVector& row : v)
        for (std::size_t axis = 0; axis < 3; ++axis) row[axis] -= a[axis];
    return sgn(mpz_class(v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                         v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0])));
}

/// Strictly: the ends lie on different sides of the face, and the line passes inside of all three sides of it.
bool passes_through(const Point& p, const Point& q, const Point& a, const Point& b, const Point& c)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (std::max(p[axis], q[axis]) < std::min({a[axis], b[axis], c[axis]}) ||
            std::max({a[axis], b[axis], c[axis]}) < std::min(p[axis], q[axis]))
            return false;
    const oracle::IntegerPair exact{{p, q, a, b, c, c, c, c}};
    const auto& x = exact.point;
    if (side(x[0], x[2], x[3], x[4]) * side(x[1], x[2], x[3], x[4]) >= 0) return false;
    const int first = side(x[0], x[1], x[2], x[3]);
    return first != 0 && side(x[0], x[1], x[3], x[4]) == first && side(x[0], x[1], x[4], x[2]) == first;
}

template <std::size_t n, std::size_t m>
bool share_vertex(const std::array<int, n>& a, const std::array<int, m>& b)
{
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

/// Two square cloths of `width` x `width` vertices, one above the other.
class Cloths {
public:
    static constexpr int width = 8;

    explicit Cloths(std::uint64_t seed) : bits_{seed}
    {
        for (int cloth = 0; cloth < 2; ++cloth)
            for (int i = 0; i < width; ++i)
                for (int j = 0; j < width; ++j)
                    position_.push_back({(i + jitter(0.2)) / width, (j + jitter(0.2)) / width, (cloth == 0 ? 0.1 : -0.1) + jitter(0.02)});
        const auto vertex = [](int cloth, int i, int j) { return (cloth * width + i) * width + j; };
        for (int cloth = 0; cloth < 2; ++cloth)
            for (int i = 0; i < width; ++i)
                for (int j = 0; j < width; ++j) {
                    const int v = vertex(cloth, i, j);
                    if (i + 1 < width) edges_.push_back({v, v + width});
                    if (j + 1 < width) edges_.push_back({v, v + 1});
                    if (i + 1 == width || j + 1 == width) continue;
                    edges_.push_back({v, v + width + 1});
                    faces_.push_back({v, v + width, v + width + 1});
                    faces_.push_back({v, v + width + 1, v + 1});
                }
        // All that share no vertex, of each cloth with itself, too.
        for (std::size_t v = 0; v < position_.size(); ++v)
            for (std::size_t f = 0; f < faces_.size(); ++f)
                if (!share_vertex(std::array{static_cast<int>(v)}, faces_[f])) vertex_face_.push_back({static_cast<int>(v), static_cast<int>(f)});
        for (std::size_t a = 0; a < edges_.size(); ++a)
            for (std::size_t b = 0; b < a; ++b)
                if (!share_vertex(edges_[a], edges_[b])) edge_edge_.push_back({static_cast<int>(a), static_cast<int>(b)});
    }

    /// The cloths fall at one another, each point in a direction of its own.
    void throw_again()
    {
        velocity_.resize(position_.size());
        for (std::size_t v = 0; v < position_.size(); ++v) {
            const double towards = position_[v][2] > 0.0 ? -1.0 : 1.0;
            velocity_[v] = {jitter(0.15), jitter(0.15), 0.15 * towards + jitter(0.15)};
        }
    }

    /// Moves all by what is left of a frame, or by the step that is free of collision but for a millionth; then what stopped it bounces.
    /// Returns how much of the frame that was, 0 after an error.
    double advance(double left, const Options& options)
    {
        std::vector<Point> end = moved(left);
        const MovingMesh mesh{PositionView::rows(position_[0].data(), position_.size()), PositionView::rows(end[0].data(), end.size()),
                              IndexView::rows(faces_[0].data(), faces_.size(), 3), IndexView::rows(edges_[0].data(), edges_.size(), 2)};
        CollisionFreeStep free;
        const Status status = collision_free_step(mesh, vertex_face_, edge_edge_, options, free);
        EXPECT_TRUE(status.ok()) << message(status.error);
        if (!status.ok()) return 0.0;
        if (!free.limited()) {
            position_ = std::move(end);
            return left;
        }
        EXPECT_GT(free.step, 0.0) << "nothing was in contact before";
        const double done = (1.0 - 1e-6) * free.step * left;
        position_ = moved(done);
        Point mean{};
        const std::array<int, 4> stopped = vertices_of(free);
        for (const int v : stopped)
            for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += 0.25 * velocity_[static_cast<std::size_t>(v)][axis];
        for (const int v : stopped)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                double& component = velocity_[static_cast<std::size_t>(v)][axis];
                component = mean[axis] + 0.5 * (mean[axis] - component);
            }
        return done;
    }

    void advance_freely(double left) { position_ = moved(left); }

    [[nodiscard]] std::size_t tears() const
    {
        std::size_t count = 0;
        for (const auto& edge : edges_)
            for (const auto& face : faces_)
                count += !share_vertex(edge, face) && passes_through(at(edge[0]), at(edge[1]), at(face[0]), at(face[1]), at(face[2]));
        return count;
    }

    /// Pairs at a distance of at most d, exactly.
    [[nodiscard]] std::size_t within(double d) const
    {
        const mpq_class square = mpq_class(d) * mpq_class(d);
        const auto count = [&](oracle::Kind kind, const std::array<int, 4>& v) -> std::size_t {
            const std::size_t first = kind == oracle::Kind::vertex_face ? 1 : 2;
            oracle::Pair pair;
            for (std::size_t i = 0; i < 8; ++i) pair[i] = at(v[i % 4]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto along = [axis](const Point& p, const Point& q) { return p[axis] < q[axis]; };
                const auto [low, high] = std::minmax_element(pair.begin(), pair.begin() + static_cast<std::ptrdiff_t>(first), along);
                const auto [low2, high2] = std::minmax_element(pair.begin() + static_cast<std::ptrdiff_t>(first), pair.begin() + 4, along);
                if ((*low2)[axis] - (*high)[axis] > 2 * d || (*low)[axis] - (*high2)[axis] > 2 * d) return 0;
            }
            return oracle::squared_distance(kind, pair, 0.0) <= square;
        };
        std::size_t close = 0;
        for (const VertexFace& c : vertex_face_) close += count(oracle::Kind::vertex_face, vertices_of(c));
        for (const EdgeEdge& c : edge_edge_) close += count(oracle::Kind::edge_edge, vertices_of(c));
        return close;
    }

private:
    double jitter(double most) { return std::uniform_real_distribution<double>{-most, most}(bits_); }
    [[nodiscard]] const Point& at(int v) const { return position_[static_cast<std::size_t>(v)]; }
    [[nodiscard]] std::array<int, 4> vertices_of(const VertexFace& c) const
    {
        const auto& face = faces_[static_cast<std::size_t>(c.face)];
        return {c.vertex, face[0], face[1], face[2]};
    }
    [[nodiscard]] std::array<int, 4> vertices_of(const EdgeEdge& c) const
    {
        const auto &a = edges_[static_cast<std::size_t>(c.edge_a)], &b = edges_[static_cast<std::size_t>(c.edge_b)];
        return {a[0], a[1], b[0], b[1]};
    }
    [[nodiscard]] std::array<int, 4> vertices_of(const CollisionFreeStep& free) const
    {
        return free.kind == PairKind::vertex_face ? vertices_of(vertex_face_[free.pair]) : vertices_of(edge_edge_[free.pair]);
    }
    [[nodiscard]] std::vector<Point> moved(double time) const
    {
        std::vector<Point> end = position_;
        for (std::size_t v = 0; v < end.size(); ++v)
            for (std::size_t axis = 0; axis < 3; ++axis) end[v][axis] += time * velocity_[v][axis];
        return end;
    }

    std::mt19937_64 bits_;
    std::vector<Point> position_, velocity_;
    std::vector<std::array<int, 3>> faces_;
    std::vector<std::array<int, 2>> edges_;
    std::vector<VertexFace> vertex_face_;
    std::vector<EdgeEdge> edge_edge_;
};

void run(std::uint64_t seed, double separation)
{
    constexpr std::size_t frames = sanitized ? 2 : 8, most_steps = 25;
    constexpr double duration = 0.5;
    Options options;
    options.minimum_separation = separation;
    // After a step, coordinates below 4 are rounded by 2^-52 at most, and the products added to them by less: some 1e-15 of any distance.
    constexpr double rounding_of_positions = 1e-14;
    Cloths cloths{seed};
    std::size_t stops = 0, torn = 0;
    double done = 0.0;
    for (std::size_t frame = 0; frame < frames; ++frame) {
        cloths.throw_again();
        Cloths unlimited = cloths;
        unlimited.advance_freely(duration);
        torn += unlimited.tears();
        double left = duration;
        for (std::size_t step = 0; left > 0.0 && step < most_steps; ++step) {
            left -= cloths.advance(left, options);
            stops += left > 0.0;
            ASSERT_EQ(cloths.tears(), 0u) << "seed " << seed << ", frame " << frame;
            if (separation > 0.0) {
                ASSERT_EQ(cloths.within(separation - rounding_of_positions), 0u) << "seed " << seed << ", frame " << frame;
            }
        }
        done += 1.0 - left / duration;
    }
    std::printf("separation %g: %.3g of %zu frames done, %zu stops, nothing torn; by whole frames %zu edges pass through faces\n", separation, done,
                frames, stops, torn);
    EXPECT_GT(stops, 10 * frames);
    EXPECT_GT(done, 0.15 * static_cast<double>(frames)) << "a step of nearly nothing is free of collision, too";
    EXPECT_GT(torn, 50 * frames);
}

TEST(Simulation, ClothsDoNotTear)
{
    for (const std::uint64_t seed : {1u, 2u}) run(seed, 0.0);
}

TEST(Simulation, ClothsStayApart)
{
    for (const double separation : {1e-6, 1e-3}) run(3, separation);
}

}  // namespace
}  // namespace fastccd::testing
