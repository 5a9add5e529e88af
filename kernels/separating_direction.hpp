// A unit vector along which two primitives are about as far apart as they are in space, and how far that is.
//
// The distance of two convex sets is the largest of min n . (b - a) over unit vectors n, with a and b the vertices of
// the first and the second one: any n gives a lower bound, the one along the shortest vector between them the distance
// itself. So no proof rests on the accuracy of what is computed here. Two vectors are tried, and the one with the larger
// bound is taken: the normal of the face, or of both edges, which is no difference of nearby points and so is accurate
// however close the primitives are; and the shortest vector to a side of the face, or to an end of an edge, made
// perpendicular to that side once more because it is such a difference.
#pragma once

#include <fastccd/options.hpp>

#include <coplanarity.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class L>
FASTCCD_INLINE Vector3<L> scaled(const Vector3<L>& v, L factor)
{
    return {v.x * factor, v.y * factor, v.z * factor};
}

template <class L>
FASTCCD_INLINE Vector3<L> select(LaneMask<L> m, const Vector3<L>& yes, const Vector3<L>& no)
{
    return {select<L>(m, yes.x, no.x), select<L>(m, yes.y, no.y), select<L>(m, yes.z, no.z)};
}

/// x within [0, 1]; 0 for NaN, which a side of length 0 gives (max takes its second operand).
template <class L>
FASTCCD_INLINE L clamped(L x)
{
    return min(max(x, broadcast<L>(0.0)), broadcast<L>(1.0));
}

template <class L>
FASTCCD_INLINE LaneMask<L> inside_unit(L x)
{
    return less(broadcast<L>(0.0), x) & less(x, broadcast<L>(1.0));
}

/// v minus its part along `side`, whose square has the reciprocal `inverse_square`, where `m`; v itself elsewhere.
template <class L>
FASTCCD_INLINE Vector3<L> perpendicular_where(LaneMask<L> m, const Vector3<L>& v, const Vector3<L>& side, L inverse_square)
{
    return select(m, subtract(v, scaled(side, dot(v, side) * inverse_square)), v);
}

template <class L>
struct ShortestVector {
    Vector3<L> side_normal;  ///< Perpendicular to the side it ends on, where it ends inside one.
    L square;                ///< Square of its length before that: of a vector between two points of the primitives.
};

/// From the origin to the nearest of the sides of the triangle r1 r2 r3.
template <class L>
FASTCCD_INLINE ShortestVector<L> to_nearest_side(const Vector3<L> (&r)[3], const Vector3<L> (&side)[3])
{
    struct OnSide {
        Vector3<L> q, side;
        L square, t, inverse_square;
    };
    const L zero = broadcast<L>(0.0), squares[3] = {dot(r[0], r[0]), dot(r[1], r[1]), dot(r[2], r[2])};
    // From the nearer end: from the other, a corner close by would be off by the rounding of the whole side.
    const auto nearest_on = [&](int i) FASTCCD_INLINE_LAMBDA -> OnSide {
        const int j = (i + 1) % 3;
        const LaneMask<L> from_second = less(squares[j], squares[i]);
        const Vector3<L> end = select(from_second, r[j], r[i]);
        const L inverse_square = broadcast<L>(1.0) / dot(side[i], side[i]), at_end = dot(end, side[i]) * inverse_square;
        const L t = clamped(select<L>(from_second, at_end, zero - at_end));
        const Vector3<L> q = add(end, scaled(side[i], select<L>(from_second, zero - t, t)));
        return {q, side[i], dot(q, q), t, inverse_square};
    };
    const auto nearer = [](const OnSide& a, const OnSide& b) FASTCCD_INLINE_LAMBDA -> OnSide {
        const LaneMask<L> second = less(b.square, a.square);
        return {select(second, b.q, a.q), select(second, b.side, a.side), select<L>(second, b.square, a.square),
                select<L>(second, b.t, a.t), select<L>(second, b.inverse_square, a.inverse_square)};
    };
    const OnSide nearest = nearer(nearer(nearest_on(0), nearest_on(1)), nearest_on(2));
    return {perpendicular_where<L>(inside_unit(nearest.t), nearest.q, nearest.side, nearest.inverse_square), nearest.square};
}

/// From the segment 0 r1 to the segment r2 r3 = r2 + [0, 1] v: the minimum over both parameters, or, where that is
/// outside, over one after the other (Ericson, "Real-Time Collision Detection", 5.1.9).
template <class L>
FASTCCD_INLINE ShortestVector<L> between_edges(const Vector3<L> (&r)[3], const Vector3<L>& v)
{
    const Vector3<L>& u = r[0];
    const Vector3<L>& w = r[1];
    const L uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const L inverse_uu = broadcast<L>(1.0) / uu, inverse_vv = broadcast<L>(1.0) / vv;
    const L unbounded = clamped((uw * vv - uv * vw) / (uu * vv - uv * uv));
    const L t = clamped((unbounded * uv - vw) * inverse_vv);
    const L s = clamped((uw + t * uv) * inverse_uu);
    const Vector3<L> q = subtract(add(w, scaled(v, t)), scaled(u, s));
    const LaneMask<L> on_first = inside_unit(s), on_second = inside_unit(t);
    const Vector3<L> from_first = perpendicular_where<L>(on_first & !on_second, q, u, inverse_uu);
    return {perpendicular_where<L>(on_second & !on_first, from_first, v, inverse_vv), dot(q, q)};
}

