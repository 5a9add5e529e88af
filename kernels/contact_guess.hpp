// Where a pair will probably come within d, once the first look is done (separation_steps.hpp).
//
// Most pairs meet with the vertex inside of the face, or edge across edge. Their distance is then that of the planes, |f| / |n|, with f the
// cubic of coplanarity and n the normal of farther_certificates.hpp: so contact is where f comes down to d |n|. A few of Householder's steps
// (householder.hpp) from the time the search has got to come to that, and the look there is often the last one before the proof. Nothing is
// concluded from a guess; where it is of no use, the search goes on without.
#pragma once

#include <farther_certificates.hpp>
#include <householder.hpp>
#include <separation_steps.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// With two, 22 and 31 % more looks at random vertex-face and edge-edge pairs; with four, 4 and 5 % fewer, at a third more work here.
inline constexpr int guess_steps = 3;

/// What the steps go by, over the whole of the motion.
template <class L>
struct ClosingPlanes {
    PowerCubic<L> f;        ///< With the sign that is positive where the steps begin, less twice the bound of farther_between(), so that this proves
                            ///< the way to the guess.
    Vector3<L> n0, n1, n2;  ///< n = n0 + s (n1 + s n2).
    L aim;                  ///< The distance to come to, in units of the coordinates.
    L begin;                ///< The time to begin at; infinite where the planes are as close already, so that no guess comes of it.
};

/// n at s.
template <class L>
FASTCCD_INLINE Vector3<L> normal_at(const ClosingPlanes<L>& planes, L s)
{
    return add(planes.n0, scaled(add(planes.n1, scaled(planes.n2, s)), s));
}

template <PairKind kind, class L>
FASTCCD_INLINE ClosingPlanes<L> closing_planes(const SeparationRecord<L>& pair, const SearchParameters& parameters)
{
    const QuadraticVector<L> n = normal_between<kind>(pair.r.start, pair.r.end);
    const PowerCubic<L> f = power_basis(bernstein(coplanarity_cubic(pair.r, n)));
    const L value = evaluate(f, pair.time);
    const auto positive = [&](L coefficient) FASTCCD_INLINE_LAMBDA { return times_sign(coefficient, value); };
    const double bound = SeparationBounds{parameters.bounds.rho}.volume_between() / 3.0;  // of f, where that is of three times f
    const L room = broadcast<L>(2.0 * bound) * scales(pair.extents).volume;
    ClosingPlanes<L> planes{{positive(f.c0) - room, positive(f.c1), positive(f.c2), positive(f.c3)},
                            n.start, subtract(n.twice_middle, add(n.start, n.start)), add(subtract(n.start, n.twice_middle), n.end),
                            aimed_distance(parameters.separation, pair.extents), broadcast<L>(__builtin_inf())};
    const Vector3<L> there = normal_at(planes, pair.time);
    const LaneMask<L> closing = less(planes.aim * sqrt(dot(there, there)), abs(value) - room);
    planes.begin = select<L>(closing, pair.time, planes.begin);
    return planes;
}

/// One step from s, by f - d |n|, whose slope is f' - d n . n' / |n|. Any value, NaN included, where the planes do not close.
template <class L>
FASTCCD_INLINE L next_guess(const ClosingPlanes<L>& planes, L s)
{
    const Vector3<L> n = normal_at(planes, s);
    const L length = sqrt(dot(n, n));
    const Vector3<L> slope = add(planes.n1, scaled(planes.n2, s + s));
    const PowerCubic<L> excess{planes.f.c0, planes.f.c1 - planes.aim * (dot(n, slope) / length), planes.f.c2, planes.f.c3};
    return householder_guess(excess, s, evaluate(planes.f, s) - planes.aim * length);
}

/// After the first look at a pair, the next one is at the guess, if that is a time to come.
template <class L>
FASTCCD_INLINE void look_at_guess(SeparationRecord<L>& pair, L guess)
{
    const L one = broadcast<L>(1.0);
    const LaneMask<L> ahead = less_equal(pair.looks, one) & less(pair.time, guess) & less_equal(guess, one);
    pair.purpose = select<L>(ahead, broadcast<L>(looking_ahead), pair.purpose);
    pair.at = select<L>(ahead, guess, pair.at);
}

/// The guess and all that leads to it. Lanes go through the same step by step, many batches at a time.
template <PairKind kind, class L>
FASTCCD_INLINE void guess_contact(SeparationRecord<L>& pair, const SearchParameters& parameters)
{
    const ClosingPlanes<L> planes = closing_planes<kind>(pair, parameters);
    L guess = planes.begin;
    for (int k = 0; k < guess_steps; ++k) guess = next_guess(planes, guess);
    look_at_guess(pair, guess);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
