// `fastccd report`.
#pragma once

#include <cstdint>
#include <string>

namespace fastccd::tools::report {

struct ReportOptions {
    std::string out = "fastccd-report";
    std::uint64_t pairs = 0;  ///< 0: what suits `quick`.
    std::string data;         ///< Folder of public data; empty: none.
    std::string draw;         ///< report.json to draw again; empty: measure.
    bool quick = false;
    bool quiet = false;
};

/// Measures, and writes report.html, report.json and the pictures to the folder `out`, all of them when everything is done or
/// none. Throws InputError naming the file at fault, Interrupted after a signal.
void write_report(const ReportOptions& options);

}  // namespace fastccd::tools::report
