// What the direction of a single look shows (separating_direction.hpp), where features do not make up for it. Those are asked only where it shows too
// little (feature_directions.hpp), and then what it was worth is not to be told from the answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <separating_direction.hpp>

#include "../amount.hpp"
#include "../narrow_phase.hpp"
#include "../oracle/exact_distance.hpp"

namespace fastccd::testing {
namespace {

using portable::Separation;
using portable::Vector3;

constexpr double u = 0x1p-53;

class SeparatingDirection : public ::testing::Test {
protected:
    double uniform() { return 2.0 * std::ldexp(static_cast<double>(bits_() >> 11), -53) - 1.0; }
    Vector3<double> vector() { return {uniform(), uniform(), uniform()}; }

private:
    std::mt19937_64 bits_{131};
};

Vector3<double> along(const Vector3<double>& direction, double length) { return portable::scaled(direction, length); }

/// The distance of primitives in one position, x0 at the origin, less the gap that is shown, in multiples of S.
template <PairKind kind>
double short_of_distance(const Vector3<double> (&r)[3])
{
    oracle::Pair pair{};
    for (std::size_t k = 0; k < 3; ++k) {
        pair[k + 1] = {r[k].x, r[k].y, r[k].z};
        pair[k + 5] = pair[k + 1];
    }
    const auto exact_kind = kind == PairKind::vertex_face ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
    const Separation<double> seen = portable::separation<kind>(r);
    return oracle::excess_of_distance(exact_kind, pair, 0.0, mpq_class(seen.gap), oracle::sum_of_extents(pair));
}

/// A face or two edges along a line of the plane y = 0, but for offsets along y. Their normal lies in that plane, as what is between the primitives does, and
/// is so short that its square underflows, or nearly: by rounding it may seem the better direction of the two, and is no unit vector.
TEST_F(SeparatingDirection, IsNoNormalThatVanishes)
{
    double worst = 0;
    for (const double offset : {1e-30, 1e-60, 1e-100, 1e-150, 1e-160, 1e-200})
        for (std::size_t n = 0; n < amount(20000); ++n) {
            const Vector3<double> line{uniform(), 0.0, uniform()}, away{uniform(), 0.0, uniform()};
            const auto near_line = [&] { return add(along(line, uniform()), {0.0, offset * uniform(), 0.0}); };
            const Vector3<double> face[3] = {add(away, near_line()), add(away, near_line()), add(away, near_line())};
            worst = std::max(worst, short_of_distance<PairKind::vertex_face>(face));
            const Vector3<double> edges[3] = {near_line(), add(away, near_line()), add(away, near_line())};
            worst = std::max(worst, short_of_distance<PairKind::edge_edge>(edges));
        }
    std::printf("primitives along a line: distance but for %.3g u S\n", worst / u);
    EXPECT_LE(worst, 0x1p-30);  // some 2^11 u where the line all but meets the vertex; of no unit vector the gap is 0
}

/// Of sides far longer than their nearest corner is away that corner itself is the nearest point: none that is off by the rounding of a whole side.
TEST_F(SeparatingDirection, ReachesTheCornerOfLongSides)
{
    std::size_t faces = 0;
    for (std::size_t n = 0; n < amount(100000); ++n) {
        const Vector3<double> corner = along(vector(), std::exp2(-40.0 * std::fabs(uniform())));
        const Vector3<double> first = vector(), second = vector();
        if (!(dot(corner, first) > 0.0 && dot(corner, second) > 0.0)) continue;  // the corner is nearest: sides lead away from the origin
        const Vector3<double> of_face[3] = {corner, add(corner, first), add(corner, second)};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3<double> r[3] = {of_face[k], of_face[(k + 1) % 3], of_face[(k + 2) % 3]};
            ASSERT_EQ(portable::separation<PairKind::vertex_face>(r).square_to_side, dot(corner, corner));
        }
        ++faces;
    }
    EXPECT_GT(faces, amount(20000));
}

}  // namespace
}  // namespace fastccd::testing
