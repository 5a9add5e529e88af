// The certificates of a distance above d that are those of contact with room for d (farther_certificates.hpp): their bounds in either
// precision, what they conclude, and that single precision concludes nothing that double does not, all against exact arithmetic.
#include <algorithm>
#include <cmath>

#include <farther_certificates.hpp>
#include <separation_certificate.hpp>

#include "../amount.hpp"
#include "../oracle/exact_separation.hpp"
#include "exact_number.hpp"
#include "measured_bound.hpp"

namespace fastccd::testing {
namespace {

constexpr double root_of_three = 1.7320508075688772;
const SeparationParameters any_distance{1.0};

FartherBounds bounds_of(const Computed& c) { return SeparationBounds{c.bounds.rho}.certificates(any_distance); }
FartherBounds bounds_of(const ComputedInSingle& /*c*/) { return SeparationBounds{1.0}.certificates_in_single(any_distance); }

template <class L>
double largest_area_of(const portable::Scales<L>& scale)
{
    return number(portable::largest_area(scale));
}

/// Ratio(in, c) with the kernels' view in double, or in single precision where it is in range.
template <class Ratio>
void expect_bound_in_both(const std::string& name, double least, Ratio ratio)
{
    expect_bound(name.c_str(), least, [&](const Input& in) { return ratio(in, Computed{in}); });
    expect_bound((name + ", single").c_str(), least, [&](const Input& in) {
        const ComputedInSingle c{in.x.data(), in.t_max};
        const auto f = portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1));
        return portable::in_lane_range(f, c.extents, bounds_of(c)).value[0] ? ratio(in, c) : 0.0;
    });
}

TEST(FartherCertificates, CubicsOnHalves)
{
    expect_bound_in_both("12 f on halves", 0.01, [](const Input& in, const auto& c) {
        const auto f = portable::evened(portable::halved(portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1))));
        const ExactRelativeMotion motion{in.x.data(), in.t_max};
        const auto first = thrice_cubic(motion, 0.0, 0.5), second = thrice_cubic(motion, 0.5, 1.0);
        const double bound = bounds_of(c).halves.cubic * number(c.scale.volume);
        double worst = 0;
        for (std::size_t k = 0; k < 4; ++k)
            worst = std::max({worst, (Exact(4.0) * first[k] - Exact(number(f.first[k]))).magnitude_in(bound),
                              (Exact(4.0) * second[k] - Exact(number(f.second[k]))).magnitude_in(bound)});
        return worst;
    });
}

/// Of edge functions r_i x r_j on halves, or of the sum of three of them.
template <class C>
double ratio_of_halves(const Input& in, const C& c, bool of_sum)
{
    const auto p = portable::cross_product(c.r, 0, 1), q = portable::cross_product(c.r, 1, 2), t = portable::cross_product(c.r, 0, 2);
    const auto computed = of_sum ? portable::subtract_then_add(q, t, p) : p;
    const ExactRelativeMotion motion{in.x.data(), in.t_max};
    const auto twice = [&](double a, double b) {
        const auto product = [&](std::size_t i, std::size_t j) { return twice_cross(motion.at(i, a), motion.at(j, a), motion.at(i, b), motion.at(j, b)); };
        auto sum = product(0, 1);
        if (of_sum) {
            const auto exact_q = product(1, 2), exact_t = product(0, 2);
            for (std::size_t k = 0; k < 3; ++k) sum[k] = exact_q[k] - exact_t[k] + sum[k];
        }
        return sum;
    };
    const auto first = twice(0.0, 0.5), second = twice(0.5, 1.0);
    const double factor = of_sum ? bounds_of(c).halves.quadratic_sum : bounds_of(c).halves.quadratic;
    double worst = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto along = [&](const auto& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
        const auto h = portable::evened(portable::halved(along(computed.start), along(computed.twice_middle), along(computed.end)));
        const double bound = factor * area_of(c.scale, axis), values[] = {number(h.start), number(h.first), number(h.middle), number(h.second), number(h.end)};
        const Exact exact[] = {first[0][axis], first[1][axis], first[2][axis], second[1][axis], second[2][axis]};
        for (std::size_t k = 0; k < 5; ++k) worst = std::max(worst, (Exact(2.0) * exact[k] - Exact(values[k])).magnitude_in(bound));
    }
    return worst;
}

TEST(FartherCertificates, EdgeFunctionsOnHalves)
{
    expect_bound_in_both("4 edge functions on halves", 0.01, [](const Input& in, const auto& c) { return ratio_of_halves(in, c, false); });
    expect_bound_in_both("4 sums on halves", 0.01, [](const Input& in, const auto& c) { return ratio_of_halves(in, c, true); });
}

