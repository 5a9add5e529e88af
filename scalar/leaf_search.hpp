// The ordered search over leaves, and what a single leaf holds.
#pragma once

#include <algorithm>
#include <limits>

#include <certified_search.hpp>
#include <pair_polynomials.hpp>

namespace fastccd::scalar {

/// Intervals waiting to be examined, the earliest on top. Halving adds one per level, and there are at
/// most 50 levels of leaves or 100 below one (finest_at_zero).
class IntervalStack {
public:
    [[nodiscard]] bool empty() const { return size_ == 0; }
    void push(Interval i) { data_[size_++] = i; }
    Interval pop() { return data_[--size_]; }
    /// Replaces the interval just popped by its halves.
    void push_halves(Interval i)
    {
        const double middle = i.a + 0.5 * (i.b - i.a);
        push({middle, i.b});
        push({i.a, middle});
    }

private:
    Interval data_[128];
    unsigned size_ = 0;
};

template <PairKind kind>
class LeafSearch {
public:
    static constexpr double none = std::numeric_limits<double>::infinity();

    LeafSearch(const PairPolynomials<kind>& polynomials, const SearchParameters& search_parameters)
        : pair{polynomials}, parameters{search_parameters}
    {
    }

    /// Lower bound of the first contact in [0, 1]; `none` if the pair is certainly apart.
    double first_contact()
    {
        IntervalStack stack;
        stack.push({0.0, 1.0});
        while (!stack.empty()) {
            const Interval i = stack.pop();
            // Out of intervals: what is still waiting is looked at once more, but not halved.
            const bool out_of_intervals = intervals_++ >= most_intervals;
            if (i.b - i.a < 1.0 && pair.apart(i)) continue;  // the whole interval has no certificate
            if (!out_of_intervals && i.b - i.a > parameters.leaf_width) {
                stack.push_halves(i);
                continue;
            }
            const double contact = out_of_intervals ? i.a : contact_in_leaf(i);
            if (contact == none) continue;
            leaf_of_answer = i;
            return contact;
        }
        return none;
    }

    /// For a leaf without a certificate: `none` if it is apart after all; its left end if contact is proven
    /// inside; otherwise the left end of the first part that cannot be cleared.
    double contact_in_leaf(Interval leaf)
    {
        // A positive lower bound is wanted for a pair that is apart at time 0, proven contact or not.
        if (leaf.a > 0.0 && contact_proven(leaf)) return leaf.a;
        const unsigned limit = std::min(intervals_ + most_intervals_in_leaf, most_intervals);
        IntervalStack stack;
        stack.push(leaf);
        while (!stack.empty()) {
            const Interval i = stack.pop();
            ++intervals_;
            if (pair.apart(i) || pair.apart_by_area(i)) continue;
            if (intervals_ > limit) return i.a;
            if (i.b - i.a <= std::max(i.a * finest_relative, finest_at_zero)) return i.a;
            stack.push_halves(i);
        }
        return none;
    }

    /// After first_contact() has found something at s: whether there is contact for certain, in the leaf of the answer or
    /// in some interval around s. A root may lie too close to the leaf's end, and inclusion may end in a wide leaf.
    [[nodiscard]] Proof proof_of_contact(double s) const
    {
        if (contact_proven(leaf_of_answer)) return Proof::leaf;
        for (double reach = narrowest_proof; reach <= widest_proof; reach *= 8)
            if (contact_proven({std::max(s - reach, 0.0), std::min(s + reach, 1.0)})) return Proof::nearby;
        return Proof::none;
    }

    [[nodiscard]] unsigned intervals() const { return intervals_; }

private:
    static constexpr unsigned most_intervals_in_leaf = 512;
    /// Parts of a leaf are halved to this width relative to their time, where a time still has a few
    /// digits to spare, or, next to time 0, to this absolute one.
    static constexpr double finest_relative = 0x1p-52;
    static constexpr double finest_at_zero = 0x1p-100;

    /// Within less, rounding hides every change of sign; within more, inclusion rarely lasts.
    static constexpr double narrowest_proof = 0x1p-48, widest_proof = 0x1p-6;

    /// The cubic has strict opposite signs at the ends, and inclusion is strict throughout.
    [[nodiscard]] bool contact_proven(Interval leaf) const
    {
        const Cubic<double> f = pair.coplanarity(leaf);
        const double bound = pair.cubic_bound();
        const bool crosses = (f.c0 > bound && f.c3 < -bound) || (f.c0 < -bound && f.c3 > bound);
        return crosses && pair.included(leaf);
    }

    const PairPolynomials<kind>& pair;
    const SearchParameters& parameters;
    Interval leaf_of_answer{0.0, 1.0};  ///< Where first_contact() found contact.
    unsigned intervals_ = 0;
};

}  // namespace fastccd::scalar
