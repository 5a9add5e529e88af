// Worst measured ratio of an error to its bound: printed, and held to be below 1.
#pragma once

#include <gtest/gtest.h>

#include <certificates.hpp>

#include "adversary.hpp"
#include "array_lane.hpp"

namespace fastccd::testing {

/// The kernels' view of an input, as the lanes and the certified search see it.
struct Computed {
    portable::RelativeMotion<double> r;
    portable::Extents<double> extents;
    portable::Scales<double> scale;
    ErrorBounds bounds;

    explicit Computed(const Input& in)
        : r{portable::relative_motion<double>(in.x.data(), 1, in.t_max)}, bounds{in.t_max}
    {
        // The extents are the same for both kinds of pairs: largest |component| of r1, r2, r3.
        portable::linear_certificate<PairKind::vertex_face>(r, bounds.certificates(), extents);
        scale = portable::scales(extents);
    }
};

/// Pairs as screening sees them in single precision.
using Single = portable::Array<float, 2>;
using One = portable::Array<double, 1>;

struct ComputedInSingle {
    portable::RelativeMotion<Single> r;
    portable::Extents<Single> extents;
    portable::Scales<Single> scale;
    ScreeningBounds bounds;

    explicit ComputedInSingle(const double* coordinates, double t_max)
        : r{portable::relative_motion_in<Single, One>({portable::InRows<One>{coordinates, 1}, portable::InRows<One>{coordinates, 1}}, t_max)},
          bounds{ErrorBounds{t_max}.screening_in_single()}
    {
        portable::linear_certificate<PairKind::vertex_face>(r, bounds.whole, extents);
        scale = portable::scales(extents);
    }
};

inline double number(double x) { return x; }
inline double number(Single x) { return double{x.value[0]}; }

template <class L>
double component(const portable::Vector3<L>& v, std::size_t axis)
{
    return number(axis == 0 ? v.x : axis == 1 ? v.y : v.z);
}
template <class L>
double area_of(const portable::Scales<L>& s, std::size_t axis)
{
    return number(axis == 0 ? s.yz : axis == 1 ? s.zx : s.xy);
}

/// Exponents of the scales of the three axes; the axes of one input are scaled apart.
struct Shifts {
    int smallest, largest;
};
inline constexpr Shifts ordinary_shifts{-12, 12};

/// Asserts ratio(input) < 1 on whatever the adversary finds, for the whole step and for shorter ones. A worst ratio
/// at or below `least` means that the search was too weak to say anything.
template <class Ratio>
void expect_bound(const char* name, double least, Ratio ratio, Shifts shifts = ordinary_shifts, int effort = 1)
{
    double worst[2] = {-1, -1};
    for (const double t_max : {1.0, 0.7, 1.0 - 0x1p-53, 1e-6, 0x1.8p-60}) {
        Adversary adversary{static_cast<std::uint64_t>(77 + 1e4 * t_max)};
        const auto [input, found] = adversary.worst(
            (t_max == 1.0 ? 12 : 4) * effort, 300, [&] { return adversary.input(t_max, shifts.smallest, shifts.largest); },
            [&](const Input& in) { return adversary.changed(in); }, ratio);
        EXPECT_LT(found, 1.0) << name << " is too small: " << text(input);
        double& group = worst[t_max != 1.0];
        group = std::max(group, found);
    }
    std::printf("%-34s worst error / bound: %.4f (whole step), %.4f (shorter)\n", name, worst[0], worst[1]);
    EXPECT_GT(worst[0], least) << name << ": the search found no error worth the name";
    EXPECT_GT(worst[1], least) << name << ": the search found no error worth the name";
}

}  // namespace fastccd::testing
