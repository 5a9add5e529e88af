#include "format.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "../report_totals.hpp"

namespace fastccd::tools::report {

std::string count(const Json& number) { return number.is_null() ? "-" : with_commas(number.get<std::size_t>()); }

std::string figure(const Json& number) { return number.is_number() ? figure(number.get<double>()) : "-"; }

std::string figure(double number)
{
    if (std::abs(number) >= 1000 && std::abs(number) < 1e15) {
        const double unit = std::pow(10.0, std::floor(std::log10(std::abs(number))) - 2);
        const auto rounded = static_cast<std::size_t>(std::round(std::abs(number) / unit) * unit + 0.5);
        return fmt::format("{}{}", number < 0 ? "-" : "", with_commas(rounded));
    }
    return fmt::format("{:.3g}", number);
}

std::string how(const Json& timing)
{
    const auto repeats = timing.at("repeats").get<std::size_t>();
    const char* const clock = timing.at("clock") == "processor" ? ", processor time" : "";
    if (repeats < 2) return fmt::format("measured once{}", clock);
    const double median = timing.at("seconds"), spread = timing.at("most").get<double>() - timing.at("least").get<double>();
    return fmt::format("median of {}, spread {:.2g} %{}", repeats, median > 0 ? 100 * spread / median : 0.0, clock);
}

double million_pairs_per_second(const Json& timing) { return 1e-6 * timing.value("pairs_per_second", 0.0); }

std::string wrong_answers(const Json& comparison)
{
    return fmt::format("{} missed, {} late, {} false alarms", count(comparison.at("missed")), count(comparison.at("late")),
                       count(comparison.at("false_alarms")));
}

std::string isa_label(const std::string& isa)
{
    if (isa == "avx512") return "AVX-512";
    if (isa == "avx2") return "AVX2";
    if (isa == "sse2") return "SSE2";
    return isa == "neon" ? "NEON" : isa;
}

const char* kind_label(const std::string& kind) { return kind == "vf" ? "vertex-face" : "edge-edge"; }

}  // namespace fastccd::tools::report