/// Largest error of sqrt(3) times a component, of twice the coefficients of n on [a, b].
template <PairKind kind, class L>
double error_of_normal(const Input& in, const portable::QuadraticVector<L>& n, double a, double b, std::size_t k, double bound)
{
    const ExactRelativeMotion motion{in.x.data(), in.t_max};
    const auto side = [&](std::size_t which, double s) {
        const ExactVector r1 = motion.at(0, s), r2 = motion.at(1, s), r3 = motion.at(2, s);
        if (kind == PairKind::vertex_face) return which == 0 ? r2 - r1 : r3 - r2;
        return which == 0 ? r1 : r2 - r3;
    };
    const ExactVector exact = twice_cross(side(0, a), side(1, a), side(0, b), side(1, b))[k];
    double worst = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double computed = component(k == 0 ? n.start : k == 1 ? n.twice_middle : n.end, axis);
        const Exact twice = k == 1 ? Exact(computed) : Exact(2.0) * Exact(computed);
        worst = std::max(worst, root_of_three * (exact[axis] - twice).magnitude_in(bound));
    }
    return worst;
}

template <PairKind kind>
void expect_bounds_of_normals(const std::string& name)
{
    expect_bound_in_both("n, " + name, 0.01, [](const Input& in, const auto& c) {
        const auto n = portable::normal<kind>(portable::cross_product(c.r, 0, 1), portable::cross_product(c.r, 1, 2),
                                              portable::cross_product(c.r, kind == PairKind::vertex_face ? 2 : 0, kind == PairKind::vertex_face ? 0 : 2));
        double worst = 0;
        for (std::size_t k = 0; k < 3; ++k)
            worst = std::max(worst, error_of_normal<kind>(in, n, 0.0, 1.0, k, 2.0 * bounds_of(c).normal * largest_area_of(c.scale)));
        return worst;
    });
    expect_bound(("n between, " + name).c_str(), 0.01, [](const Input& in) {
        const Computed c{in};
        const auto n = portable::normal_between<kind>(portable::positions(c.r, in.a).r, portable::positions(c.r, in.b).r);
        const double bound = SeparationBounds{c.bounds.rho}.normal_between() * largest_area_of(c.scale);
        // 3 |n_0| and |n_0| + 2 |n_1|
        const double start = error_of_normal<kind>(in, n, in.a, in.b, 0, 2.0 * bound), middle = error_of_normal<kind>(in, n, in.a, in.b, 1, bound);
        return std::max(3.0 * start, start + middle);
    });
    expect_bound(("3 f between, " + name).c_str(), 0.01, [](const Input& in) {
        const Computed c{in};
        const auto a = portable::positions(c.r, in.a), b = portable::positions(c.r, in.b);
        const auto f = portable::coplanarity_cubic(portable::RelativeMotion<double>{{a.r[0], a.r[1], a.r[2]}, {b.r[0], b.r[1], b.r[2]}},
                                                   portable::normal_between<kind>(a.r, b.r));
        const auto exact = thrice_cubic({in.x.data(), in.t_max}, in.a, in.b);
        const double bound = SeparationBounds{c.bounds.rho}.volume_between() * c.scale.volume;
        return std::max({(exact[0] - Exact(3.0 * f.start)).magnitude_in(bound), (exact[1] - Exact(f.thrice_second)).magnitude_in(bound),
                         (exact[2] - Exact(f.thrice_third)).magnitude_in(bound), (exact[3] - Exact(3.0 * f.end)).magnitude_in(bound)});
    });
}

TEST(FartherCertificates, Normals)
{
    expect_bounds_of_normals<PairKind::vertex_face>("vertex-face");
    expect_bounds_of_normals<PairKind::edge_edge>("edge-edge");
}

template <PairKind kind>
double distance_at(const portable::RelativeMotion<double>& r, double s)
{
    const auto at = portable::positions(r, s);
    return std::sqrt(portable::square_distance<kind>(at.r, portable::separation<kind>(at.r)));
}

oracle::Farther exactly(PairKind kind, const Input& in, double d, double a, double b)
{
    oracle::Pair pair;
    for (std::size_t i = 0; i < 24; ++i) pair[i / 3][i % 3] = in.x[i];
    return oracle::farther_throughout(kind == PairKind::vertex_face ? oracle::Kind::vertex_face : oracle::Kind::edge_edge, pair, d, a, b);
}