/// Square of the distance from the origin to the point where the normal through it meets the triangle; +infinity if it
/// does not. The weights of the corners need not be accurate: with any positive ones it is a point of the triangle. +infinity or NaN, too, where
/// their sum is so small (2^-1024 and less) that its reciprocal is infinite.
template <class L>
FASTCCD_INLINE L square_to_inside(const Vector3<L> (&r)[3], const Vector3<L>& normal)
{
    const L a = dot(normal, cross(r[1], r[2])), b = dot(normal, cross(r[2], r[0])), c = dot(normal, cross(r[0], r[1]));
    const LaneMask<L> inside = less(broadcast<L>(0.0), min(a, b, c));
    const L inverse = broadcast<L>(1.0) / ((a + b) + c);
    const Vector3<L> q = add(add(scaled(r[0], a * inverse), scaled(r[1], b * inverse)), scaled(r[2], c * inverse));
    return select<L>(inside, dot(q, q), broadcast<L>(__builtin_inf()));
}

/// Below this square of its length a vector is not scaled to a unit vector: products might have underflowed.
inline constexpr double smallest_square = 0x1p-600;

template <class L>
struct Separation {
    Vector3<L> n;      ///< Unit vector from the first to the second primitive; 0 where they touch.
    L gap;             ///< Lower bound of the distance along it, to within rounding.
    L square_to_side;  ///< See square_distance.
};

/// Least heights of the second primitive over the first along v and along -v.
template <class L>
struct Gaps {
    L along, against;
};

template <PairKind kind, class L>
FASTCCD_INLINE Gaps<L> gaps(const Vector3<L>& v, const Vector3<L> (&r)[3])
{
    const L zero = broadcast<L>(0.0), h1 = dot(v, r[0]), h2 = dot(v, r[1]), h3 = dot(v, r[2]);
    if constexpr (kind == PairKind::vertex_face)
        return {min(h1, h2, h3), zero - max(h1, h2, h3)};
    else
        return {min(h2, h3) - max(h1, zero), min(h1, zero) - max(h2, h3)};
}

/// Of the primitives in one position; all components finite and in the range of separation_bound.hpp.
template <PairKind kind, class L>
FASTCCD_INLINE Separation<L> separation(const Vector3<L> (&r)[3])
{
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    ShortestVector<L> shortest;
    Vector3<L> normal;
    if constexpr (kind == PairKind::vertex_face) {
        const Vector3<L> side[3] = {subtract(r[1], r[0]), subtract(r[2], r[1]), subtract(r[0], r[2])};
        shortest = to_nearest_side(r, side);
        normal = cross(side[0], side[1]);
    } else {
        const Vector3<L> second = subtract(r[2], r[1]);
        shortest = between_edges(r, second);
        normal = cross(r[0], second);
    }
    const Gaps<L> of_normal = gaps<kind>(normal, r);
    const L gap = max(gaps<kind>(shortest.side_normal, r).along, zero);
    const L normal_gap = max(max(of_normal.along, of_normal.against), zero);
    const L normal_square = dot(normal, normal), square = dot(shortest.side_normal, shortest.side_normal);
    // normal_gap / |normal| > gap / |q|, squared and multiplied out
    const LaneMask<L> along_normal = less(broadcast<L>(smallest_square), normal_square) &
                                     less((gap * gap) * normal_square, (normal_gap * normal_gap) * square);
    const Vector3<L> v = select(along_normal, normal, shortest.side_normal);
    const L v_square = select<L>(along_normal, normal_square, square);
    const L sign = select<L>(along_normal & less(of_normal.along, of_normal.against), zero - one, one);
    const L inverse = select<L>(less(broadcast<L>(smallest_square), v_square), sign / sqrt(v_square), zero);
    return {scaled(v, inverse), select<L>(along_normal, normal_gap, gap) * abs(inverse), shortest.square};
}

/// Square of the distance of two points, one of each primitive (SeparationBounds::distance): the nearest ones, or of edges that are nearly
/// parallel, to within rounding, some others.
template <PairKind kind, class L>
FASTCCD_INLINE L square_distance(const Vector3<L> (&r)[3], const Separation<L>& seen)
{
    if constexpr (kind == PairKind::edge_edge)
        return seen.square_to_side;
    else
        return min(square_to_inside(r, cross(subtract(r[1], r[0]), subtract(r[2], r[1]))), seen.square_to_side);  // of a NaN, the second
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
