// The certified search's walk over intervals, earliest first: one at a time, or several where there are lanes for them.
//
// Each answer decides what is asked next. Kernels with lanes answer for several intervals in little more than the time of
// one, so a question is joined by those that probably follow it: the way down to where contact is expected, and what lies
// to the left of that way; if there is no such place, the halves of what waits. A wrong guess costs time alone: an answer is
// used for the very interval it was given for, and only if the walk comes to it. Once a look at the root itself has told that no interval
// around it has a certificate (meeting.hpp), what lies on the way is not asked any more, or only for its areas.
#pragma once

#include <optional>

#include <expected_contact.hpp>
#include <interval_stack.hpp>

namespace fastccd::scalar {

template <PairKind kind>
class OrderedSearch {
public:
    /// Over [0, 1] of the coefficients. Without `kernel`, or with one that has none for intervals, they are looked at one at a time.
    OrderedSearch(const PairCoefficients& pair, const SearchParameters& parameters, const IntervalKernel* kernel)
        : pair_{pair}, parameters_{parameters}
    {
        if (kernel != nullptr) kernel_ = *kernel;
    }

    /// Takes intervals from the stack and counts them; drops those with a certificate and halves the others, until one of those
    /// is not to be halved: where narrowest(i), or when more than `limit` have been counted. None: all have certificates.
    /// `by_area`: eq. 7 counts, too.
    template <class Narrowest>
    std::optional<Interval> next_without_certificate(IntervalStack& stack, bool by_area, unsigned limit, Narrowest narrowest)
    {
        while (!stack.empty()) {
            if (kernel_.apart != nullptr && intervals + kernel_.lanes <= limit) {
                if (const auto found = look_at_several(stack, by_area, limit, narrowest)) return found;
                continue;
            }
            const Interval i = stack.pop();
            ++intervals;
            if (apart_on<kind>(pair_, i.a, i.b).value || (by_area && apart_by_area_on<kind>(pair_, i.a, i.b).value)) continue;
            if (intervals > limit || narrowest(i)) return i;
            stack.push_halves(i);
        }
        return std::nullopt;
    }

    /// Before anything is looked at: where contact is expected, if that is known.
    void expect(double time) { expected_.emplace(time); }

    unsigned intervals = 0;  ///< Counted.

private:
    /// What look_beside_way() may count: an interval and its half for each level.
    static constexpr unsigned most_beside_way = 2 * IntervalStack::capacity;

    /// Questions for the kernel, in the order in which the walk comes to them.
    struct Questions {
        alignas(64) double starts[most_lanes];
        alignas(64) double ends[most_lanes];
        unsigned size = 0;

        void put(unsigned k, Interval i) { starts[k] = i.a, ends[k] = i.b; }
        [[nodiscard]] Interval at(unsigned k) const { return {starts[k], ends[k]}; }
    };

    template <class Narrowest>
    std::optional<Interval> look_at_several(IntervalStack& stack, bool by_area, unsigned limit, Narrowest narrowest)
    {
        if (!expected_) expected_.emplace(pair_, parameters_);
        const Interval next = stack.peek(0);
        const double target = expected_->from(next.a);
        if (target == ExpectedContact::nowhere) return look_at_halves(stack, by_area, narrowest);
        if (by_area || !next.contains(target) || !next.contains(meeting_) || intervals + most_beside_way > limit)
            return look_towards(target, stack, by_area, narrowest);
        return look_beside_way(target, stack, narrowest);
    }

    /// Down to `target` as long as what is on the way contains the meeting, too: it has no certificate, only what lies to the left of
    /// the way is asked.
    template <class Narrowest>
    std::optional<Interval> look_beside_way(double target, IntervalStack& stack, Narrowest narrowest)
    {
        Questions questions;
        const unsigned waiting = stack.size();
        const Interval first = stack.pop();
        Interval way = first;
        unsigned ways = 1;
        for (; questions.size < kernel_.lanes && !narrowest(way); ++ways) {
            const double middle = way.middle();
            const bool turns_right = middle < target;
            const Interval next{turns_right ? middle : way.a, turns_right ? way.b : middle};
            if (!next.contains(meeting_)) break;
            questions.put(questions.size, {way.a, middle});
            questions.size += unsigned{turns_right};
            stack.push({middle, way.b});
            stack.drop(unsigned{turns_right});
            way = next;
        }
        if (questions.size != 0 && (~ask(questions, false) & ((1u << questions.size) - 1)) != 0) {
            // One of those has none. What follows from it is left to the other ways to look.
            stack.drop(stack.size() + 1 - waiting);
            stack.push(first);
            meeting_ = ExpectedContact::nowhere;
            return std::nullopt;
        }
        intervals += ways + questions.size;
        if (narrowest(way)) return way;
        stack.push_halves(way);
        return std::nullopt;
    }

