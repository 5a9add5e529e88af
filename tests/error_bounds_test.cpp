// The rounding error bounds of error_bound.hpp and magnitudes.hpp against exact arithmetic, on inputs chosen to break
// them: coefficients and values. Further files in bounds/: margins, monotone pieces, the area inclusion test.
#include <area_inclusion.hpp>
#include <bernstein.hpp>
#include <halves_certificate.hpp>
#include <magnitudes.hpp>
#include <search_parameters.hpp>

#include "bounds/exact_number.hpp"
#include "bounds/measured_bound.hpp"

namespace fastccd::testing {
namespace {

constexpr double u = ErrorBounds::u;

/// Error / bound of every coefficient of the three cross products r1 x r2, r2 x r3, r3 x r1 on [0, to], where c.r ends.
template <class C>
double ratio_of_cross_products(const Input& in, const C& c, double quadratic, double to = 1.0)
{
    const ExactRelativeMotion exact{in.x.data(), in.t_max};
    double worst = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const auto q = portable::cross_product(c.r, static_cast<int>(i), static_cast<int>(j));
        const auto twice = twice_cross(exact.at(i, 0.0), exact.at(j, 0.0), exact.at(i, to), exact.at(j, to));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double bound = quadratic * area_of(c.scale, axis);
            for (const Exact& error : {twice[0][axis] - Exact(2 * component(q.start, axis)),
                                       twice[2][axis] - Exact(2 * component(q.end, axis))})
                worst = std::max(worst, error.magnitude_in(2 * bound));
            worst = std::max(worst, (twice[1][axis] - Exact(component(q.twice_middle, axis))).magnitude_in(bound));
        }
    }
    return worst;
}

template <class C>
double ratio_of_sums(const Input& in, const C& c, double quadratic_sum, double to = 1.0)
{
    const ExactRelativeMotion r{in.x.data(), in.t_max};
    const auto sum = portable::subtract_then_add(portable::cross_product(c.r, 1, 2), portable::cross_product(c.r, 0, 2),
                                                 portable::cross_product(c.r, 0, 1));
    const auto twice = twice_cross(r.at(2, 0.0) - r.at(1, 0.0), r.at(0, 0.0) - r.at(1, 0.0),
                                   r.at(2, to) - r.at(1, to), r.at(0, to) - r.at(1, to));
    double worst = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double bound = quadratic_sum * area_of(c.scale, axis);
        worst = std::max({worst, (twice[0][axis] - Exact(2 * component(sum.start, axis))).magnitude_in(2 * bound),
                          (twice[1][axis] - Exact(component(sum.twice_middle, axis))).magnitude_in(bound),
                          (twice[2][axis] - Exact(2 * component(sum.end, axis))).magnitude_in(2 * bound)});
    }
    return worst;
}

template <class C>
double ratio_of_cubics(const Input& in, const C& c, double cubic, double to = 1.0)
{
    const auto f = portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1));
    const auto thrice = thrice_cubic({in.x.data(), in.t_max}, 0.0, to);
    const double bound = cubic * number(c.scale.volume);
    const Exact three = 3.0;
    return std::max({(thrice[0] - three * Exact(number(f.start))).magnitude_in(3 * bound),
                     (thrice[1] - Exact(number(f.thrice_second))).magnitude_in(bound),
                     (thrice[2] - Exact(number(f.thrice_third))).magnitude_in(bound),
                     (thrice[3] - three * Exact(number(f.end))).magnitude_in(3 * bound)});
}

double cross_product_ratio(const Input& in)
{
    const Computed c{in};
    return ratio_of_cross_products(in, c, c.bounds.quadratic());
}
double cross_product_sum_ratio(const Input& in)
{
    const Computed c{in};
    return ratio_of_sums(in, c, c.bounds.quadratic_sum());
}
double cubic_ratio(const Input& in)
{
    const Computed c{in};
    return ratio_of_cubics(in, c, c.bounds.cubic());
}

/// A ratio in single precision; 0 for pairs beyond its range, which are screened in double.
template <class Ratio>
auto in_single(Ratio ratio)
{
    return [=](const Input& in) {
        const ComputedInSingle c{in.x.data(), in.t_max};
        const auto f = portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1));
        return portable::in_lane_range(f, c.extents, c.bounds).value[0] ? ratio(in, c) : 0.0;
    };
}

