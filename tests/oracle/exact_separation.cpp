// As in subdivision.cpp, with a distance: where the Bernstein coefficients of the heights exceed those of d times a linear bound of |n(t)|, the
// distance exceeds d. |n(t)| is convex, so it is at most what goes linearly from |n| at the begin to |n| at the end.

#include "exact_separation.hpp"

#include <stdexcept>

#include "turning_vector.hpp"

namespace fastccd::oracle {
namespace {

// Lengths are irrational: integers above them, in units of 2^-norm_bits, so close that no test notices.
constexpr mp_bitcnt_t norm_bits = 128;

mpz_class square(const IntegerVector& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

mpz_class norm_above(const IntegerVector& v) {
    const mpz_class shifted = square(v) << (2 * norm_bits);
    return sqrt(shifted) + 1;
}

class Prover {
public:
    Prover(Kind kind, const Pair& pair, double d) : kind_(kind), pair_(pair), d_(to_dyadic(d)) {}

    const IntegerPair& pair() const { return pair_; }

    // |numerator| / denominator <= d 2^(exponent + level), squared and multiplied out
    bool within(const Moment& m) const {
        mpz_class left = square(m.shortest.numerator), right = d_.numerator * m.shortest.denominator;
        right *= right;
        const long shift = 2 * (scale(m) - static_cast<long>(d_.level));
        if (shift >= 0) {
            right <<= static_cast<mp_bitcnt_t>(shift);
        } else {
            left <<= static_cast<mp_bitcnt_t>(-shift);
        }
        return left <= right;
    }

    bool farther_between(const Moment& begin, const Moment& end) const {
        const TurningVector n(begin, end);
        const mpz_class from_norm = norm_above(n.from), to_norm = norm_above(n.to);
        return every_height(kind_, n, begin, end, [&](const HeightCoefficients& h) {
            return exceeds(h.begin, from_norm, begin) && exceeds(h.end, to_norm, begin) &&
                   exceeds(h.doubled_middle, from_norm + to_norm, begin);
        });
    }

private:
    long scale(const Moment& m) const { return pair_.exponent + static_cast<long>(m.time.level); }

    // height > d norm, in the units of `m`
    bool exceeds(const mpz_class& height, const mpz_class& norm, const Moment& m) const {
        mpz_class left = height << norm_bits, right = d_.numerator * norm;
        const long shift = scale(m) - static_cast<long>(d_.level);
        if (shift >= 0) {
            right <<= static_cast<mp_bitcnt_t>(shift);
        } else {
            left <<= static_cast<mp_bitcnt_t>(-shift);
        }
        return left > right;
    }

    Kind kind_;
    IntegerPair pair_;
    Dyadic d_;
};

}  // namespace

Farther farther_throughout(Kind kind, const Pair& pair, double d, double t_begin, double t_end, int depth, int max_intervals) {
    if (!is_finite(pair) || !(t_begin <= t_end) || !(d >= 0.0)) throw std::invalid_argument("farther_throughout: not finite, or no interval");
    const Prover prover(kind, pair, d);
    const Shown shown = show_by_halving(
        kind, prover.pair(), to_dyadic(t_begin), to_dyadic(t_end), depth, max_intervals,
        [&](const Moment& begin, const Moment& end) { return prover.farther_between(begin, end); },
        [&](const Moment& m) { return prover.within(m); });
    switch (shown) {
        case Shown::throughout: return Farther::certainly;
        case Shown::refuted: return Farther::closer;
        case Shown::not_shown: break;
    }
    return Farther::not_shown;
}

}  // namespace fastccd::oracle
