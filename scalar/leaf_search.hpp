// The ordered search over leaves, and what a single leaf holds.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include <certified_search.hpp>
#include <ordered_search.hpp>
#include <pair_polynomials.hpp>
#include <separation_search.hpp>

namespace fastccd::scalar {

template <PairKind kind>
class LeafSearch {
public:
    static constexpr double none = std::numeric_limits<double>::infinity();

    /// `kernel`: if there is one, several intervals are looked at in one go, with the same outcome. `most`: the cap on intervals.
    LeafSearch(const PairPolynomials<kind>& pair, const SearchParameters& parameters, const IntervalKernel* kernel = nullptr,
               unsigned most = most_intervals)
        : pair_{pair}, parameters_{parameters}, kernel_{kernel}, most_{most}, search_{pair.coefficients(), parameters, kernel}
    {
    }

    /// Lower bound of the first contact in [0, 1]; `none` if the pair is certainly apart. To be asked once.
    double first_contact()
    {
        const Interval whole{0.0, 1.0};
        search_.intervals = 1;
        may_ask_directions_ = true;
        stack_.push_halves(whole);  // it has no certificate
        if (pair_.in_contact_at_start(parameters_.leaf_width)) {
            leaf_of_answer_ = {0.0, parameters_.leaf_width};
            if (pair_.counts_as_contact_at_start(parameters_.bounds)) touch_ = 0.0;
            return 0.0;
        }
        if (is_leaf(whole)) return pair_.apart(whole) ? none : contact_in_leaf(whole);
        return next_contact();
    }

    /// For a leaf without a certificate: `none` if it is apart after all; its left end, but for the first leaf, if contact is
    /// proven inside; otherwise a time just before it touches there, or the left end of the first part that cannot be cleared, of as many as
    /// may be examined.
    double contact_in_leaf(Interval leaf, unsigned most_parts = most_intervals_in_leaf)
    {
        // A positive lower bound is wanted for a pair that is apart at time 0, proven contact or not.
        if (leaf.a > 0.0 && pair_.contact_proven(leaf)) return leaf.a;
        const PairCoefficients inside = pair_.in_leaf(leaf);
        std::optional<double> likely;
        if (leaf.width() >= narrowest_touched) {
            const Touch<double> found = pair_.touch(inside, parameters_.bounds);
            likely = found.likely;
            if (found.apart.value) return none;
            if (found.present.value && skipped_to_ <= found.time) {
                touch_ = found.time;
                return std::max(found.lower_bound, skipped_to_);
            }
            // Not where eq. 7 tells that there is no contact in the leaf, which lanes know without asking the search.
            if (may_ask_directions_ && !pair_.apart_by_area(leaf)) {
                if (const auto answer = contact_along_directions(leaf, std::max(found.lower_bound, skipped_to_))) return *answer;
            }
        }
        // Parts are shares of the leaf, or of the step in the first leaf: what is apart at time 0 by no more than its bounds is to be so in
        // each part. Their ends are times of the step, all of them doubles, as they are not halved below finest_at().
        const bool is_first = leaf.a == 0.0;
        const PairCoefficients& whole = is_first ? pair_.coefficients() : inside;
        const auto in_step = [&](double s) { return time_in_step(whole, s); };
        const auto is_finest = [&](Interval i) { return i.width() * whole.duration <= finest_at(in_step(i.a)); };
        OrderedSearch<kind> parts{whole, parameters_, kernel_};
        if (likely) parts.expect(is_first ? time_in_step(inside, *likely) : *likely);
        parts.intervals = search_.intervals;
        IntervalStack stack;
        stack.push(is_first ? leaf : Interval{0.0, 1.0});
        // Both exact: by a power of two, and of what is at most twice the origin, if that is not 0.
        if (leaf.a < skipped_to_) stack.skip_to((skipped_to_ - whole.origin) / whole.duration, finest_at(skipped_to_) / whole.duration);
        const unsigned limit = std::min(search_.intervals + most_parts, most_);
        const auto part = parts.next_without_certificate(stack, true, limit, is_finest);
        search_.intervals = parts.intervals;
        out_of_parts_ = search_.intervals > limit;
        return part ? std::max(in_step(part->a), skipped_to_) : none;
    }

