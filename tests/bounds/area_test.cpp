// The area inclusion test (area_inclusion.hpp; paper, eq. 6, 7 and Lemma 4.1) against digits to spare: its rounding
// error, and the lemma's bound on how much areas change, neither ever refuting a contact.
#include "exact_number.hpp"
#include "measured_bound.hpp"

namespace fastccd::portable {

/// A double that lets us see both sides of the last comparison of the kernel that it runs through.
struct Watched {
    double value;
    static inline double left, right;

    friend Watched operator+(Watched a, Watched b) { return {a.value + b.value}; }
    friend Watched operator-(Watched a, Watched b) { return {a.value - b.value}; }
    friend Watched operator*(Watched a, Watched b) { return {a.value * b.value}; }
};

template <>
struct Lane<Watched> {
    using One = Lane<double>;
    using Mask = BoolMask;
    static Watched broadcast(double x) { return {x}; }
    static Watched min(Watched a, Watched b) { return {One::min(a.value, b.value)}; }
    static Watched max(Watched a, Watched b) { return {One::max(a.value, b.value)}; }
    static Watched abs(Watched a) { return {One::abs(a.value)}; }
    static Watched sqrt(Watched a) { return {One::sqrt(a.value)}; }
    static Mask less(Watched a, Watched b)
    {
        Watched::left = a.value;
        Watched::right = b.value;
        return One::less(a.value, b.value);
    }
};

}  // namespace fastccd::portable

#include <area_inclusion.hpp>

namespace fastccd::testing {
namespace {

using portable::Watched;

/// The comparison allowed < excess of the area certificate.
struct AreaComparison {
    double allowed, excess;
};

template <PairKind kind>
AreaComparison area_comparison(const Input& in, double centre, double delta)
{
    const Computed c{in};
    const auto watched = [](const portable::Vector3<double>& v) { return portable::Vector3<Watched>{{v.x}, {v.y}, {v.z}}; };
    const portable::RelativeMotion<Watched> r{{watched(c.r.start[0]), watched(c.r.start[1]), watched(c.r.start[2])},
                                              {watched(c.r.end[0]), watched(c.r.end[1]), watched(c.r.end[2])}};
    const portable::Scales<Watched> scale{{c.scale.yz}, {c.scale.zx}, {c.scale.xy}, {c.scale.volume}};
    portable::area_certificate<kind, Watched>(r, scale, {centre}, {delta}, c.bounds);
    return {Watched::left, Watched::right};
}

mpf_class wide_norm(const ExactVector& v) { return mpf_class(sqrt(dot(v, v).wide())); }

/// The sum of doubled areas with signs, in digits to spare.
template <PairKind kind>
mpf_class wide_excess(const Input& in, double centre)
{
    const ExactRelativeMotion r{in.x.data(), in.t_max};
    const ExactVector r1 = r.at(0, centre), r2 = r.at(1, centre), r3 = r.at(2, centre);
    const mpf_class p = wide_norm(cross(r1, r2)), q = wide_norm(cross(r2, r3)), t = wide_norm(cross(r3, r1)),
                    whole = wide_norm(cross(r2 - r1, r3 - r1));
    if constexpr (kind == PairKind::vertex_face) return mpf_class(p + q + t - whole, 1024);
    return mpf_class(abs(mpf_class(p + t - q - whole, 1024)));
}

/// The constants of eq. 6 against any edge at any time, and any difference of velocities: each in units of its bound.
double motion_ratio(const Input& in)
{
    const Computed c{in};
    const auto bounds = portable::motion_bounds<double>(c.r);
    const ExactRelativeMotion r{in.x.data(), in.t_max};
    double worst = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = i; k < 3; ++k) {
            const auto difference = [&](double s) { return i == k ? r.at(i, s) : r.at(k, s) - r.at(i, s); };
            for (const double s : {0.0, in.a, in.b, 1.0}) worst = std::max(worst, wide_norm(difference(s)).get_d() / bounds.edge);
            worst = std::max(worst, wide_norm(difference(1.0) - difference(0.0)).get_d() / bounds.speed);
        }
    return worst;
}

TEST(AreaInclusion, MotionBounds)
{
    Adversary adversary{16};
    const auto [worst, found] = adversary.worst(
        20, 100, [&] { return adversary.input(1.0, -3, 3); }, [&](const Input& in) { return adversary.changed(in); }, motion_ratio);
    EXPECT_LE(found, 1.0 + 0x1p-40) << text(worst);
    EXPECT_GT(found, 1.0 - 0x1p-40);
}

template <PairKind kind>
double rounding_ratio(const Input& in)
{
    const AreaComparison computed = area_comparison<kind>(in, in.a, 0.0);
    const mpf_class error(abs(mpf_class(wide_excess<kind>(in, in.a) - mpf_class(computed.excess, 1024), 1024)));
    return error.get_d() / computed.allowed;
}

TEST(AreaInclusion, Rounding)
{
    // Most of the constant is for the velocities, below.
    expect_bound("area, vertex-face", 0.005, rounding_ratio<PairKind::vertex_face>);
    expect_bound("area, edge-edge", 0.005, rounding_ratio<PairKind::edge_edge>);
}

/// A motion in contact at time `a`: coordinates 0 .. 11 are the points then, 12 .. 23 their velocities, but for the
/// vertex or the last point, which `weights` place on the face, or on a line through the first edge.
template <PairKind kind>
Input in_contact(const Input& in, double weight_1, double weight_2)
{
    std::array<double, 12> at{};
    std::copy_n(in.x.begin(), 12, at.begin());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double* const x[] = {&at[axis], &at[3 + axis], &at[6 + axis], &at[9 + axis]};
        if constexpr (kind == PairKind::vertex_face) {
            *x[0] = *x[1] + weight_1 * (*x[2] - *x[1]) + (1 - weight_1) * weight_2 * (*x[3] - *x[1]);
        } else {
            const double met = *x[0] + weight_1 * (*x[1] - *x[0]);
            *x[3] = *x[2] + (met - *x[2]) / (0.1 + 0.9 * weight_2);
        }
    }
    Input result = in;
    for (std::size_t c = 0; c < 12; ++c) {
        result.x[c] = at[c] - in.a * in.x[12 + c];
        result.x[12 + c] = at[c] + (1 - in.a) * in.x[12 + c];
    }
    return result;
}

