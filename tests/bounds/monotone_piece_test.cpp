// Monotone pieces of the cubic: two end values beyond the threshold on the same side leave no room for a root.
#include <sign_change.hpp>

#include "../oracle/algebraic_number.hpp"
#include "exact_number.hpp"
#include "measured_bound.hpp"

namespace fastccd::testing {
namespace {

using portable::Cubic;
using portable::MonotonePieces;

/// Cuts and values as the lanes compute them; the threshold is that of monotone_piece() alone.
MonotonePieces<double> pieces_of(const Cubic<double>& f, double low = 0.0, double high = 1.0)
{
    return portable::monotone_pieces(f, 0.0, ErrorBounds{1.0}, 0.0, low, high);
}

double largest_coefficient(const Cubic<double>& f)
{
    return std::max(std::max(std::fabs(f.c0), std::fabs(f.c1)), std::max(std::fabs(f.c2), std::fabs(f.c3)));
}

/// The cubic with exactly these Bernstein coefficients, in the power basis with digits to spare.
struct WideCubic {
    mpf_class c[4];

    explicit WideCubic(const Cubic<double>& f)
    {
        const Exact b0 = f.c0, b1 = f.c1, b2 = f.c2, b3 = f.c3, three = 3.0, two = 2.0;
        c[0] = b0.wide();
        c[1] = (three * (b1 - b0)).wide();
        c[2] = (three * (b0 - two * b1 + b2)).wide();
        c[3] = (b3 - b0 + three * (b1 - b2)).wide();
    }

    [[nodiscard]] mpf_class at(const mpf_class& s) const
    {
        return mpf_class(((c[3] * s + c[2]) * s + c[1]) * s + c[0], 1024);
    }

