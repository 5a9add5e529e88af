// Proofs over time intervals by the shortest vector between the primitives, in integers: along it two convex sets that are apart are strictly
// separated. So take it at both ends of an interval, and let n(t) go linearly from one to the other: the heights n(t).(xj(t) - xi(t)) of the
// second primitive's points over the first one's are quadratic, and what is less than their Bernstein coefficients is less than they are all the
// time. Compared with a fixed vector, the turning one needs intervals of the order sqrt(distance) instead of distance where the primitives
// nearly graze.
#pragma once

#include <gmpxx.h>

#include <utility>
#include <vector>

#include "exact_distance.hpp"

namespace fastccd::oracle {

struct Moment {
    Dyadic time;
    IntegerPoints points;  ///< Times 2^(exponent of the pair + time.level).
    ShortestVector shortest;
};

Moment moment_at(Kind kind, const IntegerPair& pair, const Dyadic& time);

/// n at both ends of an interval, whose moments have the same time.level. A mixture of two vectors turns evenly, hence follows the shortest one to
/// second order, only if their lengths are alike; the maximum norm serves.
struct TurningVector {
    TurningVector(const Moment& begin, const Moment& end);

    IntegerVector from, to;
};

/// The Bernstein coefficients of the height of xj over xi; the middle one doubled.
struct HeightCoefficients {
    mpz_class begin, doubled_middle, end;
};

HeightCoefficients height(const TurningVector& n, const Moment& begin, const Moment& end, std::size_t i, std::size_t j);

/// Whether `holds` for every point of the second primitive over every one of the first.
template <class Predicate>
bool every_height(Kind kind, const TurningVector& n, const Moment& begin, const Moment& end, Predicate holds) {
    const std::size_t first_size = kind == Kind::vertex_face ? 1 : 2;
    for (std::size_t i = 0; i < first_size; ++i) {
        for (std::size_t j = first_size; j < 4; ++j) {
            if (!holds(height(n, begin, end, i, j))) return false;
        }
    }
    return true;
}

/// The same moment with its time over 2^(level + 1).
Moment refined(Moment m);

enum class Shown {
    throughout,  ///< Proven on intervals that are together the whole.
    refuted,     ///< At some moment.
    not_shown,   ///< Within the limits.
};

/// Halves [t_begin, t_end] up to `depth` times, and looks at no more than `max_intervals`, until `proven(begin, end)` on every part, or
/// `refuted(moment)` at an end of one.
template <class Proven, class Refuted>
Shown show_by_halving(Kind kind, const IntegerPair& pair, Dyadic t_begin, Dyadic t_end, int depth, int max_intervals, Proven proven,
                      Refuted refuted) {
    bring_to_common_level(t_begin, t_end);
    struct Interval {
        Moment begin, end;
        int depth_left;
    };
    std::vector<Interval> pending;
    pending.push_back({moment_at(kind, pair, t_begin), moment_at(kind, pair, t_end), depth});
    if (refuted(pending[0].begin) || refuted(pending[0].end)) return Shown::refuted;
    for (int looked_at = 0; !pending.empty(); ++looked_at) {
        const Interval interval = std::move(pending.back());
        pending.pop_back();
        if (proven(interval.begin, interval.end)) continue;
        if (interval.depth_left == 0 || looked_at >= max_intervals) return Shown::not_shown;
        const Moment half = moment_at(kind, pair, {interval.begin.time.numerator + interval.end.time.numerator, interval.begin.time.level + 1});
        if (refuted(half)) return Shown::refuted;
        pending.push_back({half, refined(interval.end), interval.depth_left - 1});
        pending.push_back({refined(interval.begin), half, interval.depth_left - 1});
    }
    return Shown::throughout;
}

}  // namespace fastccd::oracle
