// Decimal fractions of whole numbers to double, exactly or correctly rounded.
#pragma once

#include <cstdint>
#include <string_view>

namespace fastccd::tools {

/// True for an optional sign and at least one decimal digit, nothing else.
[[nodiscard]] bool is_integer(std::string_view text) noexcept;

enum class Conversion : std::uint8_t {
    exact,                 ///< The rational is a double.
    rounded,               ///< It is none; the value is the nearest double, ties to even.
    overflow,              ///< It rounds to beyond the largest double; the value is an infinity.
    zero_denominator,      ///< There is no value.
};

struct RationalValue {
    double value;
    Conversion conversion;
};

/// numerator / denominator, both satisfying is_integer.
[[nodiscard]] RationalValue rational_to_double(std::string_view numerator, std::string_view denominator);

}  // namespace fastccd::tools
