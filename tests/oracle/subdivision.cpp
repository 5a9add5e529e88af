// The planes that separate are perpendicular to a vector that turns with the primitives (turning_vector.hpp): where all its heights stay
// positive, so does the distance.

#include "subdivision.hpp"

#include <algorithm>
#include <stdexcept>

#include "turning_vector.hpp"

namespace fastccd::oracle {

Separation subdivide(Kind kind, const Pair& pair, double t_begin, double t_end, int depth, int max_intervals) {
    if (!is_finite(pair) || !(t_begin <= t_end)) throw std::invalid_argument("subdivide: not finite, or no interval");
    const auto separated = [&](const Moment& begin, const Moment& end) {
        return every_height(kind, TurningVector(begin, end), begin, end, [](const HeightCoefficients& h) {
            return sgn(h.begin) > 0 && sgn(h.doubled_middle) > 0 && sgn(h.end) > 0;
        });
    };
    const auto touching = [](const Moment& m) {
        return std::ranges::all_of(m.shortest.numerator, [](const mpz_class& c) { return sgn(c) == 0; });
    };
    const Shown shown = show_by_halving(kind, IntegerPair(pair), to_dyadic(t_begin), to_dyadic(t_end), depth, max_intervals, separated, touching);
    return shown == Shown::throughout ? Separation::certainly_apart : Separation::not_excluded;
}

}  // namespace fastccd::oracle