/// Distances about the smallest that is there, so that certificates hold of some pairs and must not of others.
template <PairKind kind>
void expect_certificates_hold(std::uint64_t seed)
{
    Adversary adversary{seed};
    std::size_t first_half = 0, second_half = 0, between = 0, closer = 0;
    for (std::size_t k = 0; k < amount(25000); ++k) {
        const Input in = adversary.input(1.0, -4, 4);
        const Computed c{in};
        portable::Extents<double> extents = portable::extents(c.r);
        if (!portable::in_separation_range(c.r, extents).value) continue;
        double d = distance_at<kind>(c.r, 0.0);
        for (int i = 1; i <= 16; ++i) d = std::min(d, distance_at<kind>(c.r, i / 16.0));
        d *= adversary.chance(0.5) ? adversary.uniform(0.2, 1.2) : std::ldexp(1.0, -adversary.integer(0, 30));
        if (!(d > 0)) continue;
        const SeparationParameters wanted{d, 1e-6};
        const SeparationBounds bounds{c.bounds.rho};
        const auto on_halves = portable::farther_on_halves<kind>(c.r, bounds.certificates(wanted), extents);
        const auto expect_farther = [&](const char* what, double a, double b, std::size_t& count) {
            const oracle::Farther truth = exactly(kind, in, d, a, b);
            ASSERT_NE(truth, oracle::Farther::closer) << what << ' ' << d << ' ' << text(in);
            if (truth == oracle::Farther::certainly) ++count;
        };
        if (on_halves.first.value) expect_farther("first half", 0.0, 0.5, first_half);
        if (on_halves.second.value) expect_farther("second half", 0.5, 1.0, second_half);
        if (!(on_halves.first & on_halves.second).value && exactly(kind, in, d, 0.0, 1.0) == oracle::Farther::closer) ++closer;
        if (in.a < in.b && portable::farther_between<kind>(portable::positions(c.r, in.a).r, portable::positions(c.r, in.b).r, extents,
                                                           wanted.threshold, bounds).value)
            expect_farther("between", in.a, in.b, between);
        if (::testing::Test::HasFatalFailure()) return;
    }
    std::printf("%s: %zu first halves, %zu second, %zu between two times; of pairs that come closer, %zu without certificate\n",
                kind == PairKind::vertex_face ? "vertex-face" : "edge-edge", first_half, second_half, between, closer);
    EXPECT_GT(first_half, amount(2000));
    EXPECT_GT(second_half, amount(2000));
    EXPECT_GT(between, amount(2000));
    EXPECT_GT(closer, amount(2000));
}

TEST(FartherCertificates, Hold)
{
    expect_certificates_hold<PairKind::vertex_face>(18);
    expect_certificates_hold<PairKind::edge_edge>(19);
}

/// What lanes of single precision dismiss, by the axes and the volume on the whole or on halves, the search dismisses.
template <PairKind kind>
void expect_double_to_conclude(std::uint64_t seed)
{
    Adversary adversary{seed};
    std::size_t by_axis = 0, by_volume = 0, by_halves = 0;
    for (std::size_t k = 0; k < amount(400000); ++k) {
        constexpr double t_maxima[] = {1.0, 0.7, 1e-6};
        const int spread = k % 2 == 0 ? 4 : 40;
        const Input in = adversary.input(t_maxima[k % 3], -spread, spread);
        const ComputedInSingle single{in.x.data(), in.t_max};
        const Computed c{in};
        double d = distance_at<kind>(c.r, adversary.uniform(0, 1));
        if (!(d > 0) || adversary.chance(0.1)) d = std::ldexp(1.0, adversary.integer(-1074, 100));
        if (adversary.chance(0.5)) d *= 1.0 - std::ldexp(1.0, -adversary.integer(1, 53));
        const SeparationBounds bounds{c.bounds.rho};
        const FartherBounds in_single = bounds.certificates_in_single(SeparationParameters{d}), in_double = bounds.certificates(SeparationParameters{d});
        portable::Extents<double> extents;
        const auto found = portable::farther_on_halves<kind>(c.r, in_double, extents);
        const bool concluded = (found.first & found.second).value;
        if (portable::in_separation_range(c.r, extents).value) {
            const auto f = portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1));
            const bool volume = portable::farther_by_volume<kind>(f, portable::scales(extents), in_double).value;
            ASSERT_TRUE(concluded || !volume) << d << ' ' << text(in);
        }
        const auto f = portable::coplanarity_cubic(single.r, portable::cross_product(single.r, 0, 1));
        if (!portable::in_lane_range(f, single.extents, in_single).value[0]) continue;
        ASSERT_TRUE(portable::in_separation_range(c.r, extents).value) << text(in);
        portable::Extents<Single> of_single;
        const bool axis = portable::linear_certificate<kind>(single.r, in_single, of_single).value[0];
        const bool volume = portable::farther_by_volume<kind>(f, single.scale, in_single).value[0];
        const auto both = portable::farther_on_halves<kind>(single.r, in_single, of_single);
        const bool halves = both.first.value[0] && both.second.value[0];
        ASSERT_TRUE(!axis || portable::linear_certificate<kind>(c.r, in_double, extents).value) << d << ' ' << text(in);
        ASSERT_TRUE(concluded || !(axis || volume || halves)) << axis << volume << halves << ' ' << d << ' ' << text(in);
        by_axis += axis, by_volume += volume, by_halves += halves;
    }
    std::printf("%s: %zu by an axis, %zu by volume, %zu on halves\n", kind == PairKind::vertex_face ? "vertex-face" : "edge-edge", by_axis, by_volume, by_halves);
    EXPECT_GT(by_axis, amount(10000));
    EXPECT_GT(by_volume, amount(1000));
    EXPECT_GT(by_halves, amount(10000));
}

TEST(FartherCertificates, DoubleConcludesWhatSingleDoes)
{
    expect_double_to_conclude<PairKind::vertex_face>(28);
    expect_double_to_conclude<PairKind::edge_edge>(29);
}

}  // namespace
}  // namespace fastccd::testing
