// How long something takes, and how far to trust that.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

namespace fastccd::tools::report {

using Json = nlohmann::ordered_json;

/// Times of the same work, done again and again.
class Timing {
public:
    enum class Clock { wall, processor };

    explicit Timing(Clock clock = Clock::wall) : clock_{clock} {}

    void add(double seconds) { seconds_.push_back(seconds); }

    [[nodiscard]] std::size_t repeats() const { return seconds_.size(); }

    [[nodiscard]] double median() const
    {
        if (seconds_.empty()) return 0.0;
        std::vector<double> sorted = seconds_;
        std::ranges::sort(sorted);
        const std::size_t middle = sorted.size() / 2;
        return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
    }

    /// {"seconds": median, "least", "most", "repeats", "clock": wall or processor}, and with pairs given "pairs_per_second" by the median.
    [[nodiscard]] Json json(std::size_t pairs = 0) const
    {
        Json json{{"seconds", median()},
                  {"least", seconds_.empty() ? 0.0 : *std::ranges::min_element(seconds_)},
                  {"most", seconds_.empty() ? 0.0 : *std::ranges::max_element(seconds_)},
                  {"repeats", seconds_.size()},
                  {"clock", clock_ == Clock::wall ? "wall" : "processor"}};
        if (pairs > 0 && median() > 0) json["pairs_per_second"] = static_cast<double>(pairs) / median();
        return json;
    }

private:
    Clock clock_;
    std::vector<double> seconds_;
};

template <class Work>
[[nodiscard]] double seconds_of(const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace fastccd::tools::report
