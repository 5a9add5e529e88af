// One look at a time that answers for all intervals around it.
//
// Intervals on the way down to a contact have no certificate, and to find that out takes all of them. Where the pair meets at s, or
// comes as close to it as rounding can tell, values at s contradict each certificate on any interval that contains s: a value at s
// lies between the coefficients on the interval, which would all have to be beyond a bound.
//
// Both are computed. One lerp errs by 3 u M at most, M the larger magnitude of its operands: by u M of both products, (1 - s) M + s M in
// size, by u M of their sum, and by u / 2 M as 1 - s is rounded; the rest is for terms in u^2 and for what is rounded below. Blossoms of n
// levels err by 3 n u C, C the largest coefficient on [0, 1]. So if all coefficients that the search computes on an interval are beyond
// its bound, a value computed at s within is beyond that bound less twice that much. It is not: so they are not.
#pragma once

#include <algorithm>
#include <cmath>

#include <interval_certificates.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

/// How far a value at s may lie outside of the coefficients on an interval that contains s, both computed.
inline double value_margin(const Cubic<double>& f)
{
    return 2 * 9 * ErrorBounds::u * std::max({std::abs(f.c0), std::abs(f.c1), std::abs(f.c2), std::abs(f.c3)});
}
inline double value_margin(const Quadratic<double>& q)
{
    return 2 * 6 * ErrorBounds::u * std::max({std::abs(q.c0), std::abs(q.c1), std::abs(q.c2)});
}

/// A vertex along an axis, from start to end.
struct AxisMotion {
    double start, end;

    [[nodiscard]] double at(double s) const { return lerp(start, end, s); }
    [[nodiscard]] double largest() const { return std::max(std::abs(start), std::abs(end)); }
    friend bool operator==(const AxisMotion&, const AxisMotion&) = default;
};

/// The same for the difference of two positions, and those at the ends of the interval. Each position errs by 3 u of its larger
/// magnitude, the difference by u of both, at one time; those of equal motions are equal.
inline double value_margin(const AxisMotion& p, const AxisMotion& q)
{
    return p == q ? 0.0 : 2 * 4 * ErrorBounds::u * (p.largest() + q.largest());
}

template <PairKind kind>
class Meeting {
public:
    explicit Meeting(const PairCoefficients& coefficients) : pair{coefficients} {}

    /// True if no interval that contains s has one of the three certificates (apart_on), rounding included.
    [[nodiscard]] bool at(double s) const
    {
        if (!may_be_coplanar(s)) return false;
        for (const auto& edges : pair.edges)
            if (!may_touch_in_projection(edges, s)) return false;
        return may_overlap(0, s) && may_overlap(1, s) && may_overlap(2, s);
    }

private:
    [[nodiscard]] bool may_be_coplanar(double s) const
    {
        const Cubic<double> f{pair.cubic[0], pair.cubic[1], pair.cubic[2], pair.cubic[3]};
        return std::abs(on_interval(f, s, s).c0) + value_margin(f) <= pair.cubic_bound;
    }

    /// As apart_along, with the signs that edge functions may have throughout an interval.
    [[nodiscard]] static bool may_touch_in_projection(const PairCoefficients::EdgeFunction* edges, double s)
    {
        bool positive[4] = {}, negative[4] = {};
        for (int i = 0; i < (kind == PairKind::vertex_face ? 3 : 4); ++i) {
            const Quadratic<double> q{edges[i].start, edges[i].middle, edges[i].end};
            const double value = on_interval(q, s, s).c0, needed = edges[i].bound - value_margin(q);
            positive[i] = needed < value;
            negative[i] = value < -needed;
        }
        if constexpr (kind == PairKind::vertex_face)
            return !(positive[0] || positive[1] || positive[2]) || !(negative[0] || negative[1] || negative[2]);
        else
            return !((positive[0] && positive[2]) || (negative[0] && negative[2]) || (positive[1] && positive[3]) ||
                     (negative[1] && negative[3]));
    }

    /// As separated_on along one axis: some vertex of the second primitive is not above, and some not below, some of the first.
    [[nodiscard]] bool may_overlap(int axis, double s) const
    {
        const auto motion = [&](int i) { return AxisMotion{pair.start[i][axis], pair.end[i][axis]}; };
        const AxisMotion first[] = {{0.0, 0.0}, motion(0)};
        constexpr int vertices_of_first = kind == PairKind::vertex_face ? 1 : 2;
        bool above = true, below = true;
        for (int i = 0; i < vertices_of_first; ++i)
            for (int j = vertices_of_first - 1; j < 3; ++j) {
                const AxisMotion second = motion(j);
                const double gap = second.at(s) - first[i].at(s), needed = pair.gap_bound[axis] - value_margin(first[i], second);
                above = above && needed < gap;
                below = below && gap < -needed;
            }
        return !above && !below;
    }

    const PairCoefficients& pair;
};

}  // namespace fastccd::scalar
