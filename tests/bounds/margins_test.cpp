// The margins by which lanes decide: what they conclude with a margin, the certified search concludes too, with its
// own rounding and its own bounds, on every part of the interval.
//
// Each margin is measured as the largest value that lanes can see where the search does not certify: the lanes' value
// minus the search's smallest coefficient, plus the search's bound. Adding a constant to the polynomial changes
// neither, so this needs no hunt for polynomials that nearly vanish.
#include <bernstein.hpp>
#include <halves_certificate.hpp>
#include <magnitudes.hpp>
#include <meeting.hpp>
#include <projected_inclusion.hpp>

#include "measured_bound.hpp"

namespace fastccd::testing {
namespace {

using portable::Cubic;
using portable::Quadratic;
using portable::QuadraticVector;

constexpr int effort = 20;  // no exact arithmetic here, so there is time for more

/// A part of [low, high], its ends among them.
struct Part {
    double a, b;
};
Part part_of(double low, double high, const Input& in)
{
    const double a = low + in.a * (high - low), b = low + in.b * (high - low);
    return {std::clamp(a, low, high), std::clamp(b, low, high)};
}

Cubic<double> cubic_of(const Computed& c)
{
    return portable::bernstein(portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1)));
}

/// The search's bound is at most the one from extents, which stands for it.
double search_bound(const Computed& c) { return c.bounds.cubic_on_interval() * c.scale.volume; }

/// How far a coefficient that the search computes on `leaf` may lie beyond those that lanes see on `lanes`, around it.
double cubic_margin(const Cubic<double>& whole, const Part& lanes, const Part& leaf)
{
    const Cubic<double> seen = portable::on_interval(whole, lanes.a, lanes.b);
    const Cubic<double> local = portable::on_interval(whole, leaf.a, leaf.b);
    return std::max(portable::smallest(seen) - portable::smallest(local), portable::largest(local) - portable::largest(seen));
}

TEST(Margins, CubicOnIntervals)
{
    // Lanes look at [0, b] or [b, 1], the search at a part of it.
    const auto part = [](const Input& in) { return in.a < 0.5 ? Part{0.0, in.b} : Part{in.b, 1.0}; };
    expect_bound("cubic_on_interval_lanes", 0.1, [&](const Input& in) {
        const Computed c{in};
        const Part lanes = part(in);
        const double margin = cubic_margin(cubic_of(c), lanes, part_of(lanes.a, lanes.b, in));
        return (margin + search_bound(c)) / (c.bounds.cubic_on_interval_lanes() * c.scale.volume);
    }, ordinary_shifts, effort);
    expect_bound("cubic_bound_lanes", 0.1, [&](const Input& in) {
        const Computed c{in};
        const Part lanes = part(in);
        const double margin = cubic_margin(cubic_of(c), lanes, part_of(lanes.a, lanes.b, in));
        return (margin + portable::cubic_bound(c.r, search_bound(c), c.bounds)) / portable::cubic_bound_lanes(c.r, c.scale.volume, c.bounds);
    }, ordinary_shifts, effort);
}

using portable::largest;
using portable::smallest;
double smallest(const portable::Linear<double>& f) { return std::min(f.c0, f.c1); }
double largest(const portable::Linear<double>& f) { return std::max(f.c0, f.c1); }

/// A value in the middle of an interval against the coefficients there, as a multiple of the margin.
template <class Polynomial>
double value_ratio(const Polynomial& whole, const Input& in)
{
    const double a = std::min(in.a, in.b), b = std::max(in.a, in.b), s = std::clamp(0.5 * (a + b), a, b);
    const Polynomial local = portable::on_interval(whole, a, b);
    const double value = portable::on_interval(whole, s, s).c0;
    return std::max(smallest(local) - value, value - largest(local)) / portable::value_margin(whole);
}

