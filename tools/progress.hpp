// Progress bar for a person who waits.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace fastccd::tools {

/// The bar as text of fewer than `width` columns; empty if even a percentage has no room. `place` says
/// where the work is; without it the rate is shown, `done` and `total` being pairs.
[[nodiscard]] std::string progress_line(std::size_t done, std::size_t total, double seconds, std::size_t width,
                                        std::string_view place = {});

/// Shows on standard error how far the work is, if that is a terminal, from one second on. The line
/// is cleaned when the object goes, exceptions included.
class Progress {
public:
    /// `enabled`: false never shows anything.
    Progress(std::size_t total, bool enabled);
    ~Progress();

    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// What the next lines say instead of pairs per second.
    void set_place(std::string place) { place_ = std::move(place); }

    /// `count` more of the total are done. Cheap; draws at most ten times a second.
    void advance(std::size_t count);

private:
    using Clock = std::chrono::steady_clock;

    std::size_t total_;
    std::size_t done_ = 0;
    bool enabled_;
    bool drawn_ = false;
    std::string place_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point next_draw_;
};

}  // namespace fastccd::tools
