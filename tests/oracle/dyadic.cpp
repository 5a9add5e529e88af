#include "dyadic.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fastccd::oracle {
namespace {

struct Split {
    std::int64_t mantissa;  // odd or zero
    int exponent;
};

// value = mantissa 2^exponent, exactly; frexp normalises subnormal numbers too.
Split split(double value) {
    if (value == 0.0) return {0, 0};
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);  // in [1/2, 1)
    auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
    exponent -= 53;
    while (mantissa % 2 == 0) {
        mantissa /= 2;
        ++exponent;
    }
    return {mantissa, exponent};
}

mpz_class from_int64(std::int64_t value) {
    static_assert(sizeof(long) == sizeof(std::int64_t));
    return mpz_class(static_cast<long>(value));
}

}  // namespace

bool is_finite(const Pair& pair) {
    return std::ranges::all_of(pair, [](const auto& point) {
        return std::ranges::all_of(point, [](double x) { return std::isfinite(x); });
    });
}

Dyadic to_dyadic(double value, int shift) {
    const Split s = split(value);
    const int exponent = s.exponent - shift;
    Dyadic result{from_int64(s.mantissa), 0};
    if (exponent >= 0) {
        result.numerator <<= static_cast<mp_bitcnt_t>(exponent);
    } else {
        result.level = static_cast<mp_bitcnt_t>(-exponent);
    }
    return result;
}

int compare(const Dyadic& a, const Dyadic& b) {
    if (a.level == b.level) return cmp(a.numerator, b.numerator);
    if (a.level < b.level) return cmp(mpz_class(a.numerator << (b.level - a.level)), b.numerator);
    return cmp(a.numerator, mpz_class(b.numerator << (a.level - b.level)));
}

void bring_to_common_level(Dyadic& a, Dyadic& b) {
    const mp_bitcnt_t level = std::max(a.level, b.level);
    a = {a.numerator << (level - a.level), level};
    b = {b.numerator << (level - b.level), level};
}

int to_common_integers(std::span<const double> values, std::span<mpz_class> integers) {
    int least = 0;
    bool any = false;
    for (const double value : values) {
        if (value == 0.0) continue;
        const int exponent = split(value).exponent;
        least = any ? std::min(least, exponent) : exponent;
        any = true;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Split s = split(values[i]);
        integers[i] = from_int64(s.mantissa);
        if (s.mantissa != 0) integers[i] <<= static_cast<mp_bitcnt_t>(s.exponent - least);
    }
    return -least;
}

}  // namespace fastccd::oracle
