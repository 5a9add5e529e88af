#include "cubic_share.hpp"

#include <array>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace fastccd::tools::report {
namespace {

using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector sizes(const Vector& a, const Vector& b)
{
    return {std::abs(a[0]) + std::abs(b[0]), std::abs(a[1]) + std::abs(b[1]), std::abs(a[2]) + std::abs(b[2])};
}

double determinant(const Vector& a, const Vector& b, const Vector& c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The determinant's sum of products with all signs plus: what its rounding error is relative to.
double permanent(const Vector& a, const Vector& b, const Vector& c)
{
    return a[0] * (b[1] * c[2] + b[2] * c[1]) + a[1] * (b[2] * c[0] + b[0] * c[2]) + a[2] * (b[0] * c[1] + b[1] * c[0]);
}

/// Of one pair. Relative vectors have relative error u = 2^-53, their differences w = r(1) - r(0) an error of at most
/// 2 u (|r(0)| + |r(1)|), products of three and their sums 5 u more: 11 u in all for w, less for others. 2^-49 = 16 u.
CubicShare cubic_share(const Step& step, const PairVertices& vertices)
{
    std::array<Vector, 4> start, end;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t at = 3 * static_cast<std::size_t>(vertices[i]) + axis;
            start[i][axis] = step.positions0[at];
            end[i][axis] = step.positions1[at];
        }
    }
    std::array<Vector, 3> r, w, size;
    for (std::size_t i = 0; i < 3; ++i) {
        r[i] = minus(start[i + 1], start[0]);
        const Vector r1 = minus(end[i + 1], end[0]);
        w[i] = minus(r1, r[i]);
        size[i] = sizes(r[i], r1);
    }
    const double zero = 0x1p-49 * permanent(size[0], size[1], size[2]);
    const auto vanishes = [zero](double coefficient) { return std::abs(coefficient) <= 3 * zero; };
    CubicShare share;
    share.no_cube = std::abs(determinant(w[0], w[1], w[2])) <= zero;
    share.all_zero = share.no_cube != 0 && std::abs(determinant(r[0], r[1], r[2])) <= zero &&
                     vanishes(determinant(w[0], r[1], r[2]) + determinant(r[0], w[1], r[2]) + determinant(r[0], r[1], w[2])) &&
                     vanishes(determinant(r[0], w[1], w[2]) + determinant(w[0], r[1], w[2]) + determinant(w[0], w[1], r[2]));
    return share;
}

template <class Pair>
CubicShare sum(const Step& step, std::span<const Pair> pairs)
{
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>{0, pairs.size(), 1024}, CubicShare{},
        [&](const auto& range, CubicShare total) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
                const CubicShare one = cubic_share(step, pair_vertices(step, pairs[i]));
                total.all_zero += one.all_zero;
                total.no_cube += one.no_cube;
            }
            return total;
        },
        [](const CubicShare& a, const CubicShare& b) {
            return CubicShare{a.all_zero + b.all_zero, a.no_cube + b.no_cube};
        });
}

}  // namespace

CubicShare cubic_share(const Step& step, std::span<const VertexFace> pairs) { return sum(step, pairs); }
CubicShare cubic_share(const Step& step, std::span<const EdgeEdge> pairs) { return sum(step, pairs); }

}  // namespace fastccd::tools::report