/// The same of the motion up to in.a, as single precision interpolates it to see what is apart until the earliest contact so far.
template <class Ratio>
auto in_single_until(Ratio ratio)
{
    return in_single([=](const Input& in, ComputedInSingle c) {
        const double to = static_cast<float>(in.a);
        for (int i = 0; i < 3; ++i) c.r.end[i] = portable::position(c.r, i, portable::broadcast<Single>(to));
        return ratio(in, c, to);
    });
}

/// Of differences between components of r1, r2, r3. Over a whole step, where signs are certain and the bound is 0, as multiples of what
/// holds for the rounded values.
double ratio_of_gaps(const Input& in, const ComputedInSingle& c)
{
    const ExactRelativeMotion exact{in.x.data(), in.t_max};
    const double linear = in.t_max == 1.0 ? (2 + 2 + ErrorBounds::slack) * ErrorBounds::single_u : c.bounds.whole.linear;
    const Single extents[] = {c.extents.x, c.extents.y, c.extents.z};
    double worst = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto gap = [&](const portable::Vector3<Single>& a, const portable::Vector3<Single>& b) {
            return Exact(component(portable::subtract(a, b), axis));
        };
        const double bound = linear * std::max(number(extents[axis]), single_length_floor);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const Exact at_start = exact.at(i, 0.0)[axis] - exact.at(j, 0.0)[axis] - gap(c.r.start[i], c.r.start[j]);
            const Exact at_end = exact.at(i, 1.0)[axis] - exact.at(j, 1.0)[axis] - gap(c.r.end[i], c.r.end[j]);
            worst = std::max({worst, at_start.magnitude_in(bound), at_end.magnitude_in(bound)});
        }
    }
    return worst;
}

/// Of multiples of the cubic's coefficients on both halves.
double ratio_of_halved_cubics(const Input& in, const ComputedInSingle& c)
{
    const auto f = portable::halved(portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1)));
    const double bound = c.bounds.halves.cubic * number(c.scale.volume);
    const ExactRelativeMotion exact{in.x.data(), in.t_max};
    const auto first = thrice_cubic(exact, 0.0, 0.5), second = thrice_cubic(exact, 0.5, 1.0);
    const double multiple[] = {1, 6, 12, 8};
    double worst = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Exact three = 3.0, on_first = first[k] * Exact(multiple[k]) - three * Exact(number(f.first[k]));
        const Exact on_second = second[3 - k] * Exact(multiple[k]) - three * Exact(number(f.second[3 - k]));
        worst = std::max({worst, on_first.magnitude_in(3 * bound), on_second.magnitude_in(3 * bound)});
    }
    return worst;
}

/// Of one component of a quadratic on both halves, of which on_first and on_second are twice the exact coefficients.
template <class L>
double ratio_of_halves(const portable::HalvedQuadratic<L>& h, const std::array<ExactVector, 3>& on_first,
                       const std::array<ExactVector, 3>& on_second, std::size_t axis, double bound)
{
    const Exact two = 2.0, middle{number(h.middle)};
    return std::max({(on_first[0][axis] - two * Exact(number(h.start))).magnitude_in(2 * bound),
                     (on_first[1][axis] - Exact(number(h.first))).magnitude_in(bound),
                     (two * on_first[2][axis] - middle).magnitude_in(bound), (two * on_second[0][axis] - middle).magnitude_in(bound),
                     (on_second[1][axis] - Exact(number(h.second))).magnitude_in(bound),
                     (on_second[2][axis] - two * Exact(number(h.end))).magnitude_in(2 * bound)});
}