TEST(Margins, ValuesWithinIntervals)
{
    expect_bound("value_margin, cubic", 0.02, [](const Input& in) { return value_ratio(cubic_of(Computed{in}), in); }, ordinary_shifts, effort);
    expect_bound("value_margin, quadratic", 0.02, [](const Input& in) {
        const auto q = portable::cross_product(Computed{in}.r, 0, 1);
        return value_ratio(Quadratic<double>{q.start.x, 0.5 * q.twice_middle.x, q.end.x}, in);
    }, ordinary_shifts, effort);
    expect_bound("value_margin, gaps", 0.02, [](const Input& in) {
        const Computed c{in};
        return value_ratio(portable::Linear<double>{c.r.start[1].x - c.r.start[0].x, c.r.end[1].x - c.r.end[0].x}, in);
    }, ordinary_shifts, effort);
}

/// One component of a cross product on [a, b] as the search computes it.
Quadratic<double> component_on(const QuadraticVector<double>& v, std::size_t axis, Part i)
{
    return portable::on_interval(
        Quadratic<double>{component(v.start, axis), 0.5 * component(v.twice_middle, axis), component(v.end, axis)}, i.a, i.b);
}

/// Lanes: a component of a cross product at `centre`, from interpolated vectors. Search: coefficients on a part of
/// [centre - delta, centre + delta]. Measured against `bound`, after taking off the change within delta.
double edge_margin(double lanes, const Quadratic<double>& search, double change, double search_bound, double bound)
{
    const double margin = std::max(lanes - portable::smallest(search), portable::largest(search) - lanes);
    return (margin - change + search_bound) / bound;
}

struct Neighbourhood {
    double centre, delta;
    Part leaf;
    double change;  ///< As in projected_inclusion.

    explicit Neighbourhood(const Input& in)
    {
        centre = in.a;
        // Wide ones are where the change decides, narrow ones where rounding does.
        delta = std::min(0.5, in.b - in.a);
        const double low = std::max(0.0, centre - delta), high = std::min(1.0, centre + delta);
        leaf = part_of(low, high, in);
        change = 8.0 * (delta + delta * delta);
    }
};

double edge_function_ratio(const Input& in)
{
    const Computed c{in};
    const Neighbourhood n{in};
    double worst = -1;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const auto at = portable::cross(portable::position(c.r, i, n.centre), portable::position(c.r, j, n.centre));
        const auto q = portable::cross_product(c.r, i, j);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double area = area_of(c.scale, axis);
            worst = std::max(worst, edge_margin(component(at, axis), component_on(q, axis, n.leaf), n.change * area,
                                                c.bounds.quadratic_on_interval() * area, c.bounds.edge_function() * area));
        }
    }
    return worst;
}

/// The fourth edge function of an edge-edge pair: a sum of three in the lanes, one of vectors from x1 in the search.
double edge_function_sum_ratio(const Input& in)
{
    const Computed c{in};
    Input from_x1 = in;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::swap(from_x1.x[axis], from_x1.x[3 + axis]);
        std::swap(from_x1.x[12 + axis], from_x1.x[15 + axis]);
    }
    const Computed d{from_x1};
    const Neighbourhood n{in};
    const auto r1 = portable::position(c.r, 0, n.centre), r2 = portable::position(c.r, 1, n.centre),
               r3 = portable::position(c.r, 2, n.centre);
    const auto sum = portable::add(portable::subtract(portable::cross(r2, r3), portable::cross(r1, r3)), portable::cross(r1, r2));
    const auto q = portable::cross_product(d.r, 1, 2);
    double worst = -1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double area = area_of(c.scale, axis);
        worst = std::max(worst, edge_margin(component(sum, axis), component_on(q, axis, n.leaf), 3 * n.change * area,
                                            d.bounds.quadratic_on_interval() * area_of(d.scale, axis),
                                            c.bounds.edge_function_sum() * area));
    }
    return worst;
}

TEST(Margins, EdgeFunctionsNearATime)
{
    expect_bound("edge_function", 0.1, edge_function_ratio, ordinary_shifts, effort);
    expect_bound("edge_function_sum", 0.1, edge_function_sum_ratio, ordinary_shifts, effort);
}

