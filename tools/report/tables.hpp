// The figures of a report as HTML tables.
//
// Rows of judged answers carry data-judged (what it is about) and cells of class missed, late and false-alarms, so that a test
// can read what the page says.
#pragma once

#include <string>

#include "timing.hpp"

namespace fastccd::tools::report {

[[nodiscard]] std::string paper_tables(const Json& part);
[[nodiscard]] std::string speed_error_tables(const Json& part, const std::string& kind);
[[nodiscard]] std::string hard_case_table(const Json& part);
[[nodiscard]] std::string scene_tables(const Json& part);
[[nodiscard]] std::string scaling_tables(const Json& part);

}  // namespace fastccd::tools::report
