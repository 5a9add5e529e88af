// Figures as people read them.
#pragma once

#include <string>

#include "timing.hpp"

namespace fastccd::tools::report {

/// The last of a list. Throws Json::exception if there is none: a report.json that is drawn again may hold anything.
[[nodiscard]] inline const Json& last(const Json& list) { return list.at(list.size() - 1); }

/// 1234567 as "1,234,567".
[[nodiscard]] std::string count(const Json& number);

/// Three digits: "0.00123", "45.7", "1,230,000"; "-" for null.
[[nodiscard]] std::string figure(const Json& number);
[[nodiscard]] std::string figure(double number);

/// "median of 7, spread 3 %, processor time": the spread is between the least and the most, relative to the median.
[[nodiscard]] std::string how(const Json& timing);

/// Pairs per second of a timing, in millions; 0 if it has none.
[[nodiscard]] double million_pairs_per_second(const Json& timing);

/// "0 missed, 0 late, 0 false alarms".
[[nodiscard]] std::string wrong_answers(const Json& comparison);

/// "AVX-512" for "avx512" and so on.
[[nodiscard]] std::string isa_label(const std::string& isa);

/// "vertex-face" for "vf", "edge-edge" for "ee".
[[nodiscard]] const char* kind_label(const std::string& kind);

}  // namespace fastccd::tools::report
