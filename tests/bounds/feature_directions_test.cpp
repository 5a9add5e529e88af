// What the directions of all features show of a distance D, against exact distances: D - 64 u S, whatever the shape (feature_directions.hpp).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <feature_directions.hpp>

#include "../amount.hpp"
#include "../narrow_phase.hpp"
#include "../oracle/exact_distance.hpp"
#include "../oracle/exact_separation.hpp"

namespace fastccd::testing {
namespace {

using portable::Vector3;

constexpr double u = 0x1p-53;

/// Primitives in one position, x0 at the origin: needles, faces and parallelograms of any width, next to one another at any height, in a
/// frame of any direction; points of one mostly within the other's length, as otherwise corners are nearest. And edges of which the second runs
/// back along the first, from next to its end on: that end is nearest, but hardly.
class ThinPositions {
public:
    ThinPositions(oracle::Kind kind, std::uint64_t seed) : kind_{kind}, bits_{seed} {}

    oracle::Pair next()
    {
        double frame[3][3];
        for (std::size_t i = 0; i < 3; ++i) {
            for (double& x : frame[i]) x = uniform(-1, 1);
            for (std::size_t j = 0; j < i; ++j) {
                double along = 0;
                for (std::size_t k = 0; k < 3; ++k) along += frame[i][k] * frame[j][k];
                for (std::size_t k = 0; k < 3; ++k) frame[i][k] -= along * frame[j][k];
            }
            const double length = std::hypot(frame[i][0], frame[i][1], frame[i][2]);
            for (double& x : frame[i]) x /= length;
        }
        oracle::Pair pair;
        if (kind_ == oracle::Kind::edge_edge && one_in(4)) {
            const double angle = binades(40), distance = binades(40), up = uniform(0, 1), back = distance * angle * up * uniform(0, 1);
            const double at[4][3] = {{}, {1, 0, 0}, {1 + back, distance, 0}, {back, distance + angle * up, angle * uniform(-1, 1)}};
            place(at, frame, pair);
            return pair;
        }
        const double width = binades(58), height = binades(58), shorter = binades(30);
        double at[4][3];
        for (std::size_t point = 0; point < 4; ++point) {
            const bool second = point >= (kind_ == oracle::Kind::vertex_face ? 1 : 2);
            const double length = one_in(2) ? shorter : 1.0;
            at[point][0] = length * uniform(-1, 1);
            at[point][1] = one_in(4) ? 0.0 : width * uniform(-1, 1);
            at[point][2] = second && !one_in(4) ? height * uniform(-1, 1) : 0.0;
        }
        place(at, frame, pair);
        return pair;
    }

private:
    static void place(const double (&at)[4][3], const double (&frame)[3][3], oracle::Pair& pair)
    {
        for (std::size_t point = 0; point < 4; ++point)
            for (std::size_t k = 0; k < 3; ++k) pair[point][k] = at[point][0] * frame[0][k] + at[point][1] * frame[1][k] + at[point][2] * frame[2][k];
        // Differences are exact then.
        for (std::size_t point = 4; point-- > 0;)
            for (std::size_t k = 0; k < 3; ++k) pair[point + 4][k] = pair[point][k] -= pair[0][k];
    }

    double uniform(double a, double b) { return a + (b - a) * std::ldexp(static_cast<double>(bits_() >> 11), -53); }
    double binades(int n) { return std::exp2(uniform(-n, 0)); }
    bool one_in(unsigned n) { return bits_() % n == 0; }

    oracle::Kind kind_;
    std::mt19937_64 bits_;
};

/// Exact height of the second primitive over the first along n; 0 if there is none.
template <PairKind kind>
mpq_class height_along(const Vector3<double>& n, const Vector3<double> (&r)[3])
{
    const auto exact = [&](const Vector3<double>& v) -> mpq_class { return mpq_class(n.x) * v.x + mpq_class(n.y) * v.y + mpq_class(n.z) * v.z; };
    const mpq_class h1 = exact(r[0]), h2 = exact(r[1]), h3 = exact(r[2]), zero = 0;
    const mpq_class least = std::min(h2, h3);
    return std::max<mpq_class>(zero, kind == PairKind::vertex_face ? std::min<mpq_class>(h1, least) : mpq_class(least - std::max<mpq_class>(h1, zero)));
}

template <PairKind kind>
void expect_to_show_the_distance(std::uint64_t seed)
{
    const auto exact_kind = kind == PairKind::vertex_face ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
    ThinPositions positions{exact_kind, seed};
    double worst = 0, worst_of_two = 0;
    for (std::size_t i = 0; i < amount(60000); ++i) {
        const oracle::Pair pair = positions.next();
        Vector3<double> r[3];
        for (std::size_t k = 0; k < 3; ++k) r[k] = {pair[k + 1][0], pair[k + 1][1], pair[k + 1][2]};
        const mpq_class size = oracle::sum_of_extents(pair);
        if (sgn(size) == 0) continue;
        const auto short_of_distance = [&](const portable::Separation<double>& seen) {
            return oracle::excess_of_distance(exact_kind, pair, 0.0, height_along<kind>(seen.n, r), size);
        };
        const portable::Separation<double> of_two = portable::separation<kind>(r);
        const double of_features = short_of_distance(portable::separation_by_features<kind>(r, of_two, 0.0, portable::all_lanes<double>()));
        ASSERT_LE(of_features, 64 * u) << lossless(pair);
        worst = std::max(worst, of_features);
        worst_of_two = std::max(worst_of_two, short_of_distance(of_two));

        // They are asked where more is needed than two show, if there is more.
        const double needed = size.get_d() * std::exp2(-static_cast<double>(i % 50));
        const portable::Separation<double> seen = portable::separation_beyond<kind>(r, needed);
        if (seen.gap <= needed) {
            ASSERT_LE(oracle::excess_of_distance(exact_kind, pair, 0.0, mpq_class(needed), size), 64 * u) << lossless(pair);
        }
    }
    std::printf("%s: features show a distance but for %.3g u S, two of them but for %.3g u S\n", kind_name(exact_kind), worst / u, worst_of_two / u);
    EXPECT_GT(worst_of_two, 0x1p20 * u) << "nothing thin was tried";
}

TEST(FeatureDirections, ShowTheDistanceWhateverTheShape)
{
    expect_to_show_the_distance<PairKind::vertex_face>(101);
    expect_to_show_the_distance<PairKind::edge_edge>(102);
}

}  // namespace
}  // namespace fastccd::testing
