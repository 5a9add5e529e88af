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

/// From 24 coordinates in the order of PairView, at(c) the lanes of number c.
/// t_max != 1 moves the end of the motion to t_max; error_bound.hpp accounts for that rounding.
template <class L, class At>
FASTCCD_INLINE RelativeMotion<L> relative_motion_of(const At& at, double t_max)
{
    const auto relative = [&](int end, int i) FASTCCD_INLINE_LAMBDA {
        const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
            return Lane<L>::difference(at(12 * end + 3 * i + axis), at(12 * end + axis));
        };
        return Vector3<L>{along(0), along(1), along(2)};
    };
    RelativeMotion<L> r{{relative(0, 1), relative(0, 2), relative(0, 3)}, {relative(1, 1), relative(1, 2), relative(1, 3)}};
    if (t_max != 1.0) {
        const L end = broadcast<L>(t_max);
        r = {{r.start[0], r.start[1], r.start[2]}, {position(r, 0, end), position(r, 1, end), position(r, 2, end)}};
    }
    return r;
}

/// From coordinates[c * stride + lane].
template <class L>
FASTCCD_INLINE RelativeMotion<L> relative_motion(const double* coordinates, int stride, double t_max)
{
    return relative_motion_of<L>([=](int c) FASTCCD_INLINE_LAMBDA { return Lane<L>::load(coordinates + c * stride); }, t_max);
}

/// The motions of two batches, of coordinates parts[k][c * stride + lane], combined component by component by combine(first, second),
/// called in the order in which a RelativeMotion holds them. Not batch by batch: all components of one would not fit into registers.
template <class L, class Combine>
FASTCCD_INLINE auto combined_motion(const double* const (&parts)[2], int stride, double t_max, Combine combine)
{
    using Combined = decltype(combine(L{}, L{}));
    const auto motion = [&](auto component) FASTCCD_INLINE_LAMBDA -> RelativeMotion<Combined> {
        const auto point = [&](int end, int i) FASTCCD_INLINE_LAMBDA -> Vector3<Combined> {
            const auto along = [&](int axis) FASTCCD_INLINE_LAMBDA {
                return combine(component(parts[0], end, i, axis), component(parts[1], end, i, axis));
            };
            return {along(0), along(1), along(2)};
        };
        return {{point(0, 1), point(0, 2), point(0, 3)}, {point(1, 1), point(1, 2), point(1, 3)}};
    };
    const auto difference = [&](const double* part, int end, int i, int axis) FASTCCD_INLINE_LAMBDA {
        const double* const at = part + (12 * end + axis) * stride;
        return Lane<L>::difference(Lane<L>::load(at + 3 * i * stride), Lane<L>::load(at));
    };
    if (t_max == 1.0) return motion(difference);
    return motion([&](const double* part, int end, int i, int axis) FASTCCD_INLINE_LAMBDA {
        const L start = difference(part, 0, i, axis);
        return end == 0 ? start : lerp(start, difference(part, 1, i, axis), broadcast<L>(t_max));
    });
}

/// The same in the lane type S that pairs are screened in: L, or one of single precision, whose lanes hold two batches of L. Lanes of part k
/// are of parts[k][c * stride + lane]. Differences are rounded to S at the end: by at most u X once more, with its u.
template <class S, class L, std::size_t part_count>
FASTCCD_INLINE RelativeMotion<S> relative_motion_in(const double* const (&parts)[part_count], int stride, double t_max)
{
    if constexpr (!Lane<S>::is_single)
        return relative_motion<L>(parts[0], stride, t_max);
    else
        return combined_motion<L>(parts, stride, t_max, [](L low, L high) FASTCCD_INLINE_LAMBDA { return Lane<L>::narrowed(low, high); });
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
