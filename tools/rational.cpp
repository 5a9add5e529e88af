#include "rational.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <gmp.h>

namespace fastccd::tools {
namespace {

/// An integer taken apart; `digits` has no leading zeros and is empty for zero.
struct Decimal {
    bool negative;
    std::string_view digits;
};

Decimal split(std::string_view text)
{
    const bool negative = text.front() == '-';
    if (negative || text.front() == '+') text.remove_prefix(1);
    text.remove_prefix(std::min(text.find_first_not_of('0'), text.size()));
    return {negative, text};
}

std::optional<std::uint64_t> small(std::string_view digits)
{
    if (digits.empty()) return 0;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{}) return std::nullopt;
    return value;
}

/// Owns one integer of GMP.
class Integer {
public:
    Integer() { mpz_init(value_); }
    explicit Integer(std::string_view digits)
    {
        mpz_init_set_str(value_, std::string{digits}.c_str(), 10);
    }
    ~Integer() { mpz_clear(value_); }
    Integer(const Integer&) = delete;
    Integer& operator=(const Integer&) = delete;

    [[nodiscard]] mpz_ptr get() noexcept { return value_; }
    [[nodiscard]] std::int64_t bits() const noexcept
    {
        return static_cast<std::int64_t>(mpz_sizeinbase(value_, 2));
    }

private:
    mpz_t value_;
};

/// n / d for positive n and d of any size.
RationalValue divide(std::string_view numerator, std::string_view denominator)
{
    constexpr std::int64_t precision = std::numeric_limits<double>::digits;           // 53
    constexpr std::int64_t least_exponent = std::numeric_limits<double>::min_exponent - precision;  // -1074
    constexpr std::int64_t greatest_exponent = std::numeric_limits<double>::max_exponent;           // 1024

    Integer n{numerator};
    Integer d{denominator};
    // n / d lies strictly between 2^(order - 1) and 2^(order + 1). Decided first for the extremes, so
    // that the shifts below stay in proportion to the numbers given.
    const std::int64_t order = n.bits() - d.bits();
    if (order > greatest_exponent) return {std::numeric_limits<double>::infinity(), Conversion::overflow};
    if (order + 1 < least_exponent) return {0.0, Conversion::rounded};

    // Quotient of n 2^-exponent and d: 54 or 55 bits, fewer where the doubles are subnormal, and a
    // remainder that says whether the rest is zero.
    const std::int64_t exponent = std::max(order - precision - 1, least_exponent - 1);
    if (exponent < 0) {
        mpz_mul_2exp(n.get(), n.get(), static_cast<mp_bitcnt_t>(-exponent));
    } else {
        mpz_mul_2exp(d.get(), d.get(), static_cast<mp_bitcnt_t>(exponent));
    }
    Integer q;
    Integer r;
    mpz_tdiv_qr(q.get(), r.get(), n.get(), d.get());
    std::uint64_t quotient = mpz_get_ui(q.get());
    const bool rest = mpz_sgn(r.get()) != 0;

    // Bits of the quotient below the last one of a double: one or two.
    const int quotient_bits = 64 - std::countl_zero(quotient);
    const int dropped = std::max(1, quotient_bits - static_cast<int>(precision));
    const std::uint64_t tail = quotient & ((std::uint64_t{1} << dropped) - 1);
    const std::uint64_t half = std::uint64_t{1} << (dropped - 1);
    quotient >>= dropped;
    const bool exact = tail == 0 && !rest;
    if (tail > half || (tail == half && (rest || (quotient & 1) != 0))) ++quotient;

    const double value = std::ldexp(static_cast<double>(quotient), static_cast<int>(exponent) + dropped);
    if (std::isinf(value)) return {value, Conversion::overflow};
    return {value, exact ? Conversion::exact : Conversion::rounded};
}

}  // namespace

bool is_integer(std::string_view text) noexcept
{
    if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

RationalValue rational_to_double(std::string_view numerator, std::string_view denominator)
{
    const Decimal n = split(numerator);
    const Decimal d = split(denominator);
    if (d.digits.empty()) return {std::numeric_limits<double>::quiet_NaN(), Conversion::zero_denominator};
    if (n.digits.empty()) return {0.0, Conversion::exact};

    const double sign = n.negative != d.negative ? -1.0 : 1.0;
    // Nearly all rationals in use are a double's 53 bits over a power of two: no big integers needed.
    const std::optional<std::uint64_t> n64 = small(n.digits);
    const std::optional<std::uint64_t> d64 = small(d.digits);
    if (n64 && d64 && std::has_single_bit(*d64) && (*n64 >> std::countr_zero(*n64)) < (std::uint64_t{1} << 53)) {
        return {sign * std::ldexp(static_cast<double>(*n64), -std::countr_zero(*d64)), Conversion::exact};
    }
    const RationalValue result = divide(n.digits, d.digits);
    return {sign * result.value, result.conversion};
}

}  // namespace fastccd::tools
