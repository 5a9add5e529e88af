// The bounds of separation_bound.hpp, and the certificates that rest on them, against exact arithmetic.
#include <algorithm>
#include <cmath>

#include <following_direction.hpp>
#include <separation_certificate.hpp>

#include "../amount.hpp"
#include "../oracle/exact_separation.hpp"
#include "exact_number.hpp"
#include "measured_bound.hpp"

namespace fastccd::testing {
namespace {

using portable::Extents;
using portable::Vector3;

Extents<double> extents_of(const Computed& c) { return {c.extents.x, c.extents.y, c.extents.z}; }

ExactVector exact(const Vector3<double>& v) { return {Exact(v.x), Exact(v.y), Exact(v.z)}; }

double spread(const Vector3<double>& n, const Computed& c)
{
    return std::fabs(n.x) * c.extents.x + std::fabs(n.y) * c.extents.y + std::fabs(n.z) * c.extents.z;
}

template <PairKind kind>
Vector3<double> vector_at(const Computed& c, double s)
{
    const Vector3<double> at[3] = {portable::position(c.r, 0, s), portable::position(c.r, 1, s), portable::position(c.r, 2, s)};
    return portable::separation<kind>(at).n;
}

/// Calls visit(computed, exact) for every height: n . r_i or differences of two.
template <PairKind kind, class Visit>
void for_each_height_at(const Input& in, const Computed& c, const Vector3<double>& n, double s, Visit visit)
{
    const ExactRelativeMotion motion{in.x.data(), in.t_max};
    std::vector<Exact> exact_heights;
    portable::for_each_height<kind>([&](int i) { return dot(exact(n), motion.at(static_cast<std::size_t>(i), s)); },
                                    [&](const Exact& height) { exact_heights.push_back(height); });
    auto next = exact_heights.begin();
    portable::for_each_height<kind>(
        [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            return portable::dot(n, s == 0.0 ? c.r.start[k] : s == 1.0 ? c.r.end[k] : portable::position(c.r, i, s));
        },
        [&](double height) { visit(height, *next++); });
}

template <PairKind kind>
double height_ratio(const Input& in, double s, bool at_end)
{
    const Computed c{in};
    const SeparationBounds bounds{c.bounds.rho};
    const Vector3<double> n = vector_at<kind>(c, in.b);
    const double bound = (at_end ? bounds.height(kind) : bounds.height_at(kind)) * spread(n, c);
    double worst = 0;
    if (bound > 0)
        for_each_height_at<kind>(in, c, n, s, [&](double computed, const Exact& height) {
            worst = std::max(worst, (height - Exact(computed)).magnitude_in(bound));
        });
    return worst;
}

TEST(SeparationBounds, Heights)
{
    expect_bound("height, vertex-face", 0.02, [](const Input& in) { return height_ratio<PairKind::vertex_face>(in, 1.0, true); });
    expect_bound("height, edge-edge", 0.02, [](const Input& in) { return height_ratio<PairKind::edge_edge>(in, 1.0, true); });
    expect_bound("height_at, vertex-face", 0.02, [](const Input& in) { return height_ratio<PairKind::vertex_face>(in, in.a, false); });
    expect_bound("height_at, edge-edge", 0.02, [](const Input& in) { return height_ratio<PairKind::edge_edge>(in, in.a, false); });
}

/// Of one computed vector at a time and positions at another, added: the middle coefficient.
TEST(SeparationBounds, SumsOfHeights)
{
    expect_bound("height_at, sums", 0.02, [](const Input& in) {
        const Computed c{in};
        const Vector3<double> n = vector_at<PairKind::edge_edge>(c, in.a), m = vector_at<PairKind::edge_edge>(c, in.b);
        const double bound = SeparationBounds{c.bounds.rho}.height_at(PairKind::edge_edge) * (spread(n, c) + spread(m, c));
        std::vector<double> computed;
        std::vector<Exact> exact_heights;
        const auto note = [&](double height, const Exact& truth) { computed.push_back(height), exact_heights.push_back(truth); };
        for_each_height_at<PairKind::edge_edge>(in, c, n, in.b, note);
        for_each_height_at<PairKind::edge_edge>(in, c, m, in.a, note);
        double worst = 0;
        for (std::size_t i = 0; bound > 0 && i < 4; ++i)
            worst = std::max(worst, (exact_heights[i] + exact_heights[i + 4] - Exact(computed[i] + computed[i + 4])).magnitude_in(bound));
        return worst;
    });
}

/// Four times the coefficients of a height along a cubic n(s), or of S(s).
template <class Number>
struct FourTimes {
    Number c[5];

