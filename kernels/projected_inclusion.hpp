// Inclusion over a neighbourhood of a time, decided in the coordinate projections.
//
// The counterpart of Lemma 4.1 for edge functions: within |s - c| <= delta a component of r_i moves by
// at most 2 delta X, so a product of two components changes by at most 4 (delta + delta^2) Y Z and an
// edge function (two products) by 8 (delta + delta^2) Y Z. The same bound holds for the mixed blossom
// values F(a, b) with a and b in the neighbourhood. Signs beyond the bound hold throughout.
#pragma once

#include <certificates.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class L>
struct Inclusion {
    LaneMask<L> absent;   ///< Apart in some projection over the whole neighbourhood.
    LaneMask<L> present;  ///< Properly inside in some projection over the whole neighbourhood.
};

/// `present` proves contact at every coplanar time of the neighbourhood. Vertex-face: three edge functions
/// of one strict sign put the vertex inside a projected triangle of non-zero area. Edge-edge: the edges
/// cross properly in the projection. Either way the plane of the four points is not parallel to the
/// direction of projection, so the projection is one-to-one on it.
/// `absent` leaves the margin that makes the certified search find the same on every part.
template <PairKind kind, class L>
FASTCCD_INLINE Inclusion<L> projected_inclusion(const RelativeMotion<L>& r, const Scales<L>& scale, L centre, L delta,
                                                const ErrorBounds& bounds)
{
    const Vector3<L> r1 = position(r, 0, centre), r2 = position(r, 1, centre), r3 = position(r, 2, centre);
    const Vector3<L> p = cross(r1, r2), q = cross(r2, r3);
    const Vector3<L> t = kind == PairKind::vertex_face ? cross(r3, r1) : cross(r1, r3);
    const Vector3<L> s = kind == PairKind::vertex_face ? t : add(subtract(q, t), p);

    // A little more for the roundings of this line, of three times it and of the product with the area, 5 u: for a wide
    // neighbourhood they are more than the slack of what is added.
    const L change = broadcast<L>(8.0 * (1.0 + 0x1p-50)) * (delta + delta * delta);
    const L per_area = change + broadcast<L>(bounds.edge_function());
    const L per_area_sum = broadcast<L>(3.0) * change + broadcast<L>(bounds.edge_function_sum());

    const auto along = [&](L pk, L qk, L tk, L sk, L area) FASTCCD_INLINE_LAMBDA -> Inclusion<L> {
        const L bound = per_area * area, bound_sum = per_area_sum * area;
        if constexpr (kind == PairKind::vertex_face) {
            const L low = min(pk, qk, tk), high = max(pk, qk, tk);
            return {less(bound, high) & less(low, negated(bound)), less(bound, low) | less(high, negated(bound))};
        } else {
            // Of each couple: on one side, or across, one strictly positive and the other strictly negative.
            const LaneMask<L> aside = one_sign(bound, pk, tk) | one_sign(bound_sum, qk, sk);
            const LaneMask<L> across = one_sign(bound, pk, negated(tk)) & one_sign(bound_sum, qk, negated(sk));
            return {aside, across};
        }
    };
    const Inclusion<L> x = along(p.x, q.x, t.x, s.x, scale.yz);
    const Inclusion<L> y = along(p.y, q.y, t.y, s.y, scale.zx);
    const Inclusion<L> z = along(p.z, q.z, t.z, s.z, scale.xy);
    return {x.absent | y.absent | z.absent, x.present | y.present | z.present};
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