/// The change of an edge function within delta alone: without it, narrow neighbourhoods would hide a wrong factor.
TEST(Margins, ChangeOfEdgeFunctions)
{
    Adversary adversary{9};
    const auto [input, found] = adversary.worst(
        30, 400, [&] { return adversary.input(1.0, 0, 0); }, [&](const Input& in) { return adversary.changed(in); },
        [](const Input& in) {
            const Computed c{in};
            const Neighbourhood n{in};
            if (n.delta < 0x1p-20) return -1.0;
            double worst = 0;
            const auto at = portable::cross(portable::position(c.r, 0, n.centre), portable::position(c.r, 1, n.centre));
            const auto q = portable::cross_product(c.r, 0, 1);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Quadratic<double> local = component_on(q, axis, n.leaf);
                const double value = component(at, axis);
                worst = std::max(worst, std::max(value - portable::smallest(local), portable::largest(local) - value) /
                                            ((n.change + c.bounds.edge_function()) * area_of(c.scale, axis)));
            }
            return worst;
        });
    std::printf("%-34s worst change / bound: %.4f\n", "8 (delta + delta^2)", found);
    EXPECT_LT(found, 1.0) << text(input);
    EXPECT_GT(found, 0.3);
}

/// Certificates on a part from a motion with interpolated ends (earliest contact, quarters), against the search on parts of it.
Part lanes_part(const Input& in) { return in.a < 0.5 ? Part{0.0, in.b} : Part{std::min(in.a, in.b), std::max(in.a, in.b)}; }

portable::RelativeMotion<double> motion_on(const portable::RelativeMotion<double>& r, Part i)
{
    return {{portable::position(r, 0, i.a), portable::position(r, 1, i.a), portable::position(r, 2, i.a)},
            {portable::position(r, 0, i.b), portable::position(r, 1, i.b), portable::position(r, 2, i.b)}};
}

/// Lanes compare f0, 3 f1, 3 f2, f3 with one bound; only a third of it is certain of f1 and f2.
TEST(Margins, CubicOnPart)
{
    expect_bound("on_part().cubic", 0.1, [](const Input& in) {
        const Computed c{in};
        const Part part = lanes_part(in);
        const auto motion = motion_on(c.r, part);
        const auto seen = portable::bernstein(portable::coplanarity_cubic(motion, portable::cross_product(motion, 0, 1)));
        const Part leaf = part_of(part.a, part.b, in);
        const Cubic<double> local = portable::on_interval(cubic_of(c), leaf.a, leaf.b);
        const double margin = std::max(portable::smallest(seen) - portable::smallest(local),
                                       portable::largest(local) - portable::largest(seen));
        return 3 * (margin + search_bound(c)) / (c.bounds.on_part().cubic * c.scale.volume);
    }, ordinary_shifts, effort);
}

/// What lanes see of edge functions, `seen(start, twice_middle, end)` of those of r, against the search on `leaf`: r1 x r2, or (`sum`) the
/// fourth of an edge-edge pair, which the search has from vectors to x1. `multiple`: of a coefficient, in what is compared with `bound`.
template <class Seen>
double edge_function_margin(const Input& in, bool sum, const Computed& c, const portable::RelativeMotion<double>& r, const Part& leaf,
                            Seen seen, double multiple, double bound)
{
    Input origin = in;
    for (std::size_t axis = 0; sum && axis < 3; ++axis) {
        std::swap(origin.x[axis], origin.x[3 + axis]);
        std::swap(origin.x[12 + axis], origin.x[15 + axis]);
    }
    const Computed d{origin};
    const auto lanes = sum ? portable::subtract_then_add(portable::cross_product(r, 1, 2), portable::cross_product(r, 0, 2),
                                                         portable::cross_product(r, 0, 1))
                           : portable::cross_product(r, 0, 1);
    const auto search = sum ? portable::cross_product(d.r, 1, 2) : portable::cross_product(c.r, 0, 1);
    double worst = -1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Quadratic<double> in_lanes =
            seen(component(lanes.start, axis), component(lanes.twice_middle, axis), component(lanes.end, axis));
        const Quadratic<double> local = component_on(search, axis, leaf);
        const double margin = std::max(portable::smallest(in_lanes) - portable::smallest(local),
                                       portable::largest(local) - portable::largest(in_lanes));
        const double search_bound = d.bounds.quadratic_on_interval() * area_of(d.scale, axis);
        worst = std::max(worst, multiple * (margin + search_bound) / (bound * area_of(c.scale, axis)));
    }
    return worst;
}

