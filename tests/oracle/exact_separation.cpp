// As in subdivision.cpp, with a distance: let n(t) go linearly from the shortest vector at the begin of an interval to the one
// at its end. The heights n(t).(xj(t) - xi(t)) of the second primitive's points over the first one's are quadratic. Where
// their Bernstein coefficients exceed those of d times a linear bound of |n(t)|, the distance exceeds d: |n(t)| is convex, so
// it is at most what goes linearly from |n| at the begin to |n| at the end.

#include "exact_separation.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "exact_distance.hpp"

namespace fastccd::oracle {
namespace {

// Lengths are irrational: integers above them, in units of 2^-norm_bits, so close that no test notices.
constexpr mp_bitcnt_t norm_bits = 128;

mpz_class square(const IntegerVector& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

mpz_class norm_above(const IntegerVector& v) {
    const mpz_class shifted = square(v) << (2 * norm_bits);
    return sqrt(shifted) + 1;
}

// direction.(xj - xi)
mpz_class height(const IntegerVector& direction, const IntegerPoints& x, std::size_t i, std::size_t j) {
    mpz_class sum;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += direction[axis] * (x[j][axis] - x[i][axis]);
    return sum;
}

struct Moment {
    Dyadic time;
    IntegerPoints points;  // times 2^(exponent + time.level)
    ShortestVector shortest;
};

class Prover {
public:
    Prover(Kind kind, const Pair& pair, double d) : kind_(kind), pair_(pair), d_(to_dyadic(d)) {}

    Moment moment_at(const Dyadic& time) const {
        const IntegerPoints points = pair_.at(time);
        return {time, points, shortest_vector(kind_, points)};
    }

    // |numerator| / denominator <= d 2^(exponent + level), squared and multiplied out
    bool within(const Moment& m) const {
        mpz_class left = square(m.shortest.numerator), right = d_.numerator * m.shortest.denominator;
        right *= right;
        const long shift = 2 * (scale(m) - static_cast<long>(d_.level));
        if (shift >= 0) {
            right <<= static_cast<mp_bitcnt_t>(shift);
        } else {
            left <<= static_cast<mp_bitcnt_t>(-shift);
        }
        return left <= right;
    }

    // Both moments have the same time.level.
    bool farther_between(const Moment& begin, const Moment& end) const {
        // A mixture of two vectors turns evenly only if their lengths are alike; the maximum norm serves.
        const mpz_class begin_size = largest(begin.shortest.numerator), end_size = largest(end.shortest.numerator);
        const IntegerVector from = times(end_size, begin.shortest.numerator), to = times(begin_size, end.shortest.numerator);
        const mpz_class from_norm = norm_above(from), to_norm = norm_above(to);
        const std::size_t first_size = kind_ == Kind::vertex_face ? 1 : 2;
        for (std::size_t i = 0; i < first_size; ++i) {
            for (std::size_t j = first_size; j < 4; ++j) {
                if (!exceeds(height(from, begin.points, i, j), from_norm, begin)) return false;
                if (!exceeds(height(to, end.points, i, j), to_norm, begin)) return false;
                if (!exceeds(height(from, end.points, i, j) + height(to, begin.points, i, j), from_norm + to_norm, begin)) return false;
            }
        }
        return true;
    }

private:
    long scale(const Moment& m) const { return pair_.exponent + static_cast<long>(m.time.level); }

    static mpz_class largest(const IntegerVector& v) {
        return std::max({mpz_class(abs(v[0])), mpz_class(abs(v[1])), mpz_class(abs(v[2]))});
    }
    static IntegerVector times(const mpz_class& s, const IntegerVector& v) { return {s * v[0], s * v[1], s * v[2]}; }

    // height > d norm, in the units of `m`
    bool exceeds(const mpz_class& height, const mpz_class& norm, const Moment& m) const {
        mpz_class left = height << norm_bits, right = d_.numerator * norm;
        const long shift = scale(m) - static_cast<long>(d_.level);
        if (shift >= 0) {
            right <<= static_cast<mp_bitcnt_t>(shift);
        } else {
            left <<= static_cast<mp_bitcnt_t>(-shift);
        }
        return left > right;
    }

    Kind kind_;
    IntegerPair pair_;
    Dyadic d_;
};

// The same moment with its time over 2^(level + 1).
Moment refined(Moment m) {
    m.time.numerator *= 2;
    ++m.time.level;
    for (IntegerVector& point : m.points) {
        for (mpz_class& c : point) c *= 2;
    }
    for (mpz_class& c : m.shortest.numerator) c *= 2;
    return m;
}

}  // namespace

Farther farther_throughout(Kind kind, const Pair& pair, double d, double t_begin, double t_end, int depth, int max_intervals) {
    if (!is_finite(pair) || !(t_begin <= t_end) || !(d >= 0.0)) throw std::invalid_argument("farther_throughout: not finite, or no interval");
    const Prover prover(kind, pair, d);
    Dyadic first = to_dyadic(t_begin), last = to_dyadic(t_end);
    bring_to_common_level(first, last);

    struct Interval {
        Moment begin, end;
        int depth_left;
    };
    std::vector<Interval> pending;
    pending.push_back({prover.moment_at(first), prover.moment_at(last), depth});
    if (prover.within(pending[0].begin) || prover.within(pending[0].end)) return Farther::closer;
    for (int looked_at = 0; !pending.empty(); ++looked_at) {
        const Interval interval = std::move(pending.back());
        pending.pop_back();
        if (prover.farther_between(interval.begin, interval.end)) continue;
        if (interval.depth_left == 0 || looked_at >= max_intervals) return Farther::not_shown;
        const Moment half = prover.moment_at({interval.begin.time.numerator + interval.end.time.numerator, interval.begin.time.level + 1});
        if (prover.within(half)) return Farther::closer;
        pending.push_back({half, refined(interval.end), interval.depth_left - 1});
        pending.push_back({refined(interval.begin), half, interval.depth_left - 1});
    }
    return Farther::certainly;
}

}  // namespace fastccd::oracle
