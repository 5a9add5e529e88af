#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace fastccd::tools {
namespace {

constexpr std::chrono::seconds first_draw_after{1};
constexpr std::chrono::milliseconds draw_interval{100};
constexpr std::string_view clean_line = "\r\x1b[K";

bool standard_error_can_redraw()
{
    const char* const terminal = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) != 0 && terminal != nullptr && std::string_view{terminal} != "dumb";
}

std::size_t standard_error_width()
{
    winsize size{};
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return size.ws_col;
}

/// A bar that cannot be drawn must not end the work it tells about.
void write_or_not(std::string_view text)
{
    [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

std::string progress_line(std::size_t done, std::size_t total, double seconds, std::size_t width,
                          std::string_view place)
{
    const double fraction =
        total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
    std::string line = fmt::format("{:3.0f} %", std::floor(fraction * 100));
    if (line.size() >= width) return {};

    std::string details;
    if (seconds > 0 && done > 0) {
        const double rate = static_cast<double>(done) / seconds;
        const double left = std::min(static_cast<double>(total - std::min(done, total)) / rate, 359'999.0);
        const auto left_seconds = static_cast<unsigned>(std::ceil(left));
        details = fmt::format("  {}  {}:{:02}:{:02} left",
                              place.empty() ? fmt::format("{:.1f} M pairs/s", rate * 1e-6) : std::string{place},
                              left_seconds / 3600, left_seconds / 60 % 60, left_seconds % 60);
    }
    if (line.size() + details.size() < width) line += details;

    constexpr std::size_t widest_bar = 40;
    constexpr std::size_t frame = 4;  // brackets, a space, and the last column, which would wrap
    if (line.size() + frame + 5 <= width) {
        const std::size_t bar = std::min(widest_bar, width - line.size() - frame);
        const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(bar));
        line = fmt::format("[{:<{}}] {}", std::string(filled, '#'), bar, line);
    }
    return line;
}

Progress::Progress(std::size_t total, bool enabled)
    : total_{total}, enabled_{enabled && standard_error_can_redraw()}, next_draw_{start_ + first_draw_after}
{
}

Progress::~Progress()
{
    if (drawn_) write_or_not(clean_line);
}

void Progress::advance(std::size_t count)
{
    done_ += count;
    if (!enabled_ || done_ >= total_) return;
    const Clock::time_point now = Clock::now();
    if (now < next_draw_) return;
    next_draw_ = now + draw_interval;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    write_or_not(std::string{clean_line} + progress_line(done_, total_, seconds, standard_error_width(), place_));
    drawn_ = true;
}

}  // namespace fastccd::tools