/// Of the cross products of r1, r2, r3 on both halves, in units of their bound, or of the sum of three in units of its own.
double ratio_of_halved_quadratics(const Input& in, const ComputedInSingle& c, bool sum)
{
    const ExactRelativeMotion exact{in.x.data(), in.t_max};
    const auto halved_along = [](const auto& q, std::size_t axis) {
        const auto of = [&](const auto& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
        return portable::halved(of(q.start), of(q.twice_middle), of(q.end));
    };
    double worst = 0;
    const auto look_at = [&](const auto& computed, auto at_i, auto at_j, double factor) {
        const auto on_first = twice_cross(at_i(0.0), at_j(0.0), at_i(0.5), at_j(0.5));
        const auto on_second = twice_cross(at_i(0.5), at_j(0.5), at_i(1.0), at_j(1.0));
        for (std::size_t axis = 0; axis < 3; ++axis)
            worst = std::max(worst, ratio_of_halves(halved_along(computed, axis), on_first, on_second, axis, factor * area_of(c.scale, axis)));
    };
    if (sum) {
        const auto between = [&](std::size_t to) { return [&exact, to](double s) { return exact.at(to, s) - exact.at(1, s); }; };
        look_at(portable::subtract_then_add(portable::cross_product(c.r, 1, 2), portable::cross_product(c.r, 0, 2),
                                            portable::cross_product(c.r, 0, 1)),
                between(2), between(0), c.bounds.halves.quadratic_sum);
        return worst;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto position_of = [&](std::size_t point) { return [&exact, point](double s) { return exact.at(point, s); }; };
        const std::size_t j = (i + 1) % 3;
        look_at(portable::cross_product(c.r, static_cast<int>(i), static_cast<int>(j)), position_of(i), position_of(j), c.bounds.halves.quadratic);
    }
    return worst;
}

/// On [a, b], as a multiple of the bound from extents or of the one from magnitudes.
double cubic_on_interval_ratio(const Input& in, bool from_magnitudes)
{
    const Computed c{in};
    const auto whole = portable::bernstein(portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1)));
    const auto f = portable::on_interval(whole, in.a, in.b);
    const auto thrice = thrice_cubic({in.x.data(), in.t_max}, in.a, in.b);
    const double from_extents = c.bounds.cubic_on_interval() * c.scale.volume;
    const double bound = from_magnitudes ? portable::cubic_bound(c.r, from_extents, c.bounds) : from_extents;
    const double computed[] = {f.c0, f.c1, f.c2, f.c3};
    double worst = 0;
    for (std::size_t k = 0; k < 4; ++k)
        worst = std::max(worst, (thrice[k] - Exact(3.0) * Exact(computed[k])).magnitude_in(3 * bound));
    return worst;
}

double quadratic_on_interval_ratio(const Input& in, bool from_magnitudes)
{
    const Computed c{in};
    const ExactRelativeMotion exact{in.x.data(), in.t_max};
    double worst = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const auto q = portable::cross_product(c.r, static_cast<int>(i), static_cast<int>(j));
        const auto m = portable::cross_product_magnitude(c.r, static_cast<int>(i), static_cast<int>(j));
        const auto twice = twice_cross(exact.at(i, in.a), exact.at(j, in.a), exact.at(i, in.b), exact.at(j, in.b));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto local = portable::on_interval(
                portable::Quadratic<double>{component(q.start, axis), 0.5 * component(q.twice_middle, axis), component(q.end, axis)},
                in.a, in.b);
            const double from_extents = c.bounds.quadratic_on_interval() * area_of(c.scale, axis);
            const double bound = from_magnitudes
                                     ? portable::quadratic_bound(component(m.start, axis), component(m.twice_middle, axis),
                                                               component(m.end, axis), from_extents, c.bounds)
                                     : from_extents;
            const double computed[] = {local.c0, local.c1, local.c2};
            for (std::size_t k = 0; k < 3; ++k)
                worst = std::max(worst, (twice[k][axis] - Exact(2 * computed[k])).magnitude_in(2 * bound));
        }
    }
    return worst;
}

/// Largest error of a component of r_i at the time s, or of a difference of two, in units of the axis' extent.
double position_error(const Input& in, double s, bool differences)
{
    const Computed c{in};
    const ExactRelativeMotion exact{in.x.data(), in.t_max};
    double worst = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto position = [&](std::size_t point) {
            return s == 0.0 ? c.r.start[point] : s == 1.0 ? c.r.end[point] : portable::position(c.r, static_cast<int>(point), s);
        };
        const std::size_t j = (i + 1) % 3;
        const ExactVector at_i = exact.at(i, s), at_j = exact.at(j, s);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = axis == 0 ? c.extents.x : axis == 1 ? c.extents.y : c.extents.z;
            const double p = component(position(i), axis), q = component(position(j), axis);
            const Exact error = differences ? at_j[axis] - at_i[axis] - Exact(q - p) : at_i[axis] - Exact(p);
            worst = std::max(worst, error.magnitude_in(extent));
        }
    }
    return worst;
}

TEST(ErrorBounds, RelativeVectors)
{
    // One rounding can err by u exactly; everything built on it has slack.
    expect_bound("rho", 0.1, [](const Input& in) {
        return position_error(in, 1.0, false) / (ErrorBounds{in.t_max}.rho * u * (1 + 0x1p-50));
    });
    expect_bound("rho + 3 (interpolated)", 0.1, [](const Input& in) {
        return position_error(in, in.a, false) / ((ErrorBounds{in.t_max}.rho + 3) * u);
    });
}

