// Certificates of a distance above d over time intervals.
//
// For a vector n, |n| <= 1, the heights n . (b(s) - a(s)) of the vertices b of the second primitive over the vertices a
// of the first are linear in s, and the least of them is a lower bound of the distance at s. So one n gives the interval
// of all s at which it proves a distance above d (Reach); a coordinate axis is such an n. Where the primitives turn, a
// vector that turns with them proves more: n(s) linear between two unit vectors, |n(s)| <= 1, gives quadratic heights,
// and these exceed d where their Bernstein coefficients do.
#pragma once

#include <certificates.hpp>
#include <feature_directions.hpp>
#include <separation_bound.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class L>
FASTCCD_INLINE L largest(const Extents<L>& e)
{
    return max(e.x, e.y, e.z);
}

template <class L>
FASTCCD_INLINE L sum(const Extents<L>& e)
{
    return (e.x + e.y) + e.z;
}

/// True where all components are finite and the extents within the range of separation_bound.hpp. A NaN or an
/// infinity makes the sum of all components one too, finite ones within the range cannot.
template <class L>
FASTCCD_INLINE LaneMask<L> in_separation_range(const RelativeMotion<L>& r, const Extents<L>& e)
{
    const auto components = [](const Vector3<L>(&v)[3]) FASTCCD_INLINE_LAMBDA {
        const Vector3<L> all = add(add(v[0], v[1]), v[2]);
        return (all.x + all.y) + all.z;
    };
    return less(abs(components(r.start) + components(r.end)), broadcast<L>(0x1p5 * largest_separation_extent)) &
           less(largest(e), broadcast<L>(largest_separation_extent)) &
           less_equal(broadcast<L>(smallest_separation_extent), largest(e));
}

/// Heights above this prove a distance above d; `bound` is one of SeparationBounds.
template <class L>
FASTCCD_INLINE L threshold_along(const Vector3<L>& n, const Extents<L>& e, const SeparationParameters& parameters, double bound)
{
    const L s = (abs(n.x) * e.x + abs(n.y) * e.y) + abs(n.z) * e.z;
    return (broadcast<L>(parameters.threshold) + broadcast<L>(bound) * s) + broadcast<L>(separation_floor);
}

/// A computed gap above this is certified at its time.
template <class L>
FASTCCD_INLINE L surely_certified(const Extents<L>& e, const SeparationParameters& parameters)
{
    return broadcast<L>(parameters.threshold) + broadcast<L>(SeparationBounds::surely_certified()) * sum(e);
}

/// Calls visit(height) for each pair of vertices, with the height of the second over the first; height(i) gives that of
/// r_i (i = 0, 1, 2) over the origin.
template <PairKind kind, class Height, class Visit>
FASTCCD_INLINE void for_each_height(Height height, Visit visit)
{
    if constexpr (kind == PairKind::vertex_face) {
        visit(height(0)), visit(height(1)), visit(height(2));
    } else {
        const auto h1 = height(0), h2 = height(1), h3 = height(2);
        visit(h2), visit(h3), visit(h2 - h1), visit(h3 - h1);
    }
}

/// The times in (low, high) are certified; none where low > high.
template <class L>
struct Reach {
    L low, high;
};

/// Whether it is certified at `time`.
template <class L>
FASTCCD_INLINE LaneMask<L> certified_at(const Reach<L>& reach, L time)
{
    return less(reach.low, time) & less(time, reach.high);
}

/// Value at both ends of the whole interval.
template <class L>
struct Ends {
    L start, end;

    friend FASTCCD_INLINE Ends operator-(const Ends& a, const Ends& b) { return {a.start - b.start, a.end - b.end}; }
};

