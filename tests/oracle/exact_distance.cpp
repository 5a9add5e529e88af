// The shortest vector ends either in the interiors of both primitives, and is then perpendicular to them, or at an end
// point or side of one. So: take the perpendicular if it meets both, else the shortest of the smaller problems.

#include "exact_distance.hpp"

#include <algorithm>
#include <utility>

namespace fastccd::oracle {
namespace {

IntegerVector operator-(const IntegerVector& a, const IntegerVector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

IntegerVector operator*(const mpz_class& s, const IntegerVector& a) { return {s * a[0], s * a[1], s * a[2]}; }

mpz_class dot(const IntegerVector& a, const IntegerVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const IntegerVector& a) { return sgn(a[0]) == 0 && sgn(a[1]) == 0 && sgn(a[2]) == 0; }

ShortestVector shorter(ShortestVector a, ShortestVector b) {
    // |a| / da <= |b| / db, squared and multiplied out
    const bool a_first = dot(a.numerator, a.numerator) * b.denominator * b.denominator <=
                         dot(b.numerator, b.numerator) * a.denominator * a.denominator;
    return a_first ? std::move(a) : std::move(b);
}

// From point p to the closed segment from a to b: to a + s (b - a), s = (p - a).(b - a) / |b - a|^2 within [0, 1].
ShortestVector point_segment(const IntegerVector& p, const IntegerVector& a, const IntegerVector& b) {
    const IntegerVector direction = b - a;
    const mpz_class s_numerator = dot(p - a, direction), s_denominator = dot(direction, direction);
    if (sgn(s_numerator) <= 0) return {a - p, 1};
    if (s_numerator >= s_denominator) return {b - p, 1};
    const IntegerVector scaled = s_denominator * (a - p), along = s_numerator * direction;
    return {{scaled[0] + along[0], scaled[1] + along[1], scaled[2] + along[2]}, s_denominator};
}

// The part of `offset` along the normal: (offset.n / n.n) n.
ShortestVector along_normal(const IntegerVector& offset, const IntegerVector& normal) {
    return {dot(offset, normal) * normal, dot(normal, normal)};
}

ShortestVector point_triangle(const IntegerVector& p, const IntegerVector& a, const IntegerVector& b,
                              const IntegerVector& c) {
    const IntegerVector normal = cross(b - a, c - a);
    if (!is_zero(normal)) {
        // p is above the triangle if it is on the inner side of the three planes upright on its sides.
        const auto inside = [&](const IntegerVector& from, const IntegerVector& to) {
            return sgn(dot(cross(to - from, p - from), normal)) >= 0;
        };
        if (inside(a, b) && inside(b, c) && inside(c, a)) return along_normal(a - p, normal);
    }
    return shorter(point_segment(p, a, b), shorter(point_segment(p, b, c), point_segment(p, c, a)));
}

ShortestVector reversed(ShortestVector v) {
    for (mpz_class& component : v.numerator) component = -component;
    return v;
}

ShortestVector segment_segment(const IntegerVector& a, const IntegerVector& b, const IntegerVector& c,
                               const IntegerVector& d) {
    const IntegerVector u = b - a, v = d - c, w = c - a;
    const IntegerVector normal = cross(u, v);
    if (!is_zero(normal)) {
        // The common perpendicular starts at a + s u and ends at c + r v, with s n.n = (w x v).n, r n.n = (w x u).n.
        const mpz_class whole = dot(normal, normal);
        const mpz_class s = dot(cross(w, v), normal), r = dot(cross(w, u), normal);
        if (sgn(s) >= 0 && s <= whole && sgn(r) >= 0 && r <= whole) return along_normal(w, normal);
    }
    return shorter(shorter(point_segment(a, c, d), point_segment(b, c, d)),
                   shorter(reversed(point_segment(c, a, b)), reversed(point_segment(d, a, b))));
}

}  // namespace

IntegerPair::IntegerPair(const Pair& pair) {
    std::array<double, 24> values;
    for (std::size_t i = 0; i < 24; ++i) values[i] = pair[i / 3][i % 3];
    std::array<mpz_class, 24> integers;
    exponent = to_common_integers(values, integers);
    for (std::size_t i = 0; i < 24; ++i) point[i / 3][i % 3] = integers[i];
}

IntegerPoints IntegerPair::at(const Dyadic& t) const {
    // 2^l x(n / 2^l) = (2^l - n) x(0) + n x(1)
    const mpz_class rest = (mpz_class(1) << t.level) - t.numerator;
    IntegerPoints points;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            points[i][axis] = rest * point[i][axis] + t.numerator * point[i + 4][axis];
        }
    }
    return points;
}

ShortestVector shortest_vector(Kind kind, const IntegerPoints& x) {
    return kind == Kind::vertex_face ? point_triangle(x[0], x[1], x[2], x[3])
                                     : segment_segment(x[0], x[1], x[2], x[3]);
}

mpq_class squared_distance(Kind kind, const Pair& pair, double t) {
    const IntegerPair scaled(pair);
    const Dyadic time = to_dyadic(t);
    const ShortestVector v = shortest_vector(kind, scaled.at(time));
    mpq_class result(dot(v.numerator, v.numerator), v.denominator * v.denominator);
    result.canonicalize();
    // undo the scaling by 2^(exponent + level), which is squared too
    const long exponent = 2 * (scaled.exponent + static_cast<long>(time.level));
    if (exponent >= 0) {
        result >>= static_cast<mp_bitcnt_t>(exponent);
    } else {
        result <<= static_cast<mp_bitcnt_t>(-exponent);
    }
    return result;
}

mpq_class sum_of_extents(const Pair& pair) {
    mpq_class sum;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        mpq_class extent;
        for (std::size_t i = 0; i < 8; ++i) {
            extent = std::max(extent, mpq_class(abs(mpq_class(pair[i][axis]) - mpq_class(pair[i / 4 * 4][axis]))));
        }
        sum += extent;
    }
    return sum;
}

double excess_of_distance(Kind kind, const Pair& pair, double t, const mpq_class& allowed, const mpq_class& size) {
    const mpq_class square = squared_distance(kind, pair, t);
    if (square <= allowed * allowed) return 0.0;
    // In units of size first: squares of large coordinates have no double.
    const mpq_class relative = square / (size * size), threshold = allowed / size;
    const mpf_class excess = sqrt(mpf_class(relative, 512)) - mpf_class(threshold, 512);
    return excess.get_d();
}

}  // namespace fastccd::oracle
