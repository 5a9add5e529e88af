// Hard cases at a glance.
#pragma once

#include <vector>

#include "pictures.hpp"
#include "timing.hpp"

namespace fastccd::tools::report {

/// One picture for the sets that are made here, and one for each kind of public sets in the report: a row for each family, a
/// group of columns for each thing that can go wrong or cost.
[[nodiscard]] std::vector<Picture> heat_maps(const Json& hard_cases);

}  // namespace fastccd::tools::report