    template <class Product>
    static FourTimes of(Product product)
    {
        const Number two{2.0}, three{3.0}, four{4.0};
        return {{four * product(0, 0), product(0, 1) + three * product(1, 0), two * (product(1, 1) + product(2, 0)),
                 three * product(2, 1) + product(3, 0), four * product(3, 1)}};
    }

    friend FourTimes operator-(const FourTimes& p, const FourTimes& q)
    {
        FourTimes difference{p};
        for (int k = 0; k < 5; ++k) difference.c[k] = p.c[k] - q.c[k];
        return difference;
    }
};

template <PairKind kind>
double following_ratio(const Input& in)
{
    using Direction = scalar::FollowingDirection<kind>;
    const Computed c{in};
    const Direction direction{c.r, in.a, in.b};
    const ExactRelativeMotion motion{in.x.data(), in.t_max};
    std::vector<FourTimes<Exact>> truth;
    portable::for_each_height<kind>(
        [&](int i) {
            return FourTimes<Exact>::of([&](int k, int end) {
                return dot(exact(direction.coefficient(k)), motion.at(static_cast<std::size_t>(i), Exact(end == 0 ? in.a : in.b)));
            });
        },
        [&](const FourTimes<Exact>& height) { truth.push_back(height); });
    const double bound = SeparationBounds{c.bounds.rho}.height_following(kind);
    const auto spreads = FourTimes<double>::of([&](int k, int) { return spread(direction.coefficient(k), c); });
    auto next = truth.begin();
    double worst = 0;
    direction.visit_heights([&](const typename Direction::Coefficients& height) {
        for (int k = 0; k < 5; ++k)
            if (spreads.c[k] > 0) worst = std::max(worst, (next->c[k] - Exact(4.0) * Exact(height.c[k])).magnitude_in(bound * spreads.c[k]));
        ++next;
    });
    return worst;
}

TEST(SeparationBounds, HeightsWhileFollowing)
{
    expect_bound("height_following, vertex-face", 0.02, following_ratio<PairKind::vertex_face>);
    expect_bound("height_following, edge-edge", 0.02, following_ratio<PairKind::edge_edge>);
}

TEST(SeparationBounds, UnitVectors)
{
    const auto excess = [](const Vector3<double>& n) { return (dot(exact(n), exact(n)) - Exact(1.0)).in(2 * 5 * ErrorBounds::u); };
    expect_bound("length of unit vectors", 0.02, [&](const Input& in) {
        const Computed c{in};
        return std::max(excess(vector_at<PairKind::vertex_face>(c, in.a)), excess(vector_at<PairKind::edge_edge>(c, in.a)));
    });
}

TEST(SeparationBounds, AxisGaps)
{
    expect_bound("axis", 0.02, [](const Input& in) {
        const Computed c{in};
        const ExactRelativeMotion motion{in.x.data(), in.t_max};
        double worst = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = axis == 0 ? c.extents.x : axis == 1 ? c.extents.y : c.extents.z;
            const double difference = component(c.r.end[1], axis) - component(c.r.end[0], axis);
            const Exact truth = motion.at(1, 1.0)[axis] - motion.at(0, 1.0)[axis];
            worst = std::max(worst, (truth - Exact(difference)).magnitude_in(SeparationBounds{c.bounds.rho}.axis() * extent));
        }
        return worst;
    });
}

/// Exact heights of n over d, at a time: the least of them, times |n| for the other side of the comparison. n proves a
/// distance above d if all heights exceed d |n|.
template <PairKind kind>
bool proves(const Input& in, const Vector3<double>& n, double d, double s)
{
    const ExactRelativeMotion motion{in.x.data(), in.t_max};
    const Exact square = dot(exact(n), exact(n)), d_square = Exact(d) * Exact(d);
    bool all = true;
    portable::for_each_height<kind>([&](int i) { return dot(exact(n), motion.at(static_cast<std::size_t>(i), s)); },
                                    [&](const Exact& height) { all = all && height.sign() > 0 && d_square * square < height * height; });
    return all;
}

/// Distances just below the one that is there, so that what is certified ends within the interval.
template <PairKind kind>
void expect_certificates_hold(std::uint64_t seed)
{
    Adversary adversary{seed};
    std::size_t ends = 0, whole = 0, turning = 0, following = 0;
    for (std::size_t k = 0; k < amount(40000); ++k) {
        constexpr double t_maxima[] = {1.0, 0.7, 1e-6};
        const Input in = adversary.input(t_maxima[k % 3], -4, 4);
        const Computed c{in};
        const Extents<double> extents = extents_of(c);
        if (!portable::in_separation_range(c.r, extents).value) continue;
        const SeparationBounds bounds{c.bounds.rho};
        const auto distance_at = [&](double s) {
            const Vector3<double> at[3] = {portable::position(c.r, 0, s), portable::position(c.r, 1, s), portable::position(c.r, 2, s)};
            return std::sqrt(portable::square_distance<kind>(at, portable::separation<kind>(at)));
        };
        const double share = 1.0 - std::ldexp(adversary.uniform(0.5, 1), -adversary.integer(1, 50));
        const double d = share * distance_at(in.a);
        if (!(d > 0)) continue;
        const SeparationParameters wanted{d, 1e-6};
        const auto seen = portable::look<kind>(c.r, extents, in.a, wanted, bounds);
        const double low = std::max(seen.reach.low, 0.0), high = std::min(seen.reach.high, 1.0);
        if (low < high) {
            for (const double s : {low, high, low + 0.5 * (high - low)})
                ASSERT_TRUE(proves<kind>(in, seen.separation.n, d, s)) << s << ' ' << d << ' ' << text(in);
            (low == 0.0 && high == 1.0 ? whole : ends) += 1;
        }
        const auto other = portable::look<kind>(c.r, extents, in.b, wanted, bounds);
        if (in.a < in.b && portable::farther_while_turning<kind>(seen.at.r, other.at.r, extents, seen.separation.n, other.separation.n, wanted, bounds).value) {
            ++turning;
            ASSERT_TRUE(proves<kind>(in, seen.separation.n, d, in.a) && proves<kind>(in, other.separation.n, d, in.b)) << d << ' ' << text(in);
            // In between n is computed here with rounding, which at distances this far above d does not matter.
            for (const double w : {0.25, 0.5, 0.75}) {
                const auto mixed = portable::add(portable::scaled(seen.separation.n, 1.0 - w), portable::scaled(other.separation.n, w));
                const bool holds = proves<kind>(in, mixed, 0.999 * d, in.a + w * (in.b - in.a));
                ASSERT_TRUE(holds) << w << ' ' << d << ' ' << text(in);
            }
        }
        if (in.t_max == 1.0 && in.a < in.b && scalar::FollowingDirection<kind>{c.r, in.a, in.b}.farther(extents, wanted, bounds)) {
            ++following;
            oracle::Pair pair;
            for (std::size_t i = 0; i < 24; ++i) pair[i / 3][i % 3] = in.x[i];
            const auto oracle_kind = kind == PairKind::vertex_face ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
            ASSERT_EQ(oracle::farther_throughout(oracle_kind, pair, d, in.a, in.b), oracle::Farther::certainly) << d << ' ' << text(in);
        }
    }
    std::printf("%s: %zu reaches with an end inside, %zu without, %zu intervals while turning, %zu while following\n",
                kind == PairKind::vertex_face ? "vertex-face" : "edge-edge", ends, whole, turning, following);
    EXPECT_GT(ends, amount(5000));
    EXPECT_GT(turning, amount(500));
    EXPECT_GT(following, amount(1000));
}

TEST(SeparationBounds, CertificatesHold)
{
    expect_certificates_hold<PairKind::vertex_face>(8);
    expect_certificates_hold<PairKind::edge_edge>(9);
}

}  // namespace
}  // namespace fastccd::testing
