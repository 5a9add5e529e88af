// Intervals waiting to be examined, the earliest on top.
#pragma once

namespace fastccd::scalar {

/// A time interval [a, b] of the parameter s, 0 <= a <= b <= 1.
struct Interval {
    double a, b;

    [[nodiscard]] double width() const { return b - a; }
    [[nodiscard]] double middle() const { return a + 0.5 * (b - a); }
    [[nodiscard]] bool contains(double s) const { return a <= s && s <= b; }

    friend bool operator==(const Interval&, const Interval&) = default;
};

/// Halving adds one per level, and there are at most 50 levels of leaves or 100 below one (finest_at_zero).
class IntervalStack {
public:
    static constexpr unsigned capacity = 128;

    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] unsigned size() const { return size_; }
    /// The k-th from the top, which is the 0th.
    [[nodiscard]] Interval peek(unsigned k) const { return data_[size_ - 1 - k]; }
    void push(Interval i) { data_[size_++] = i; }
    Interval pop() { return data_[--size_]; }
    void drop(unsigned k) { size_ -= k; }
    /// Replaces the interval just popped by its halves.
    void push_halves(Interval i)
    {
        push({i.middle(), i.b});
        push({i.a, i.middle()});
    }
    /// Drops what ends before `time`. The interval that it lies inside of is halved until what holds it is no wider than `narrowest`.
    void skip_to(double time, double narrowest)
    {
        while (size_ != 0 && (peek(0).b < time || (peek(0).a < time && narrowest < peek(0).width()))) {
            const Interval i = pop();
            if (time <= i.b) push_halves(i);
        }
    }

private:
    Interval data_[capacity];
    unsigned size_ = 0;
};

}  // namespace fastccd::scalar