    /// After first_contact() has found something at s: whether there is contact for certain, in the leaf that s lies in or
    /// in some interval around s. A root may lie too close to the leaf's end, and inclusion may end in a wide leaf.
    [[nodiscard]] Proof proof_of_contact(double s) const
    {
        if (s == 0.0 && pair_.zero_at_start()) return Proof::none;  // nor would any interval from 0 on have a change of sign
        // At the cap, contact may have been found in an interval that is wider than a leaf, and than what counts as near s.
        const double width = leaf_of_answer_.width();
        if (width <= std::max(parameters_.leaf_width, widest_proof) && pair_.contact_proven(leaf_of_answer_))
            return width <= parameters_.leaf_width ? Proof::leaf : Proof::nearby;
        return proof_nearby(touch_ == none ? s : touch_);
    }

    /// The same for any s: contact for certain in some interval around s.
    [[nodiscard]] Proof proof_nearby(double s) const { return pair_.contact_proven_near(s) ? Proof::nearby : Proof::none; }

    /// After first_contact() has found something at s that is not proven in its leaf: whether it may have been for another reason than
    /// that the pair is as close as computed positions can tell: rounding that the shape amplifies, a cap on intervals or parts, or parts
    /// before the time to which directions have led. Not where it touches: that has been looked at (counts_as_contact_at, meets_after_directions).
    [[nodiscard]] bool in_doubt(double s) const
    {
        return touch_ == none && ((0.0 < skipped_to_ && s == skipped_to_) || out_of_parts_ || search_.intervals >= std::min(most_intervals_in_leaf, most_) || !pair_.has_area(s));
    }

    [[nodiscard]] unsigned intervals() const { return search_.intervals; }
    /// Until when the search went along directions, 0 if it did not: what is asked of a leaf before says nothing of its answer. (For tests.)
    [[nodiscard]] double skipped_to() const { return skipped_to_; }
    /// One that was examined by someone who shares the cap.
    void count_interval() { ++search_.intervals; }

private:
    static constexpr unsigned most_intervals_in_leaf = 512;
    /// Where the shape is nearly degenerate at both ends of a leaf, directions go on from the first part that is not cleared (in_doubt):
    /// enough for one way down to the spacing of doubles, but in the first leaf.
    static constexpr unsigned most_in_thin_leaf = 128;
    /// Where volumes and areas vanish for a while, as when both edges are points for a moment, leaf after leaf is cleared by its parts alone:
    /// thousands of leaves, up to dozens of parts each. After every fourth of them the search asks how long directions keep the pair apart, and goes
    /// on there; not any more when that has led it less than `least_skipped` leaves on, or at the cap. Looks count as intervals. From the
    /// fourth on eq. 7 is asked of wider intervals, too. Both numbers are choices: no answer is right or wrong by them.
    static constexpr unsigned laborious_leaves = 4;
    static constexpr double least_skipped = 8;
    /// Lanes tell without asking the search of pairs with leaves that eq. 7 clears, one for each root of the cubic (simd/root_stages.hpp).
    static_assert(laborious_leaves > 3);

