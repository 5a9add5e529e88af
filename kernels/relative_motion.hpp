// The motion of a pair relative to its point x0: r_i(t) = x_i(t) - x_0(t), i = 1, 2, 3.
//
// These are the paper's alpha, beta, gamma (eq. 8) and their partners at the end of the step.
// A vertex-face pair touches where the origin meets the triangle r1 r2 r3, an edge-edge pair where
// the segment 0 r1 meets the segment r2 r3. Differences first: a difference of two doubles has
// relative error at most u and never a wrong sign, however far the pair is from the origin.
#pragma once

#include <fastccd/options.hpp>
#include <lane.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Vectors at both ends of the searched interval, in the parameter s = t / t_max of [0, 1].
template <class L>
struct RelativeMotion {
    Vector3<L> start[3];
    Vector3<L> end[3];
};

/// p + s (q - p) as (1 - s) p + s q, which neither overflows nor cancels.
template <class L>
FASTCCD_INLINE L lerp(L p, L q, L s)
{
    return (broadcast<L>(1.0) - s) * p + s * q;
}

/// r_i at the parameter s of [0, 1].
template <class L>
FASTCCD_INLINE Vector3<L> position(const RelativeMotion<L>& r, int i, L s)
{
    return {lerp(r.start[i].x, r.end[i].x, s), lerp(r.start[i].y, r.end[i].y, s), lerp(r.start[i].z, r.end[i].z, s)};
}

/// The components of one batch's motion, from 24 coordinates in the order of PairView: at(c) are the lanes of number c. Each is asked for once,
/// in order, since some are transposed for it.
template <class L, class At>
class RelativeCoordinates {
public:
    FASTCCD_INLINE explicit RelativeCoordinates(const At& at) : at_{at} {}
    /// Of r_i, to be asked for in the order in which a RelativeMotion holds them.
    FASTCCD_INLINE L operator()(int end, int i, int axis)
    {
        if (i == 1 && axis == 0)
            for (int k = 0; k < 3; ++k) x0_[k] = at_(12 * end + k);
        return Lane<L>::difference(at_(12 * end + 3 * i + axis), x0_[axis]);
    }

private:
    At at_;
    L x0_[3];
};

/// component(end, i, axis), asked for in the order in which a RelativeMotion holds them.
template <class Component>
FASTCCD_INLINE auto motion_of(Component component)
{
    using L = decltype(component(0, 1, 0));
    const auto point = [&](int end, int i) FASTCCD_INLINE_LAMBDA {
        return Vector3<L>{component(end, i, 0), component(end, i, 1), component(end, i, 2)};
    };
    return RelativeMotion<L>{{point(0, 1), point(0, 2), point(0, 3)}, {point(1, 1), point(1, 2), point(1, 3)}};
}

/// t_max != 1 moves the end of the motion to t_max; error_bound.hpp accounts for that rounding.
template <class L, class At>
FASTCCD_INLINE RelativeMotion<L> relative_motion_of(const At& at, double t_max)
{
    RelativeCoordinates<L, At> read{at};
    RelativeMotion<L> r = motion_of([&](int end, int i, int axis) FASTCCD_INLINE_LAMBDA { return read(end, i, axis); });
    if (t_max != 1.0) {
        const L end = broadcast<L>(t_max);
        r = {{r.start[0], r.start[1], r.start[2]}, {position(r, 0, end), position(r, 1, end), position(r, 2, end)}};
    }
    return r;
}

/// Coordinates in rows: lane i of number c is rows[c * stride + i].
template <class L, class Number = double>
struct InRows {
    const Number* rows;
    int stride;

    FASTCCD_INLINE L operator()(int c) const { return Lane<L>::load(rows + c * stride); }
};

/// From coordinates[c * stride + lane].
template <class L>
FASTCCD_INLINE RelativeMotion<L> relative_motion(const double* coordinates, int stride, double t_max)
{
    return relative_motion_of<L>(InRows<L>{coordinates, stride}, t_max);
}

/// The motions of two batches, at[k](c) of batch k, combined component by component by combine(first, second), called in the order in which a
/// RelativeMotion holds them. Not batch by batch: all components of one would not fit into registers.
template <class L, class At, class Combine>
FASTCCD_INLINE auto combined_motion(const At (&at)[2], double t_max, Combine combine)
{
    RelativeCoordinates<L, At> first{at[0]}, second{at[1]};
    if (t_max == 1.0)
        return motion_of([&](int end, int i, int axis) FASTCCD_INLINE_LAMBDA { return combine(first(end, i, axis), second(end, i, axis)); });
    L starts[2][9];
    const auto moved = [&](RelativeCoordinates<L, At>& read, L(&start)[9], int end, int i, int axis) FASTCCD_INLINE_LAMBDA {
        const L there = read(end, i, axis);
        L& from = start[3 * (i - 1) + axis];
        if (end == 0) from = there;
        return end == 0 ? there : lerp(from, there, broadcast<L>(t_max));
    };
    return motion_of([&](int end, int i, int axis) FASTCCD_INLINE_LAMBDA {
        return combine(moved(first, starts[0], end, i, axis), moved(second, starts[1], end, i, axis));
    });
}

/// The same in the lane type S that pairs are screened in: L, or one of single precision, whose lanes hold two batches of L. Differences are
/// rounded to S at the end: by at most u X once more, with its u.
template <class S, class L, class At, std::size_t part_count>
FASTCCD_INLINE RelativeMotion<S> relative_motion_in(const At (&at)[part_count], double t_max)
{
    if constexpr (!Lane<S>::is_single)
        return relative_motion_of<L>(at[0], t_max);
    else
        return combined_motion<L>(at, t_max, [](L low, L high) FASTCCD_INLINE_LAMBDA { return Lane<L>::narrowed(low, high); });
}

/// Largest |component| per axis over r1, r2, r3 and both ends: the scale of every rounding error.
/// Per axis, so that anisotropic pairs keep tight bounds: each term of the polynomials of this
/// library is a product of components along different axes.
template <class L>
struct Extents {
    L x, y, z;
};

template <class L>
FASTCCD_INLINE Extents<L> extents(const RelativeMotion<L>& r)
{
    const auto along = [&](auto component) FASTCCD_INLINE_LAMBDA {
        const auto largest = [&](const Vector3<L>(&v)[3]) FASTCCD_INLINE_LAMBDA {
            return max(abs(component(v[0])), abs(component(v[1])), abs(component(v[2])));
        };
        return max(largest(r.start), largest(r.end));
    };
    return {along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.x; }),
            along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.y; }),
            along([](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA { return v.z; })};
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
