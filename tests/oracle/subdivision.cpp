// Along the shortest vector between them, two convex sets that are apart are strictly separated. So take it at both
// ends of a time interval and let the direction n(t) go linearly from one to the other. The heights
// n(t).(xj(t) - xi(t)) of the second primitive's points over the first one's are quadratic; where their Bernstein
// coefficients are positive, a turning plane is between the primitives all the time. Compared with a fixed direction,
// the turning one needs intervals of the order sqrt(distance) instead of distance where the primitives nearly graze.

#include "subdivision.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "exact_distance.hpp"

namespace fastccd::oracle {
namespace {

struct Moment {
    Dyadic time;
    IntegerPoints points;     // times a positive number that depends on time.level only
    IntegerVector direction;  // of the shortest vector

    bool touching() const {
        return std::ranges::all_of(direction, [](const mpz_class& c) { return sgn(c) == 0; });
    }
};

Moment moment_at(Kind kind, const IntegerPair& pair, const Dyadic& time) {
    const IntegerPoints points = pair.at(time);
    return {time, points, shortest_vector(kind, points).numerator};
}

mpz_class largest_component(const IntegerVector& v) {
    return std::max({mpz_class(abs(v[0])), mpz_class(abs(v[1])), mpz_class(abs(v[2]))});
}

// direction.(xj - xi)
mpz_class height(const IntegerVector& direction, const IntegerPoints& x, std::size_t i, std::size_t j) {
    mpz_class sum;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += direction[axis] * (x[j][axis] - x[i][axis]);
    return sum;
}

// Both moments must have the same time.level.
bool separated_between(Kind kind, const Moment& begin, const Moment& end) {
    // A mixture of two directions turns evenly, hence follows the shortest vector to second order, only if their
    // lengths are alike; the maximum norm serves.
    const mpz_class from_size = largest_component(begin.direction), to_size = largest_component(end.direction);
    IntegerVector from = begin.direction, to = end.direction;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        from[axis] *= to_size;
        to[axis] *= from_size;
    }
    const std::size_t first_size = kind == Kind::vertex_face ? 1 : 2;
    for (std::size_t i = 0; i < first_size; ++i) {
        for (std::size_t j = first_size; j < 4; ++j) {
            if (sgn(height(from, begin.points, i, j)) <= 0 || sgn(height(to, end.points, i, j)) <= 0) return false;
            if (sgn(height(from, end.points, i, j) + height(to, begin.points, i, j)) <= 0) return false;
        }
    }
    return true;
}

// The same moment with its time over 2^(level + 1).
Moment refined(Moment m) {
    m.time.numerator *= 2;
    ++m.time.level;
    for (IntegerVector& point : m.points) {
        for (mpz_class& c : point) c *= 2;
    }
    return m;
}

}  // namespace

Separation subdivide(Kind kind, const Pair& pair, double t_begin, double t_end, int depth, int max_intervals) {
    if (!is_finite(pair) || !(t_begin <= t_end)) throw std::invalid_argument("subdivide: not finite, or no interval");
    const IntegerPair scaled(pair);
    Dyadic first = to_dyadic(t_begin), last = to_dyadic(t_end);
    bring_to_common_level(first, last);

    struct Interval {
        Moment begin, end;
        int depth_left;
    };
    std::vector<Interval> pending;
    pending.push_back({moment_at(kind, scaled, first), moment_at(kind, scaled, last), depth});
    for (int looked_at = 0; !pending.empty(); ++looked_at) {
        const Interval interval = std::move(pending.back());
        pending.pop_back();
        if (interval.begin.touching() || interval.end.touching()) return Separation::not_excluded;
        if (separated_between(kind, interval.begin, interval.end)) continue;
        if (interval.depth_left == 0 || looked_at >= max_intervals) return Separation::not_excluded;
        const Dyadic middle{interval.begin.time.numerator + interval.end.time.numerator,
                            interval.begin.time.level + 1};
        const Moment half = moment_at(kind, scaled, middle);
        pending.push_back({half, refined(interval.end), interval.depth_left - 1});
        pending.push_back({refined(interval.begin), half, interval.depth_left - 1});
    }
    return Separation::certainly_apart;
}

}  // namespace fastccd::oracle