    /// Once for a pair: from `start`, in a leaf, where its shape amplifies rounding, as far as directions lead. If they end where it meets, that is
    /// the answer; `none` if they lead on beyond the leaf, or to the end; nothing if it has area, or the rest of the leaf is to be looked at.
    std::optional<double> contact_along_directions(Interval leaf, double start)
    {
        const AlongDirections<double> along = pair_.along_directions(start, parameters_.bounds);
        if (!along.asked.value) return std::nullopt;
        may_ask_directions_ = false;
        double time = along.apart.value ? none : along.time;
        bool ended = true;
        if (along.goes_on.value && search_.intervals < most_) {
            const SearchResult apart = apart_until(pair_.coefficients(), parameters_, time, most_looks_to_skip);
            search_.intervals += apart.intervals;
            time = apart.toi;
            ended = apart.intervals < most_looks_to_skip;
        } else if (along.goes_on.value) {
            ended = false;
        }
        if (time == none) {
            stack_.drop(stack_.size());
            return none;
        }
        if (ended && pair_.meets_after_directions(time, parameters_.leaf_width)) {
            const double left = leaf_start(time, parameters_.leaf_width);
            leaf_of_answer_ = {left, left + parameters_.leaf_width};
            if (leaf.b <= time) skipped_to_ = time;
            return touch_ = time;
        }
        go_on_at(time);
        if (leaf.b <= time) return none;
        return std::nullopt;
    }

    [[nodiscard]] bool is_leaf(Interval i) const { return i.width() <= parameters_.leaf_width; }

    /// See first_contact(): in what waits.
    double next_contact()
    {
        unsigned limit = most_;
        const auto is_narrowest = [&](Interval i) { return is_leaf(i); };
        while (const auto found = search_.next_without_certificate(stack_, laborious_ >= laborious_leaves, limit, is_narrowest)) {
            // Out of intervals, what is still waiting is looked at but not halved. Far from what took so many, a few more are enough.
            const bool is_wide = !is_leaf(*found);
            if (is_wide && extensions_ < most_extensions) {
                ++extensions_;
                limit = search_.intervals + extension;
                stack_.push_halves(*found);
                continue;
            }
            const unsigned before = search_.intervals;
            const bool has_area = pair_.has_area(found->a) || pair_.has_area(found->b);
            const unsigned most_parts = has_area ? most_intervals_in_leaf : most_in_thin_leaf;
            leaf_of_answer_ = *found;
            const double contact = is_wide ? std::max(found->a, skipped_to_) : contact_in_leaf(*found, most_parts);
            if (contact == none) {
                if (search_.intervals != before) skip_along_directions(*found);
                continue;
            }
            return contact;
        }
        return none;
    }

    void go_on_at(double time)
    {
        skipped_to_ = time;
        stack_.skip_to(time, parameters_.leaf_width);
    }

    /// After a laborious leaf.
    void skip_along_directions(Interval leaf)
    {
        if (++laborious_ % laborious_leaves != 0 || !directions_help_ || search_.intervals >= most_) return;
        const double start = std::max(leaf.b, skipped_to_);
        const SearchResult apart = apart_until(pair_.coefficients(), parameters_, start, most_looks_to_skip);
        search_.intervals += apart.intervals;
        directions_help_ = apart.toi - start >= least_skipped * parameters_.leaf_width;
        go_on_at(apart.toi);
    }

    /// Parts of a leaf are halved to the spacing of doubles at their time, or to finest_at_zero.
    static double finest_at(double time) { return std::max(time * 0x1p-52, finest_at_zero); }

    const PairPolynomials<kind>& pair_;
    const SearchParameters& parameters_;
    const IntervalKernel* kernel_;
    unsigned most_;
    OrderedSearch<kind> search_;
    IntervalStack stack_;  ///< What is still to be looked at.
    unsigned extensions_ = 0;
    Interval leaf_of_answer_{0.0, 1.0};  ///< Where first_contact() found contact.
    double touch_ = none;                ///< And where it touches in there (touching.hpp).
    bool may_ask_directions_ = false;    ///< Before parts; in a search in order, until asked.
    bool out_of_parts_ = false;          ///< The last leaf had more than could be examined.
    unsigned laborious_ = 0;             ///< Leaves cleared by their parts so far.
    bool directions_help_ = true;
    double skipped_to_ = 0.0;            ///< Apart until then along directions.
};

}  // namespace fastccd::scalar