TEST(ErrorBounds, QuadraticCoefficients)
{
    expect_bound("quadratic", 0.02, cross_product_ratio);
    expect_bound("quadratic_sum", 0.02, cross_product_sum_ratio);
}

TEST(ErrorBounds, CoefficientsInSinglePrecision)
{
    // As lanes meet them, and with axes below what single precision takes for zero.
    for (const Shifts shifts : {ordinary_shifts, Shifts{-80, 38}}) {
        const double least = shifts.smallest < -40 ? 0.0 : 0.02;
        expect_bound("quadratic, single", least, in_single([](const Input& in, const ComputedInSingle& c) {
            return ratio_of_cross_products(in, c, c.bounds.whole.quadratic);
        }), shifts);
        expect_bound("quadratic_sum, single", least, in_single([](const Input& in, const ComputedInSingle& c) {
            return ratio_of_sums(in, c, c.bounds.whole.quadratic_sum);
        }), shifts);
        expect_bound("cubic, single", least, in_single([](const Input& in, const ComputedInSingle& c) {
            return ratio_of_cubics(in, c, c.bounds.whole.cubic);
        }), shifts);
        expect_bound("gap, single", least, in_single(ratio_of_gaps), shifts);
        expect_bound("quadratic on part, single", least, in_single_until([](const Input& in, const ComputedInSingle& c, double to) {
            return ratio_of_cross_products(in, c, c.bounds.part.quadratic, to);
        }), shifts);
        expect_bound("quadratic_sum on part, single", least, in_single_until([](const Input& in, const ComputedInSingle& c, double to) {
            return ratio_of_sums(in, c, c.bounds.part.quadratic_sum, to);
        }), shifts);
        expect_bound("cubic on part, single", least, in_single_until([](const Input& in, const ComputedInSingle& c, double to) {
            return ratio_of_cubics(in, c, c.bounds.part.cubic, to);
        }), shifts);
        expect_bound("cubic on halves, single", least, in_single(ratio_of_halved_cubics), shifts);
        expect_bound("quadratic on halves, single", least, in_single([](const Input& in, const ComputedInSingle& c) {
            return ratio_of_halved_quadratics(in, c, false);
        }), shifts);
        expect_bound("quadratic_sum on halves, single", least, in_single([](const Input& in, const ComputedInSingle& c) {
            return ratio_of_halved_quadratics(in, c, true);
        }), shifts);
    }
}

TEST(ErrorBounds, CubicCoefficients) { expect_bound("cubic", 0.02, cubic_ratio); }

TEST(ErrorBounds, CoefficientsOnIntervals)
{
    expect_bound("cubic_on_interval", 0.02, [](const Input& in) { return cubic_on_interval_ratio(in, false); });
    expect_bound("cubic_bound (magnitudes)", 0.02, [](const Input& in) { return cubic_on_interval_ratio(in, true); });
    expect_bound("quadratic_on_interval", 0.02, [](const Input& in) { return quadratic_on_interval_ratio(in, false); });
    expect_bound("quadratic_bound (magnitudes)", 0.02, [](const Input& in) { return quadratic_on_interval_ratio(in, true); });
}

TEST(ErrorBounds, AxisGaps)
{
    expect_bound("linear_on_interval", 0.02, [](const Input& in) {
        return position_error(in, in.a, true) / ErrorBounds{in.t_max}.linear_on_interval();
    });
    // Over the whole step nothing but the sign counts (below); to a shorter end there is a bound.
    Adversary adversary{5};
    double worst = 0;
    for (const double t_max : {0.7, 1.0 - 0x1p-53, 1e-6, 0x1.8p-60}) {
        const auto [input, found] = adversary.worst(
            6, 300, [&] { return adversary.input(t_max, -12, 12); }, [&](const Input& in) { return adversary.changed(in); },
            [](const Input& in) { return position_error(in, 1.0, true) / ErrorBounds{in.t_max}.linear(); });
        EXPECT_LT(found, 1.0) << text(input);
        worst = std::max(worst, found);
    }
    std::printf("%-34s worst error / bound: %.4f (shorter)\n", "linear", worst);
    EXPECT_GT(worst, 0.02);
}