    unsigned ask(Questions& questions, bool by_area) const
    {
        for (unsigned k = questions.size; k < kernel_.lanes; ++k) questions.put(k, questions.at(0));
        unsigned met = 0;
        for (unsigned k = 0; k < kernel_.lanes; ++k) met |= unsigned{questions.starts[k] <= meeting_ && meeting_ <= questions.ends[k]} << k;
        return kernel_.apart(pair_, questions.starts, questions.ends, met, by_area);
    }

    /// Whether the pair meets where it is expected to: most that come this far do, and intervals around that time need not be looked at.
    void meet_at(double target)
    {
        if (target == tried_) return;
        tried_ = target;
        const double root = expected_->root();
        meeting_ = root != ExpectedContact::nowhere && meets_at<kind>(pair_, root).value ? root : ExpectedContact::nowhere;
    }

    /// Intervals that wait, each with its halves.
    template <class Narrowest>
    std::optional<Interval> look_at_halves(IntervalStack& stack, bool by_area, Narrowest narrowest)
    {
        Questions questions;
        for (unsigned k = 0; k < stack.size() && questions.size < kernel_.lanes; ++k) {
            const Interval i = stack.peek(k);
            questions.put(questions.size++, i);
            if (questions.size + 2 > kernel_.lanes || narrowest(i)) continue;
            questions.put(questions.size++, {i.a, i.middle()});
            questions.put(questions.size++, {i.middle(), i.b});
        }
        return follow(questions, ask(questions, by_area), stack, narrowest);
    }

    /// The way down to `target`. Without branches on which way it turns: no processor foresees that.
    template <class Narrowest>
    std::optional<Interval> look_towards(double target, IntervalStack& stack, bool by_area, Narrowest narrowest)
    {
        Questions questions;
        unsigned passed = 0, apart = 0;  // bits: what is expected to have a certificate
        Interval way{};
        bool holds = false;  // the way the target
        while (!holds && passed < stack.size() && questions.size < kernel_.lanes) {
            way = stack.peek(passed++);
            holds = way.contains(target);
            apart |= unsigned{!holds} << questions.size;
            questions.put(questions.size++, way);
        }
        Interval beside[most_lanes];  // on the right of the way
        unsigned right = 0;
        while (holds && questions.size + 2 <= kernel_.lanes && !narrowest(way)) {
            const double middle = way.middle();
            const bool turns_right = middle < target;
            questions.put(questions.size, {way.a, middle});
            questions.put(questions.size + 1, {middle, way.b});
            beside[right] = {middle, way.b};
            apart |= unsigned{turns_right} << questions.size;
            questions.size += 1 + unsigned{turns_right};
            right += unsigned{!turns_right};
            way = {turns_right ? middle : way.a, turns_right ? way.b : middle};
        }

        const unsigned answers = ask(questions, by_area);
        if (((answers ^ apart) & ((1u << questions.size) - 1)) != 0) return follow(questions, answers, stack, narrowest);
        // All as expected: to the end of the way at once.
        intervals += questions.size;
        stack.drop(passed);
        for (unsigned k = 0; k < right; ++k) stack.push(beside[k]);
        if (!holds) return std::nullopt;
        meet_at(target);
        if (narrowest(way)) return way;
        stack.push_halves(way);
        return std::nullopt;
    }

    /// As far as the answers lead.
    template <class Narrowest>
    std::optional<Interval> follow(const Questions& questions, unsigned answers, IntervalStack& stack, Narrowest narrowest)
    {
        for (unsigned k = 0; k < questions.size && !stack.empty(); ++k) {
            const Interval i = stack.peek(0);
            if (!(questions.at(k) == i)) continue;
            stack.pop();
            ++intervals;
            if ((answers >> k & 1) != 0) continue;
            if (narrowest(i)) return i;
            stack.push_halves(i);
        }
        return std::nullopt;
    }

    const PairCoefficients& pair_;
    const SearchParameters& parameters_;
    IntervalKernel kernel_{};
    /// Found when lanes are asked for the first time: for pairs that rest on one another, which are told by one look, it would take
    /// longer than all else.
    std::optional<ExpectedContact> expected_;
    double tried_ = -1.0;                       ///< Where a meeting was looked for last.
    double meeting_ = ExpectedContact::nowhere; ///< A time of which meeting.hpp says that no interval around it has a certificate.
};

}  // namespace fastccd::scalar
