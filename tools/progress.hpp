// Progress bar for a person who waits.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace fastccd::tools {

/// The bar as text of fewer than `width` columns; empty if even a percentage has no room.
[[nodiscard]] std::string progress_line(std::size_t done, std::size_t total, double seconds, std::size_t width);

/// Shows on standard error how far the work is, if that is a terminal, from one second on. The line
/// is cleaned when the object goes, exceptions included.
class Progress {
public:
    /// `enabled`: false never shows anything.
    Progress(std::size_t total, bool enabled);
    ~Progress();

    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `count` more pairs are done. Cheap; draws at most ten times a second.
    void advance(std::size_t count);

private:
    using Clock = std::chrono::steady_clock;

    std::size_t total_;
    std::size_t done_ = 0;
    bool enabled_;
    bool drawn_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point next_draw_;
};

}  // namespace fastccd::tools