TEST(Margins, EdgeFunctionsOnPart)
{
    const auto ratio = [](const Input& in, bool sum) {
        const Computed c{in};
        const CertificateBounds bounds = c.bounds.on_part();
        const Part part = lanes_part(in);
        return edge_function_margin(in, sum, c, motion_on(c.r, part), part_of(part.a, part.b, in), [](double start, double twice_middle, double end) {
            return Quadratic<double>{start, 0.5 * twice_middle, end};
        }, 2, sum ? bounds.quadratic_sum : bounds.quadratic);
    };
    expect_bound("on_part().quadratic", 0.1, [&](const Input& in) { return ratio(in, false); }, ordinary_shifts, effort);
    expect_bound("on_part().quadratic_sum", 0.1, [&](const Input& in) { return ratio(in, true); }, ordinary_shifts, effort);
}

/// A gap between x1 and x0 along each axis: lanes at the ends of a part, the search at those of an interval inside.
TEST(Margins, GapsOnPart)
{
    expect_bound("on_part().linear", 0.1, [](const Input& in) {
        const Computed c{in};
        const Part part = lanes_part(in), leaf = part_of(part.a, part.b, in);
        double worst = -1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto gap = [&](double s) { return component(portable::position(c.r, 0, s), axis); };
            const double extent = axis == 0 ? c.extents.x : axis == 1 ? c.extents.y : c.extents.z;
            const double margin = std::max(std::min(gap(part.a), gap(part.b)) - std::min(gap(leaf.a), gap(leaf.b)),
                                           std::max(gap(leaf.a), gap(leaf.b)) - std::max(gap(part.a), gap(part.b)));
            worst = std::max(worst, (margin + c.bounds.linear_on_interval() * extent) / (c.bounds.on_part().linear * extent));
        }
        return worst;
    }, ordinary_shifts, effort);
}

/// Certificates on both halves, against the search on parts of one of them. Lanes compare multiples of coefficients with
/// one bound; only a twelfth of it (edge functions: a fourth) is certain of each coefficient.
struct Half {
    bool second;
    Part leaf;

    explicit Half(const Input& in) : second{in.a >= 0.5}, leaf{second ? part_of(0.5, 1.0, in) : part_of(0.0, 0.5, in)} {}
};

TEST(Margins, HalvedCubic)
{
    expect_bound("halves().cubic", 0.1, [](const Input& in) {
        const Computed c{in};
        const Half half{in};
        const auto f = portable::halved(portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1)));
        const Cubic<double> seen = half.second ? Cubic<double>{f.second[0] / 8, f.second[1] / 12, f.second[2] / 6, f.second[3]}
                                               : Cubic<double>{f.first[0], f.first[1] / 6, f.first[2] / 12, f.first[3] / 8};
        const Cubic<double> local = portable::on_interval(cubic_of(c), half.leaf.a, half.leaf.b);
        const double margin = std::max(portable::smallest(seen) - portable::smallest(local),
                                       portable::largest(local) - portable::largest(seen));
        return 12 * (margin + search_bound(c)) / (c.bounds.halves().cubic * c.scale.volume);
    }, ordinary_shifts, effort);
}

TEST(Margins, HalvedEdgeFunctions)
{
    const auto ratio = [](const Input& in, bool sum) {
        const Computed c{in};
        const Half half{in};
        const CertificateBounds halves = c.bounds.halves();
        return edge_function_margin(in, sum, c, c.r, half.leaf, [&](double start, double twice_middle, double end) {
            const auto f = portable::halved(start, twice_middle, end);
            return half.second ? Quadratic<double>{f.middle / 4, f.second / 2, f.end}
                               : Quadratic<double>{f.start, f.first / 2, f.middle / 4};
        }, 4, sum ? halves.quadratic_sum : halves.quadratic);
    };
    expect_bound("halves().quadratic", 0.1, [&](const Input& in) { return ratio(in, false); }, ordinary_shifts, effort);
    expect_bound("halves().quadratic_sum", 0.1, [&](const Input& in) { return ratio(in, true); }, ordinary_shifts, effort);
}

}  // namespace
}  // namespace fastccd::testing