// With t_max = 1 the bound is 0: a positive computed gap is a proof. Coordinates a few ulps apart, or equal, relative
// to others far away, so that differences to x0 round.
TEST(ErrorBounds, WholeStepGapsHaveTheExactSign)
{
    EXPECT_EQ(ErrorBounds{1.0}.linear(), 0.0);
    Adversary adversary{6};
    std::size_t positive = 0, lost = 0;
    for (int i = 0; i < 200000; ++i) {
        const double origin = adversary.coordinate() * std::ldexp(1.0, adversary.integer(-3, 8));
        const double p = adversary.coordinate();
        const double q = p + adversary.integer(-4, 4) * std::ldexp(1.0, -adversary.integer(40, 54));
        const double gap = (q - origin) - (p - origin);
        if (gap > 0.0) {
            ++positive;
            ASSERT_GT(q, p) << origin;
        }
        lost += gap == 0.0 && q != p;
    }
    EXPECT_GT(positive, 10000u);
    EXPECT_GT(lost, 1000u) << "no difference was rounded away: nothing was tested";
}

/// A parameter s that is a lower bound stays one as a time s t_max, and loses three roundings at most.
TEST(ErrorBounds, TimesAreRoundedDown)
{
    Adversary adversary{7};
    std::size_t products_rounded_up = 0;
    for (int i = 0; i < 100000; ++i) {
        const double t_max = adversary.chance(0.5) ? adversary.uniform(0, 1) : std::ldexp(adversary.uniform(0.5, 1), -adversary.integer(0, 60));
        const double s = adversary.time();
        const Exact exact = Exact(s) * Exact(t_max), time = SearchParameters{1e-9, t_max, false}.time(s);
        ASSERT_FALSE(exact < time) << s << ' ' << t_max;
        ASSERT_FALSE(time < exact * Exact(1 - 0x1p-50)) << s << ' ' << t_max;
        products_rounded_up += exact < Exact(s * t_max);
    }
    EXPECT_GT(products_rounded_up, 1000u);
}

/// Products of tiny components underflow; the floors of the lanes' scales and the share that the certified search
/// keeps of the bound from extents must cover it.
TEST(ErrorBounds, Underflow)
{
    const auto below_the_lanes_scales = [](auto ratio) {
        return [ratio](const Input& in) {
            const double worst = ratio(in);
            return std::isnan(worst) ? 2.0 : worst;
        };
    };
    constexpr Shifts lanes{-420, 20};
    expect_bound("quadratic, tiny", 0.02, below_the_lanes_scales(cross_product_ratio), lanes);
    expect_bound("quadratic_sum, tiny", 0.02, below_the_lanes_scales(cross_product_sum_ratio), lanes);
    expect_bound("cubic, tiny", 0.02, below_the_lanes_scales(cubic_ratio), lanes);
    constexpr Shifts vanishing{-420, -360};
    expect_bound("cubic, volume underflows", 0.0, below_the_lanes_scales(cubic_ratio), vanishing);
    constexpr Shifts vanishing_areas{-560, -500};
    expect_bound("quadratic, areas underflow", 0.0, below_the_lanes_scales(cross_product_ratio), vanishing_areas);
    expect_bound("quadratic_sum, areas underflow", 0.0, below_the_lanes_scales(cross_product_sum_ratio), vanishing_areas);

    // In the certified search extents are at least 2^-100, but components may be anything below.
    const auto with_tiny_components = [](auto ratio) {
        return [ratio](Input in) {
            for (std::size_t c = 0; c < 24; ++c)
                if (c % 12 / 3 != 3 && c % 3 == 1) in.x[c] = std::ldexp(in.x[c], -900);
            for (std::size_t c = 0; c < 24; ++c)
                if (c % 12 / 3 != 3 && c % 3 == 2) in.x[c] = std::ldexp(in.x[c], -160);
            for (std::size_t point : {0u, 1u, 2u, 4u, 5u, 6u}) in.x[3 * point] = std::ldexp(in.x[3 * point], -20);
            return ratio(in, true);
        };
    };
    constexpr Shifts search{-99, -60};
    expect_bound("cubic_bound, tiny components", 0.0, with_tiny_components(cubic_on_interval_ratio), search);
    expect_bound("quadratic_bound, tiny components", 0.0, with_tiny_components(quadratic_on_interval_ratio), search);
}

}  // namespace
}  // namespace fastccd::testing
