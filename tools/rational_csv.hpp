// The query files of the NYU continuous collision detection benchmark (Wang et al. 2021, "A
// Large-scale Benchmark and an Inclusion-based Algorithm for Continuous Collision Detection").
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include <fastccd/pair_buffer.hpp>

namespace fastccd::tools {

/// What to do with a rational coordinate that is no double.
enum class Rounding : std::uint8_t {
    exact_only,  ///< It is an error.
    nearest,     ///< Round it to the nearest double, ties to even.
};

/// The contents of one file.
struct RationalCsv {
    PairBuffer pairs;
    /// Per pair 1 (contact) or 0 (none); empty if the file has no truth column.
    std::vector<std::int8_t> truth;
};

/// Reads eight rows a pair: x0..x3 at t = 0, then at t = 1. A row is
/// `xnum,xden,ynum,yden,znum,zden` and, in all rows or in none, the truth (0 or 1, the same in all
/// rows of a pair); integers of up to a million digits, blanks around them allowed. Lines end in LF or CR LF; the
/// last one may lack it. Zero rows are zero pairs.
///
/// Throws InputError naming `path`, the row and where it applies the column (both from 1): number of
/// columns, something that is no integer, denominator zero, coordinate that is no double (unless
/// `rounding` is nearest) or beyond its range, rows not a multiple of 8, truth missing or at odds.
/// Safe on any input.
[[nodiscard]] RationalCsv parse_rational_csv(std::string_view text, const std::filesystem::path& path,
                                             Rounding rounding);

/// parse_rational_csv of a file.
[[nodiscard]] RationalCsv read_rational_csv(const std::filesystem::path& path, Rounding rounding);

}  // namespace fastccd::tools
