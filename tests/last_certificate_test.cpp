// The ends of certificates (kernels/last_certificate.hpp) are guesses, of which no result depends on being right; but each one that is wrong
// ends what lanes can say of a pair. So they are to hold nearly always, and to be near to where the certificate really ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include <last_certificate.hpp>
#include <pair_polynomials.hpp>

#include "amount.hpp"
#include "narrow_phase.hpp"
#include "touching_pairs_made.hpp"

namespace fastccd::testing {
namespace {

using namespace FASTCCD_KERNEL_NAMESPACE;

/// Coefficients of a function on [0, s].
std::array<double, 2> coefficients(const Linear<double>& f, double s) { return {f.c0, on_interval(f, 0.0, s).c1}; }
std::array<double, 3> coefficients(const Quadratic<double>& f, double s)
{
    const Quadratic<double> g = on_interval(f, 0.0, s);
    return {g.c0, g.c1, g.c2};
}
std::array<double, 4> coefficients(const Cubic<double>& f, double s)
{
    const Cubic<double> g = on_interval(f, 0.0, s);
    return {g.c0, g.c1, g.c2, g.c3};
}

/// Functions with c0 > e > 0, times a sign.
template <class Polynomial>
void expect_ends_of(const char* name, Polynomial (*random)(std::mt19937_64&))
{
    std::mt19937_64 bits{829};
    constexpr double e = 0.01, rounding = 1e-12;
    std::size_t ends = 0, hold = 0;
    double sum_of_shares = 0.0;
    for (std::size_t i = 0; i < amount(20000); ++i) {
        const Polynomial f = random(bits);
        const double until = above_until(f, e), sign = std::copysign(1.0, f.c0);
        ASSERT_TRUE(0.0 <= until && until <= 1.0) << name << ": " << until;
        const auto holds_until = [&](double s) {
            for (const double c : coefficients(f, s))
                if (sign * c < e - rounding) return false;
            return true;
        };
        // Where the certificate really ends: it holds on each part of an interval on which it does.
        double low = 0.0, high = 1.0;
        if (holds_until(1.0)) {
            ASSERT_EQ(until, 1.0) << name;
            continue;
        }
        while (high - low > rounding) (holds_until(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
        ++ends;
        hold += until <= high;
        sum_of_shares += std::min(until / high, 1.0);
    }
    std::printf("%s: of %zu ends %.1f %% hold, on average until %.3f of where they might\n", name, ends, 100.0 * static_cast<double>(hold) / static_cast<double>(ends),
                sum_of_shares / static_cast<double>(ends));
    EXPECT_GT(ends, amount(3000)) << name;
    EXPECT_GE(static_cast<double>(hold), 0.99 * static_cast<double>(ends)) << name;
    EXPECT_GE(sum_of_shares, 0.8 * static_cast<double>(ends)) << name;
}

double between(std::mt19937_64& bits, double low, double high) { return low + (high - low) * std::ldexp(static_cast<double>(bits() >> 11), -53); }
double first(std::mt19937_64& bits) { return (bits() % 2 == 0 ? 1.0 : -1.0) * between(bits, 0.02, 1.0); }
double other(std::mt19937_64& bits) { return between(bits, -1.0, 1.0); }

TEST(LastCertificate, FunctionsStayAboveUntilTheirEnd)
{
    expect_ends_of<Linear<double>>("linear", [](std::mt19937_64& bits) { return Linear<double>{first(bits), other(bits)}; });
    expect_ends_of<Quadratic<double>>("quadratic", [](std::mt19937_64& bits) { return Quadratic<double>{first(bits), other(bits), other(bits)}; });
    expect_ends_of<Cubic<double>>("cubic", [](std::mt19937_64& bits) { return Cubic<double>{first(bits), other(bits), other(bits), other(bits)}; });
}

/// (root - s)^2 (third - s), whose blossom is the mean of its products of linear factors.
Cubic<double> with_double_root(double root, double third)
{
    const auto blossom = [&](double a, double b, double c) {
        const auto product = [&](double x, double y, double z) { return (root - x) * (root - y) * (third - z); };
        return (product(a, b, c) + product(b, c, a) + product(c, a, b)) / 3.0;
    };
    return {blossom(0, 0, 0), blossom(0, 0, 1), blossom(0, 1, 1), blossom(1, 1, 1)};
}

/// Of cubics that only graze zero, each certificate leads most of the way that is left, to where they come down to e. By Newton's method each
/// would halve it, and some 20 would be needed.
TEST(LastCertificate, GrazingCubicsAreFollowedInFew)
{
    std::mt19937_64 bits{831};
    constexpr double e = 1e-14;
    constexpr int most = 6;  // as lanes follow
    std::size_t cubics = 0, reached = 0, certificates = 0;
    for (std::size_t i = 0; i < amount(20000); ++i) {
        const double root = between(bits, 0.05, 0.95), third = bits() % 2 == 0 ? between(bits, 1.05, 4.0) : between(bits, -3.0, -0.05);
        const Cubic<double> f = with_double_root(root, third);
        const double down_at = root - std::sqrt(e / std::abs(third - root));
        double time = 0.0;
        for (int k = 0; k < most && time < root - 2.0 * (root - down_at); ++k, ++certificates)
            time = time_at_share(above_until(on_interval(f, time, 1.0), e), time, 1.0);
        ++cubics;
        // Coefficients that are rounded err by some 10 % of e.
        reached += time >= root - 2.0 * (root - down_at) && (root - time) * (root - time) * std::abs(third - time) >= 0.9 * e;
    }
    std::printf("of %zu cubics %.1f %% are followed to their end, in %.1f certificates on average\n", cubics,
                100.0 * static_cast<double>(reached) / static_cast<double>(cubics), static_cast<double>(certificates) / static_cast<double>(cubics));
    EXPECT_GE(static_cast<double>(reached), 0.99 * static_cast<double>(cubics));
}

template <PairKind kind>
void follow(const std::vector<oracle::Pair>& pairs, std::size_t& asked, std::size_t& held, std::size_t& skipped)
{
    constexpr CertificateLevel certain{1.0, 2.0};
    const SearchParameters parameters{1e-9, 1.0, false};
    const auto all = all_lanes<double>();
    for (const oracle::Pair& pair : pairs) {
        const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
        for (double time = 0.0; time < 1.0;) {
            const double end = last_certificate<kind>(polynomials.coefficients(), time, 1.0, certain, all);
            ASSERT_TRUE(time <= end && end <= 1.0) << lossless(pair);
            // Nothing is computed for who is not asked.
            const double unasked = last_certificate<kind>(polynomials.coefficients(), time, 1.0, certain, !all);
            ASSERT_TRUE(time <= unasked && unasked <= end) << lossless(pair);
            if (end <= time + 0x1p-20) break;
            ++asked;
            skipped += unasked < end;
            held += polynomials.apart({time, end});
            time = end;
        }
    }
}

TEST(LastCertificate, HoldsToItsEnd)
{
    for (const auto kind : kinds) {
        std::size_t asked = 0, held = 0, skipped = 0;
        for_each_family(kind, 830, amount(300), [&](const std::vector<oracle::Pair>& pairs, const std::string&) {
            if (kind == oracle::Kind::vertex_face)
                follow<PairKind::vertex_face>(pairs, asked, held, skipped);
            else
                follow<PairKind::edge_edge>(pairs, asked, held, skipped);
        });
        std::printf("%s: of %zu certificates %zu hold to their end\n", kind_name(kind), asked, held);
        EXPECT_GT(asked, amount(10000));
        EXPECT_GE(static_cast<double>(held), 0.995 * static_cast<double>(asked));
        EXPECT_EQ(skipped, asked);
    }
}

}  // namespace
}  // namespace fastccd::testing
