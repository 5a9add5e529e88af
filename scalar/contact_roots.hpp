// Number of roots of the coplanarity cubic at which there is contact (the paper's odd and even collisions,
// Table 1), for one pair.
//
// Where inclusion is strict over an interval, the contact roots in it are the roots of the cubic, and one sign
// variation of its Bernstein coefficients is exactly one root (Descartes). Intervals that stay unclear down to
// a leaf form clusters: a cluster across which the sign changes counts as one root, one with the same sign on
// both sides as a tangential (double) root, unless it is part of one at which the sign changes (leave_neighbourhood).
#pragma once

#include <cmath>
#include <cstdint>

#include <leaf_search.hpp>

namespace fastccd::scalar {

template <PairKind kind>
class RootCounter {
public:
    /// `most`: the cap on intervals.
    RootCounter(const PairPolynomials<kind>& pair, const SearchParameters& parameters, unsigned most = most_intervals)
        : pair_{pair}, leaf_width_{std::min(parameters.leaf_width, widest_leaf)}, most_{most}, leaves_{pair, parameters, nullptr, most}
    {
    }

    /// 0 if the roots cannot be counted.
    std::uint8_t count()
    {
        IntervalStack stack;
        stack.push({0.0, 1.0});
        while (!stack.empty()) {
            // One cap for these intervals and for the parts of leaves together.
            leaves_.count_interval();
            if (leaves_.intervals() > most_) return 0;
            const Interval i = stack.pop();
            const Cubic<double> f = pair_.coplanarity(i);
            const double width = i.b - i.a;
            if (width < 1.0 && pair_.apart(i)) {
                see_sign(f.c0, i.a);
                if (open_) look_behind_cluster(i);
            } else if (one_variation(f) && pair_.included(i)) {
                see_sign(f.c0, i.a);
                count_change();
            } else if (width > leaf_width_ && !(flat(f) && width <= widest_flat)) {
                stack.push_halves(i);
                continue;
            } else if (width <= leaf_width_ && leaves_.contact_in_leaf(i) == leaves_.none) {
                see_sign(f.c0, i.a);
            } else if (!open_) {
                see_sign(f.c0, i.a);
                look_ahead_of_cluster(i.a);
                open_ = true;
                before_ = last_sign_;
            }
            see_sign(f.c3, i.b);
        }
        if (open_) close_cluster(0);
        leave_neighbourhood();
        // A cubic has three roots: beside two across which its sign changes there is no double one, and of clusters that look like
        // double roots at most one is. (Odd ones are three at most as well, but for those at the ends of the step.)
        const unsigned roots = odd_ + (tangential_ && odd_ < 2 ? 2 : 0);
        return countable_ && roots <= 3 ? static_cast<std::uint8_t>(roots) : std::uint8_t{0};
    }

    /// Intervals examined.
    [[nodiscard]] unsigned intervals() const { return leaves_.intervals(); }

private:
    /// An interval on which the cubic vanishes within rounding is halved down to this width only: its roots
    /// cannot be told apart, and always-coplanar motion must not be followed leaf by leaf.
    static constexpr double widest_flat = 0x1p-6;
    /// Intervals that stay unclear are halved down to this width at least, however coarse the answer may be: two
    /// roots in one of them count as one multiple root, whether there is contact at both or not.
    static constexpr double widest_leaf = 0x1p-30;

    [[nodiscard]] int sign(double value) const
    {
        return value > pair_.cubic_bound() ? 1 : value < -pair_.cubic_bound() ? -1 : 0;
    }

    /// Certainly exactly one sign variation: opposite ends, and the inner two not a further one and back.
    [[nodiscard]] bool one_variation(const Cubic<double>& f) const
    {
        const int first = sign(f.c0), last = sign(f.c3);
        return first * last == -1 && (sign(f.c1) == first || sign(f.c2) == last);
    }

    [[nodiscard]] bool flat(const Cubic<double>& f) const
    {
        return sign(smallest(f)) == 0 && sign(largest(f)) == 0;
    }

    /// Takes note of the cubic's value at the next time in order; a certain sign ends an open cluster. Until then,
    /// whatever else is found lies at the same multiple root.
    void see_sign(double value, double time)
    {
        if (sign(value) == 0) return;
        last_sign_ = sign(value);
        last_time_ = time;
        if (open_) close_cluster(last_sign_);
        // The exact value is above two bounds: while it does not fall, none that follows is uncertain, as next to one bound it may be.
        if (std::abs(value) > 3.0 * pair_.cubic_bound()) leave_neighbourhood();
    }

    /// What is apart may be long, and have roots without contact: beside a cluster its sign is that of the nearest time at which it is
    /// certain, at distances of a leaf and of twice as much each time after that. Here of the interval after one, `apart`.
    void look_behind_cluster(Interval apart)
    {
        for (double distance = leaf_width_; open_ && distance < apart.width(); distance *= 2) look_at(apart.a + distance);
    }
    /// Here before one that begins at `start`.
    void look_ahead_of_cluster(double start)
    {
        const double known = last_time_;
        for (double distance = leaf_width_; last_time_ == known && start - distance > known; distance *= 2) look_at(start - distance);
    }
    void look_at(double time)
    {
        leaves_.count_interval();
        see_sign(pair_.coplanarity({time, time}).c0, time);
    }

    void close_cluster(int after)
    {
        open_ = false;
        if (before_ == 0 && after == 0) countable_ = false;
        if (before_ != 0 && before_ == after)
            tangential_here_ = true;
        else
            count_change();
    }

    void count_change()
    {
        ++odd_;
        changes_here_ = true;
    }

    /// Between two times at which the cubic is certain by far, clusters without a change of sign are part of the root of one with such a change:
    /// around a triple root, where it is hardly certain, it may be uncertain again.
    void leave_neighbourhood()
    {
        tangential_ |= tangential_here_ && !changes_here_;
        tangential_here_ = changes_here_ = false;
    }

    const PairPolynomials<kind>& pair_;
    double leaf_width_;
    unsigned most_;
    LeafSearch<kind> leaves_;
    bool open_ = false;
    bool countable_ = true;
    int before_ = 0;          ///< Sign of the cubic before the open cluster; 0 if not certain.
    int last_sign_ = 0;       ///< Its last certain sign,
    double last_time_ = 0.0;  ///< and when.
    unsigned odd_ = 0;        ///< Roots across which the sign changes, or that lie at an end of the step.
    bool tangential_ = false;
    bool tangential_here_ = false, changes_here_ = false;  ///< Since the cubic was certain by far.
};

}  // namespace fastccd::scalar
