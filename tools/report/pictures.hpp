// The pictures of a report.
#pragma once

#include <string>
#include <vector>

#include "timing.hpp"

namespace fastccd::tools::report {

struct Picture {
    std::string name;  ///< Of its file, without .svg.
    std::string svg;
};

/// All pictures that the report has figures for. Throws Json::exception if it is not of its form.
[[nodiscard]] std::vector<Picture> draw_pictures(const Json& report);

/// Of the points (speed, error), those that no other beats in both, from small to large error.
struct SpeedError {
    double million_pairs_per_second, error;
};
[[nodiscard]] std::vector<SpeedError> pareto_front(std::vector<SpeedError> points);

}  // namespace fastccd::tools::report
