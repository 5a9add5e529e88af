// Of all features of two primitives, the direction that shows the largest distance: the distance itself, to within rounding, whatever
// their shape.
//
// The vectors from points of the first primitive to points of the second one make up a polygon with a point (vertex-face: the triangle r1 r2
// r3; edge-edge: the parallelogram of r2, r3 and both less r1), and n proves the least of n . p over its corners p. If n is off by an angle e,
// corners sink by e times as far as they are from the nearest point, and the vector of length D between the nearest points, off by c u S,
// is turned by c u S / D: so separation() may show as little as D - sqrt(u) S where a shape is nearly degenerate. Where two sides are nearly
// parallel, their normal is worse, and the nearest side is not to be told from the others.
//
// All corners, sides and the plane are asked here, with vectors that are perpendicular to their sides to within rounding, however small what is
// left of them: what lies on a feature does not sink then. The best of them proves D - 64 u S, with S the sum of the extents of the position (largest
// |component| of r1, r2, r3; of the pair, where sides are too short to be told from none), if D > 160 u S; otherwise there is nothing to prove but
// that. With h = 10 u S, and w the width of the polygon beside its longest side (largest distance of a corner from that line):
//
// - Nearest point a corner p: n = p / |p|, a difference of what is given, is off by some u. No corner is lower than p. (The shortest vector of
//   separation() is as good in all positions tried, but of nearly parallel edges not by a proof.)
// - On a side: perpendicular_to() is off by h, e = h / D. Other corners lie y beside the plane of n and the side, and z >= 0 above it, and sink
//   by e y: nothing sinks below the side where e y <= z. Where not, the polygon rises from the side by less than e: if w^2 > h D, the normal of the plane,
//   off by h / w < sqrt(h / D), is turned from n by less than h / D more, so D sinks by (h / D + sqrt(h / D))^2 D / 2 < 0.8 h; if not,
//   perpendicular_to() the longest side, which passes the nearest point within w and e w more: D sinks by (w + h)^2 / (2 D) < 0.8 h, and e w < h / 4.
// - In the plane: if w^2 > h D, the normal again, and D sinks by h / 2. If not, perpendicular_to() the longest side: the nearest point lies
//   x <= w beside it, and corners sink by (x (w - x) + x^2 / 2) / D, at most h / 2, and by e w, at most h / 4.
//
// h: with p at most 2 S long (edge-edge; a difference), the side is off by u, one pass of perpendicular_to() by 2 u of p across the side
// and 10 u along it, of which the second pass leaves 6 u of the result: 5 u p = 10 u S across. The product in normal_to() is of vectors that are
// perpendicular to within 7 u, so it errs by 4 u of its length and is perpendicular to its first side a to within 5 u; to its second one b,
// which is a multiple of a, no longer than b, and `beside` and rounding of 5 u, to within 15 u. With sides of 2 S at most, corners of the plane are
// as high as the nearest point but for 40 u S.
#pragma once

#include <separating_direction.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// 1 / x; 0 where x is the square of a length that counts as none.
template <class L>
FASTCCD_INLINE L reciprocal_of_square(L x)
{
    return select<L>(less(broadcast<L>(smallest_square), x), broadcast<L>(1.0) / x, broadcast<L>(0.0));
}

/// v minus its part along `side`, twice: once leaves what v is rounded by along it, which may be more than all else that is left.
template <class L>
FASTCCD_INLINE Vector3<L> perpendicular_to(const Vector3<L>& side, const Vector3<L>& v)
{
    const L inverse = reciprocal_of_square(dot(side, side));
    const Vector3<L> once = subtract(v, scaled(side, dot(v, side) * inverse));
    return subtract(once, scaled(side, dot(once, side) * inverse));
}

/// Perpendicular to two sides, however small the angle between them: to the first one and to what the second one has beside that.
template <class L>
FASTCCD_INLINE Vector3<L> normal_to(const Vector3<L>& first, const Vector3<L>& second)
{
    return cross(first, perpendicular_to(first, second));
}

/// `best`, what separation() has shown, or what the best of all features shows: for the lanes in `asked`, where two points of the
/// primitives are farther apart than `needed`. A function of its own: much code, seldom run.
template <PairKind kind, class L>
__attribute__((noinline)) Separation<L> separation_by_features(const Vector3<L> (&r)[3], Separation<L> best, L needed, LaneMask<L> asked)
{
    asked = asked & less(needed * needed, square_distance<kind>(r, best));
    if (Lane<L>::bits(asked) == 0) return best;
    const L zero = broadcast<L>(0.0), one = broadcast<L>(1.0);
    const auto consider = [&](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA {
        const L square = dot(v, v);
        const Vector3<L> n = scaled(v, select<L>(less(broadcast<L>(smallest_square), square), one / sqrt(square), zero));
        const L gap = gaps<kind>(n, r).along;
        const LaneMask<L> better = asked & less(best.gap, gap);
        best.n = select(better, n, best.n);
        best.gap = select<L>(better, gap, best.gap);
    };
    const auto consider_normal = [&](const Vector3<L>& v) FASTCCD_INLINE_LAMBDA {
        consider(v);
        consider({negated(v.x), negated(v.y), negated(v.z)});
    };
    if constexpr (kind == PairKind::vertex_face) {
        const Vector3<L> side[3] = {subtract(r[1], r[0]), subtract(r[2], r[1]), subtract(r[0], r[2])};
        consider_normal(normal_to(side[0], side[1]));
        for (int i = 0; i < 3; ++i) {
            consider(r[i]);
            consider(perpendicular_to(side[i], r[i]));
        }
    } else {
        const Vector3<L>& first = r[0];
        const Vector3<L> second = subtract(r[2], r[1]);
        consider_normal(normal_to(first, second));
        for (int i = 1; i < 3; ++i) {
            consider(r[i]);
            consider(subtract(r[i], first));
            consider(perpendicular_to(first, r[i]));
        }
        consider(perpendicular_to(second, r[1]));
        consider(perpendicular_to(second, subtract(r[1], first)));
    }
    return best;
}

/// Whether features are to be asked: `seen`, by separation(), proves no more than `needed`, although two points of the primitives, if not the
/// nearest ones, are farther apart.
template <class L>
FASTCCD_INLINE LaneMask<L> leaves_open(const Separation<L>& seen, L needed)
{
    return less_equal(seen.gap, needed) & less(needed * needed, seen.square_to_side);
}

/// Of the primitives in one position: separation() or, where that leaves open whether they are farther apart than `needed`, by all features.
template <PairKind kind, class L>
FASTCCD_INLINE Separation<L> separation_beyond(const Vector3<L> (&r)[3], L needed)
{
    const Separation<L> seen = separation<kind>(r);
    const LaneMask<L> open = leaves_open(seen, needed);
    return Lane<L>::bits(open) == 0 ? seen : separation_by_features<kind>(r, seen, needed, open);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