/// All times of [0, 1] at which n proves a distance above d; all of it: low = -1, high = 2.
/// With x and y a height's excess over the threshold at both ends, positive before or after the time x / (x - y). The
/// excess, a rounded difference, errs by u relative to itself, and so does each of the difference and the quotient: 4 u
/// of the time, made up for by 2^-50 of it.
template <PairKind kind, class L>
FASTCCD_INLINE Reach<L> reach(const RelativeMotion<L>& r, const Vector3<L>& n, L threshold)
{
    const L zero = broadcast<L>(0.0);
    Reach<L> reach{broadcast<L>(-1.0), broadcast<L>(2.0)};
    for_each_height<kind>(
        [&](int i) FASTCCD_INLINE_LAMBDA { return Ends<L>{dot(n, r.start[i]), dot(n, r.end[i])}; },
        [&](const Ends<L>& height) FASTCCD_INLINE_LAMBDA {
            const L x = height.start - threshold, y = height.end - threshold;
            const LaneMask<L> at_start = less(zero, x), at_end = less(zero, y);
            const L crossing = x / (x - y);
            const L high = select<L>(at_end, broadcast<L>(2.0), crossing * broadcast<L>(1.0 - 0x1p-50));
            const L low = select<L>(at_start, broadcast<L>(-1.0), crossing * broadcast<L>(1.0 + 0x1p-50));
            const LaneMask<L> some = at_start | at_end;
            reach.low = max(reach.low, select<L>(some, low, broadcast<L>(2.0)));
            reach.high = min(reach.high, select<L>(some, high, broadcast<L>(-1.0)));
        });
    return reach;
}

template <class L>
struct Positions {
    Vector3<L> r[3];
};

template <class L>
FASTCCD_INLINE Positions<L> positions(const RelativeMotion<L>& r, L time)
{
    return {{position(r, 0, time), position(r, 1, time), position(r, 2, time)}};
}

/// What is seen of a pair at one time.
template <class L>
struct LookResult {
    Positions<L> at;
    Separation<L> separation;
    Reach<L> reach;
};

template <PairKind kind, class L>
FASTCCD_INLINE LookResult<L> look(const RelativeMotion<L>& r, const Extents<L>& e, L time, const SeparationParameters& parameters,
                                  const SeparationBounds& bounds)
{
    LookResult<L> seen;
    seen.at = positions(r, time);
    seen.separation = separation_beyond<kind>(seen.at.r, surely_certified(e, parameters));
    const Vector3<L>& n = seen.separation.n;
    seen.reach = reach<kind>(r, n, threshold_along(n, e, parameters, bounds.height(kind)));
    return seen;
}

/// The vector that turns evenly from the unit vector n, where the positions are a, to m where they are b, proves a distance above d in
/// between. Coefficients of a height: n . r(a), (n . r(b) + m . r(a)) / 2, m . r(b).
template <PairKind kind, class L>
FASTCCD_INLINE LaneMask<L> farther_while_turning(const Vector3<L> (&a)[3], const Vector3<L> (&b)[3], const Extents<L>& e, const Vector3<L>& n,
                                                 const Vector3<L>& m, const SeparationParameters& parameters, const SeparationBounds& bounds)
{
    const L from = threshold_along(n, e, parameters, bounds.height_at(kind));
    const L to = threshold_along(m, e, parameters, bounds.height_at(kind));
    struct Coefficients {
        L first, middle_n, middle_m, last;

        FASTCCD_INLINE Coefficients operator-(const Coefficients& other) const
        {
            return {first - other.first, middle_n - other.middle_n, middle_m - other.middle_m, last - other.last};
        }
    };
    LaneMask<L> all = all_lanes<L>();
    for_each_height<kind>(
        [&](int i) FASTCCD_INLINE_LAMBDA -> Coefficients {
            return {dot(n, a[i]), dot(n, b[i]), dot(m, a[i]), dot(m, b[i])};
        },
        [&](const Coefficients& c) FASTCCD_INLINE_LAMBDA {
            all = all & less(from, c.first) & less(from + to, c.middle_n + c.middle_m) & less(to, c.last);
        });
    return all;
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