/// Contact at a, looked for at b: the excess at b, in units of what is allowed within |b - a|.
template <PairKind kind>
double change_ratio(const Input& in, double weight_1, double weight_2)
{
    const double delta = std::fabs(in.b - in.a) * (1 + 0x1p-52);
    if (delta < 0x1p-20) return -1.0;  // the contact itself is rounded here
    const AreaComparison found = area_comparison<kind>(in_contact<kind>(in, weight_1, weight_2), in.b, delta);
    return found.excess / found.allowed;
}

template <PairKind kind>
void expect_lemma(const char* name)
{
    Adversary adversary{15};
    struct Meeting {
        Input in;
        double weight_1, weight_2;
    };
    const auto [worst, found] = adversary.worst(
        40, 600, [&] { return Meeting{adversary.input(1.0, -3, 3), adversary.time(), adversary.time()}; },
        [&](const Meeting& m) {
            return adversary.chance(0.9) ? Meeting{adversary.changed(m.in), m.weight_1, m.weight_2}
                                         : Meeting{m.in, adversary.time(), adversary.time()};
        },
        [](const Meeting& m) { return change_ratio<kind>(m.in, m.weight_1, m.weight_2); });
    std::printf("%-34s worst excess / allowed: %.4f\n", name, found);
    EXPECT_LT(found, 1.0) << text(in_contact<kind>(worst.in, worst.weight_1, worst.weight_2));
    EXPECT_GT(found, 0.1);
}

TEST(AreaInclusion, ContactWithinDeltaIsNeverRefuted)
{
    expect_lemma<PairKind::vertex_face>("Lemma 4.1, vertex-face");
    expect_lemma<PairKind::edge_edge>("Lemma 4.1, edge-edge");
}

/// Two points that meet exactly at t = 0, and a motion of a few ulps: what the computed velocities miss of it,
/// which may be all, is in bounds.area().
template <PairKind kind>
double standing_ratio(Input in)
{
    for (std::size_t axis = 0; axis < 3; ++axis) in.x[axis] = in.x[(kind == PairKind::vertex_face ? 3 : 6) + axis];
    for (std::size_t c = 0; c < 12; ++c) {
        const double from = in.x[c], ulps = std::fabs(std::fmod(in.x[12 + c] * 0x1p20, 4.0));
        in.x[12 + c] = from * (1 + (in.x[12 + c] < 0 ? -1 : 1) * std::floor(ulps) * 0x1p-52);
    }
    const AreaComparison found = area_comparison<kind>(in, in.b, in.b);
    return found.excess / found.allowed;
}

TEST(AreaInclusion, StandingContactIsNeverRefuted)
{
    expect_bound("area, standing vertex-face", 0.005, standing_ratio<PairKind::vertex_face>);
    expect_bound("area, standing edge-edge", 0.005, standing_ratio<PairKind::edge_edge>);
}

}  // namespace
}  // namespace fastccd::testing
