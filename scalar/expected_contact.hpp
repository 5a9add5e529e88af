// Where the certified search will probably end up. Nothing is concluded from it; it says which questions to ask together.
#pragma once

#include <limits>

#include <householder.hpp>
#include <search_parameters.hpp>
#include <touching.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

/// The times at which the coplanarity cubic comes within its bound of zero, in order, found when asked for.
class ExpectedContact {
public:
    static constexpr double nowhere = std::numeric_limits<double>::infinity();

    explicit ExpectedContact(const PairCoefficients& pair, const SearchParameters& parameters)
        : bound_{pair.cubic_bound},
          pieces_{monotone_pieces<double>({pair.cubic[0], pair.cubic[1], pair.cubic[2], pair.cubic[3]}, 0.0, parameters.bounds,
                                         parameters.leaf_width, 0.0, 1.0)}
    {
        // Zero throughout: such a pair may touch anywhere, most probably where its certificates end.
        bool zero = true;
        for (const double value : pieces_.value) zero = zero && level(value) == value;
        if (!zero) return;
        next_piece_ = 3;
        certificates_ = pair.kind == PairKind::vertex_face ? end_of_certificates<PairKind::vertex_face>(pair)
                                                          : end_of_certificates<PairKind::edge_edge>(pair);
    }

    /// The first one that is not before s; nowhere if there is none.
    double from(double s)
    {
        for (; time_ < s; ++next_piece_) {
            if (next_piece_ == 3) return time_ = s <= certificates_ ? certificates_ : nowhere;
            time_ = in_piece(next_piece_);
        }
        return time_;
    }

    /// Where the cubic itself is zero, next to what from() answered last; nowhere if it does not change sign there. Of one that is zero
    /// throughout, what from() answered.
    [[nodiscard]] double root() const
    {
        if (time_ == certificates_) return certificates_;
        if (next_piece_ == 0) return nowhere;
        const int k = next_piece_ - 1;
        if ((pieces_.value[k] < 0.0) == (pieces_.value[k + 1] < 0.0)) return nowhere;
        return clipped_step(pieces_.f, Bracket<double>{pieces_.time[k], pieces_.time[k + 1]}, time_);
    }

    /// At a time that is known already.
    explicit ExpectedContact(double known) : bound_{0.0}, certificates_{known}, pieces_{}, next_piece_{3} {}

private:
    static constexpr double none_yet = -1.0;  ///< Before any time.

    template <PairKind kind>
    [[nodiscard]] static double end_of_certificates(const PairCoefficients& pair)
    {
        double before = 0.0;  // after four of them, as many as most pairs have
        for (int k = 0; k < 3; ++k) before = last_certificate<kind>(pair, before, 1.0, beyond_rounding, all_lanes<double>());
        return last_certificate<kind>(pair, before, 1.0, zero_level, all_lanes<double>());
    }

    /// The value next to zero that a search coming from `value` meets first.
    [[nodiscard]] double level(double value) const { return min(max(value, -bound_), bound_); }

    [[nodiscard]] double in_piece(int k) const
    {
        const double low = pieces_.time[k], high = pieces_.time[k + 1], zero = level(pieces_.value[k]);
        if (zero == pieces_.value[k]) return low;
        if ((pieces_.value[k] < zero) == (pieces_.value[k + 1] < zero)) return none_yet;
        PowerCubic<double> f = pieces_.f;
        f.c0 -= zero;
        // One step more than before roots are decided quickly: parts of leaves need the last digits, too.
        double s = 0.5 * (low + high);
        for (int step = 0; step < quick_steps + 1; ++step) s = clipped_step(f, Bracket<double>{low, high}, s);
        return s;
    }

    double bound_;
    double certificates_ = nowhere;  ///< Where they end, if the cubic tells nothing.
    MonotonePieces<double> pieces_;
    int next_piece_ = 0;
    double time_ = none_yet;
};

}  // namespace fastccd::scalar
