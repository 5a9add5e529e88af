// The report as a page.
#pragma once

#include <string>
#include <vector>

#include "pictures.hpp"
#include "timing.hpp"

namespace fastccd::tools::report {

/// One HTML page that needs nothing else: style and pictures are in it, scripts there are none.
[[nodiscard]] std::string html_page(const Json& report, const std::vector<Picture>& pictures);

}  // namespace fastccd::tools::report
