// The five parts of a report, each as JSON: what the page and the pictures are drawn from.
//
// A timing is {"seconds": median, "least", "most", "repeats", "clock", "pairs_per_second"}; counts of wrong answers are those of
// compare() in truth.hpp. All parts throw Interrupted after a signal.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "plan.hpp"
#include "timing.hpp"

namespace fastccd::tools::report {

/// Table 1 and Figure 1 of the paper: random pairs, E_tol against time, contacts at odd and at even numbers of roots.
[[nodiscard]] Json paper_table(const Plan& plan, ReportProgress& progress);

/// Every instruction set and E_tol, and other libraries: pairs per second against the error of toi.
[[nodiscard]] Json speed_and_error(const Plan& plan, ReportProgress& progress);

/// Hard pairs, set by set: what is wrong without and with the exact verdict, what it costs.
[[nodiscard]] Json hard_cases(const Plan& plan, ReportProgress& progress);

/// Steps of scenes: candidates, contacts, degenerate cubics, times.
[[nodiscard]] Json scenes(const Plan& plan, ReportProgress& progress);

/// Threads, and numbers of pairs.
[[nodiscard]] Json scaling(const Plan& plan, ReportProgress& progress);

/// Read the public data that hard_cases() and scenes() will use, and throw if any of it cannot be used: that is known before anything
/// is measured.
void check_hard_cases(const std::filesystem::path& data);
void check_scenes(const std::filesystem::path& data);

// --- what several parts do ---

/// Instruction sets that can be run here, narrowest first.
[[nodiscard]] std::vector<Isa> available();

/// 1, 2, 3 and so on up to the number of threads that the caller's arena has; beyond 8 doubling.
[[nodiscard]] std::vector<int> thread_counts();

/// Seconds that `work` takes in an arena of that many threads.
[[nodiscard]] double seconds_on(int threads, const std::function<void()>& work);

/// Processor time of `work` on one thread, the calling one: as on a clock where the machine is quiet, but other programs on it
/// disturb it less.
[[nodiscard]] double processor_seconds(const std::function<void()>& work);

}  // namespace fastccd::tools::report
