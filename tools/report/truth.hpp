// Exact truth about pairs, and what is right or wrong with an answer.
//
// Truth comes from the tests' oracle, which shares no code with the library: the exact verdict of the library itself
// (Options::exact) is among what the report judges.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <fastccd/pair_view.hpp>
#include <fastccd/options.hpp>
#include <oracle/pair.hpp>

#include "timing.hpp"

namespace fastccd::tools::report {

[[nodiscard]] oracle::Kind oracle_kind(PairKind kind) noexcept;
[[nodiscard]] PairKind pair_kind(oracle::Kind kind) noexcept;

struct Truth {
    std::vector<char> contact;       ///< 1 or 0 for each pair.
    std::vector<double> t_lo, t_hi;  ///< The first time of contact lies between; +inf without contact. Empty: not known.
};

/// Asks the oracle about pairs [0, count), on all threads of the caller's arena. `done` hears how many are decided, from the
/// calling thread, and may throw.
[[nodiscard]] Truth exact_truth(PairKind kind, const PairView& pairs, std::size_t count,
                                const std::function<void(std::size_t)>& done);

/// An answer, pair by pair a time (+inf: none; NaN: contact at a time not told), held against the truth. As JSON:
///   pairs, contacts (in truth), reported
///   missed, late, false_alarms: how many; missed_pairs, late_pairs, false_alarm_pairs: which
///   signed_error: of toi minus exact time, over contacts found: earliest, p1, median, p99, latest; null if times are unknown
///   absolute_error: of its magnitude: median, p99, worst
[[nodiscard]] Json compare(const Truth& truth, std::span<const double> toi);

}  // namespace fastccd::tools::report