    /// Smallest and largest value on [low, high]: at an end, or where the derivative vanishes.
    [[nodiscard]] std::pair<mpf_class, mpf_class> range(const mpf_class& low, const mpf_class& high) const
    {
        mpf_class smallest = at(low), largest = smallest;
        const auto see = [&](const mpf_class& s) {
            if (s < low || s > high) return;
            const mpf_class value = at(s);
            if (value < smallest) smallest = value;
            if (value > largest) largest = value;
        };
        see(high);
        const mpf_class a(3 * c[3], 1024), h = c[2], constant = c[1], D(h * h - a * constant, 1024);
        if (sgn(a) == 0) {
            if (sgn(h) != 0) see(mpf_class(-constant / (2 * h), 1024));
        } else if (sgn(D) >= 0) {
            const mpf_class root(sqrt(D));
            see(mpf_class((-h - root) / a, 1024));
            see(mpf_class((-h + root) / a, 1024));
        }
        return {smallest, largest};
    }
};

/// How far the exact cubic goes below the smaller computed end value of a piece, or above the larger one, in
/// units of the threshold. Were it 1, an end value at the threshold could hide a root.
double dip_ratio(const Cubic<double>& f)
{
    const WideCubic exact{f};
    double worst = 0;
    for (const auto& [low, high] : {std::pair{0.0, 1.0}, std::pair{0.0, 0.5}, std::pair{0.5, 1.0}}) {
        const MonotonePieces<double> pieces = pieces_of(f, low, high);
        for (int k = 0; k < 3; ++k) {
            const auto [smallest, largest] = exact.range(mpf_class(pieces.time[k], 1024), mpf_class(pieces.time[k + 1], 1024));
            const mpf_class below(mpf_class(std::min(pieces.value[k], pieces.value[k + 1]), 1024) - smallest, 1024);
            const mpf_class above(largest - mpf_class(std::max(pieces.value[k], pieces.value[k + 1]), 1024), 1024);
            worst = std::max({worst, below.get_d(), above.get_d()});
        }
    }
    return worst / (ErrorBounds::monotone_piece() * largest_coefficient(f));
}

/// A cubic k (s - p)^2 (s - q), or of general position, in Bernstein form, rounded.
Cubic<double> start_cubic(Adversary& adversary)
{
    if (adversary.chance(0.3))
        return {adversary.coordinate(), adversary.coordinate(), adversary.coordinate(), adversary.coordinate()};
    const double p = adversary.uniform(-0.1, 1.1), q = adversary.chance(0.3) ? p : adversary.uniform(-2, 3);
    const double c1 = p * p + 2 * p * q, c2 = -(2 * p + q), c0 = -p * p * q;
    return {c0, c0 + c1 / 3, c0 + (2 * c1 + c2) / 3, c0 + c1 + c2 + 1};
}

Cubic<double> changed(Adversary& adversary, Cubic<double> f)
{
    double* const c[] = {&f.c0, &f.c1, &f.c2, &f.c3};
    for (int n = adversary.integer(1, 2); n > 0; --n) {
        double& x = *c[adversary.integer(0, 3)];
        x = adversary.chance(0.2) ? std::nextafter(x, adversary.sign() * 1e300)
                                  : x * (1 + adversary.uniform(-1, 1) * std::ldexp(1.0, -adversary.integer(1, 53)));
    }
    return f;
}

TEST(MonotonePieces, EndValuesBeyondTheThresholdProveThatThereIsNoRoot)
{
    Adversary adversary{12};
    const auto [f, found] = adversary.worst(
        60, 400, [&] { return start_cubic(adversary); }, [&](const Cubic<double>& g) { return changed(adversary, g); }, dip_ratio);
    std::printf("%-34s worst dip / bound: %.5f\n", "monotone_piece", found);
    EXPECT_LT(found, 1.0) << f.c0 << ' ' << f.c1 << ' ' << f.c2 << ' ' << f.c3;
    // The constant adds up what backward stability of the quadratic formula allows; the dips are far smaller, as
    // an extremum moved by e changes the value by e^2 only.
    EXPECT_GT(found, 0.0005);
}

oracle::Polynomial integer_polynomial(const Cubic<double>& f)
{
    const std::array<double, 4> b{f.c0, f.c1, f.c2, f.c3};
    std::array<mpz_class, 4> n;
    oracle::to_common_integers(b, n);
    oracle::Polynomial p;
    p.coefficient = {n[0], mpz_class(3 * (n[1] - n[0])), mpz_class(3 * (n[0] - 2 * n[1] + n[2])),
                     mpz_class(n[3] - n[0] + 3 * (n[1] - n[2]))};
    return p;
}

/// Pieces with two end values of one strict sign, on nearly double roots: roots isolated exactly.
TEST(MonotonePieces, NoRootIsHiddenNearDoubleRoots)
{
    Adversary adversary{13};
    std::size_t proven = 0, hidden_without_threshold = 0;
    for (int i = 0; i < 30000; ++i) {
        Cubic<double> f = start_cubic(adversary);
        // Off the double root by a few roundings, or by about the threshold.
        const double off = adversary.sign() * std::ldexp(adversary.uniform(0, 1), -adversary.integer(38, 53));
        f = {f.c0 + off, f.c1 + off, f.c2 + off, f.c3 + off};
        // Discriminants must not underflow at the smallest volume that the lanes take.
        const double scale = adversary.chance(0.5) ? 1.0 : smallest_volume;
        f = {f.c0 * scale, f.c1 * scale, f.c2 * scale, f.c3 * scale};
        const MonotonePieces<double> pieces = pieces_of(f);
        const oracle::Polynomial p = integer_polynomial(f);
        if (p.is_zero()) continue;
        auto roots = oracle::roots_in_unit_interval(p);
        for (int k = 0; k < 3; ++k) {
            const double low = pieces.value[k], high = pieces.value[k + 1];
            if (low * (high / std::fabs(high)) <= 0.0 || pieces.time[k] > pieces.time[k + 1]) continue;
            const bool root = std::ranges::any_of(roots, [&](oracle::Root& r) {
                return r.value.compare_to(oracle::to_dyadic(pieces.time[k])) >= 0 &&
                       r.value.compare_to(oracle::to_dyadic(pieces.time[k + 1])) <= 0;
            });
            hidden_without_threshold += root;
            if (std::min(std::fabs(low), std::fabs(high)) <= pieces.threshold) continue;
            ++proven;
            ASSERT_FALSE(root) << f.c0 << ' ' << f.c1 << ' ' << f.c2 << ' ' << f.c3;
        }
    }
    EXPECT_GT(proven, 5000u);
    EXPECT_GT(hidden_without_threshold, 50u) << "signs alone never erred: nothing was tested";
}

/// On [a, a + w], exactly: the inner coefficients against the chord between the outer ones.
double deviation_ratio(const Cubic<double>& f, double a, double b)
{
    const Exact c[] = {f.c0, f.c1, f.c2, f.c3};
    const auto blossom = [&](const Exact& x, const Exact& y, const Exact& z) {
        const auto lerp = [](const Exact& p, const Exact& q, const Exact& s) { return (Exact(1.0) - s) * p + s * q; };
        const Exact p = lerp(c[0], c[1], x), q = lerp(c[1], c[2], x), r = lerp(c[2], c[3], x);
        return lerp(lerp(p, q, y), lerp(q, r, y), z);
    };
    const Exact b0 = blossom(a, a, a), b1 = blossom(a, a, b), b2 = blossom(a, b, b), b3 = blossom(b, b, b);
    const Exact two = 2.0, three = 3.0;
    const double w = b - a, bound = 3 * ErrorBounds::hull_deviation * w * w * largest_coefficient(f);
    return std::max((three * b1 - two * b0 - b3).magnitude_in(bound), (three * b2 - b0 - two * b3).magnitude_in(bound));
}

TEST(MonotonePieces, HullDeviation)
{
    Adversary adversary{14};
    struct Place {
        Cubic<double> f;
        double a, b;
    };
    const auto start = [&] {
        const double a = 0.5 * adversary.time(), w = std::ldexp(1.0, -adversary.integer(1, 40));
        return Place{{adversary.coordinate(), adversary.coordinate(), adversary.coordinate(), adversary.coordinate()}, a, a + w};
    };
    const auto [place, found] = adversary.worst(
        60, 200, start, [&](const Place& p) { return Place{changed(adversary, p.f), p.a, p.b}; },
        [](const Place& p) { return p.b > p.a ? deviation_ratio(p.f, p.a, p.b) : 0.0; });
    std::printf("%-34s worst deviation / bound: %.5f\n", "hull_deviation", found);
    // Attained in the limit; the width b - a is rounded.
    EXPECT_LE(found, 1.0 + 0x1p-40);
    EXPECT_GT(found, 0.5);
}

}  // namespace
}  // namespace fastccd::testing
