// What is computed from the polynomials of a pair over a leaf (kernels/restriction.hpp): on its parts, and in time.
#include <cmath>

#include <restriction.hpp>
#include <search_coefficients.hpp>

#include "exact_number.hpp"
#include "measured_bound.hpp"

namespace fastccd::testing {
namespace {

using FASTCCD_KERNEL_NAMESPACE::Cubic;
using FASTCCD_KERNEL_NAMESPACE::Linear;
using FASTCCD_KERNEL_NAMESPACE::Quadratic;
using Polynomials = PolynomialsOf<double>;

/// Coefficients on [a, b] of the polynomial that has exactly these on [0, 1].
template <std::size_t count>
std::array<Exact, count> exact_on_part(const std::array<double, count>& coefficients, double a, double b)
{
    std::array<Exact, count> on_part;
    for (std::size_t k = 0; k < count; ++k) {
        std::array<Exact, count> blossom;
        for (std::size_t i = 0; i < count; ++i) blossom[i] = coefficients[i];
        for (std::size_t level = 1; level < count; ++level) {
            const Exact s = level <= count - 1 - k ? a : b, rest = Exact(1.0) - s;
            for (std::size_t i = 0; i + level < count; ++i) blossom[i] = rest * blossom[i] + s * blossom[i + 1];
        }
        on_part[k] = blossom[0];
    }
    return on_part;
}

/// In units of lerp_rounding().
template <std::size_t count>
double worst_difference(const std::array<double, count>& coefficients, const std::array<double, count>& computed, const Input& in)
{
    double largest = 0.0, worst = 0.0;
    for (const double c : coefficients) largest = std::max(largest, std::abs(c));
    const auto exact = exact_on_part(coefficients, in.a, in.b);
    const double rounding = FASTCCD_KERNEL_NAMESPACE::lerp_rounding(static_cast<int>(count) - 1, largest);
    for (std::size_t k = 0; k < count; ++k) worst = std::max(worst, (exact[k] - Exact(computed[k])).magnitude_in(rounding));
    return worst;
}

/// Over a leaf that holds in.a, of a width that depends on in.b.
Polynomials leaf_of(const Input& in)
{
    using namespace FASTCCD_KERNEL_NAMESPACE;
    const Computed c{in};
    PairCoefficients whole;
    find_coefficients<PairKind::vertex_face>(c.r, c.r, c.bounds, whole);
    const double width = std::ldexp(1.0, -static_cast<int>(std::fmod(in.b * 1024.0, 24.0)));
    const double left = std::min(std::floor(in.a / width) * width, 1.0 - width);
    return restricted_to<PairKind::vertex_face>(whole, left, left + width);
}

TEST(Restriction, RoundingOnParts)
{
    expect_bound("lerp_rounding, cubic", 0.1, [](const Input& in) {
        const Polynomials leaf = leaf_of(in);
        const auto& f = leaf.cubic;
        const auto part = FASTCCD_KERNEL_NAMESPACE::on_interval(Cubic<double>{f[0], f[1], f[2], f[3]}, in.a, in.b);
        return worst_difference<4>({f[0], f[1], f[2], f[3]}, {part.c0, part.c1, part.c2, part.c3}, in);
    });
    expect_bound("lerp_rounding, quadratic", 0.1, [](const Input& in) {
        const Polynomials leaf = leaf_of(in);
        const auto& e = leaf.edges[1][2];
        const auto part = FASTCCD_KERNEL_NAMESPACE::on_interval(Quadratic<double>{e.start, e.middle, e.end}, in.a, in.b);
        return worst_difference<3>({e.start, e.middle, e.end}, {part.c0, part.c1, part.c2}, in);
    });
    expect_bound("lerp_rounding, gap", 0.1, [](const Input& in) {
        const Polynomials leaf = leaf_of(in);
        const auto& g = leaf.gaps[2][1];
        const auto part = FASTCCD_KERNEL_NAMESPACE::on_interval(Linear<double>{g.start, g.end}, in.a, in.b);
        return worst_difference<2>({g.start, g.end}, {part.c0, part.c1}, in);
    });
}

TEST(Restriction, TimesAreRoundedDown)
{
    Adversary adversary{83};
    int rounded = 0;
    for (int i = 0; i < 100000; ++i) {
        const double width = std::ldexp(1.0, -adversary.integer(0, 50)), left = std::floor(adversary.uniform(0, 1) / width) * width;
        const double s = adversary.uniform(0, 1) * std::ldexp(1.0, -adversary.integer(0, 20));
        Polynomials part{};
        part.origin = left, part.duration = width;
        const double time = FASTCCD_KERNEL_NAMESPACE::earlier_in_step(part, s);
        const Exact exact = Exact(left) + Exact(width) * Exact(s);
        ASSERT_FALSE(exact < Exact(time)) << left << " + " << width << " x " << s;
        ASSERT_GE(time, left);
        ASSERT_GE(time, (left + width * s) * (1.0 - 0x1p-51));
        rounded += Exact(time) < exact;
    }
    EXPECT_GT(rounded, 10000);
}

}  // namespace
}  // namespace fastccd::testing
