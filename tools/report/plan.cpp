#include "plan.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

#include "../interrupt.hpp"
#include "../output_file.hpp"

namespace fastccd::tools::report {

void ReportProgress::begin(const std::string& name, double share)
{
    move_to(part_end_);
    part_begin_ = part_end_;
    part_end_ = std::min(1.0, part_begin_ + share);
    bar_.set_place(name);
    if (enabled_ && ::isatty(STDERR_FILENO) == 0)
        write_all(STDERR_FILENO, fmt::format("fastccd report: {}\n", name), "standard error");
}

void ReportProgress::move(std::size_t done, std::size_t total)
{
    check_interrupt();
    const double share = total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total);
    move_to(part_begin_ + share * (part_end_ - part_begin_));
}

void ReportProgress::move_to(double share)
{
    const auto now = static_cast<std::size_t>(share * units);
    if (now <= done_) return;
    bar_.advance(now - done_);
    done_ = now;
}

}  // namespace fastccd::tools::report
