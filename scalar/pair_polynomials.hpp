// All polynomials of one pair over the searched interval, and the certificates on parts of it.
#pragma once

#include <fastccd/options.hpp>

#include <interval_stack.hpp>
#include <meeting_along_directions.hpp>
#include <scaling.hpp>
#include <search_coefficients.hpp>
#include <search_parameters.hpp>

namespace fastccd::scalar {

using namespace FASTCCD_KERNEL_NAMESPACE;

template <PairKind kind>
class PairPolynomials {
public:
    /// `coordinates`: 24 finite ones, in the order of PairView.
    PairPolynomials(const double* coordinates, const SearchParameters& parameters)
    {
        const RelativeMotion<double> r = scaled_relative_motion(coordinates, parameters.t_max);
        if constexpr (kind == PairKind::edge_edge)
            apart_throughout_ = find_coefficients<kind>(r, scaled_relative_motion(coordinates, parameters.t_max, 1), parameters.bounds, pair_).value;
        else
            apart_throughout_ = find_coefficients<kind>(r, r, parameters.bounds, pair_).value;
    }

    /// The certificates on [0, 1], as the lanes compute them.
    [[nodiscard]] bool apart() const { return apart_throughout_; }

    /// True if one of the three certificates proves absence on the interval.
    [[nodiscard]] bool apart(Interval i) const { return apart_on<kind>(pair_, i.a, i.b).value; }

    /// Bernstein coefficients of the coplanarity cubic on the interval, each within cubic_bound().
    [[nodiscard]] Cubic<double> coplanarity(Interval i) const { return coplanarity_on(pair_, i.a, i.b); }
    [[nodiscard]] double cubic_bound() const { return pair_.cubic_bound; }

    /// The pair's polynomials over a leaf, with the bounds for its parts (restriction.hpp).
    [[nodiscard]] PairCoefficients in_leaf(Interval leaf) const
    {
        PairCoefficients inside = pair_;
        static_cast<PolynomialsOf<double>&>(inside) = restricted_to<kind>(pair_, leaf.a, leaf.b);
        add_rounding_on_parts<kind>(inside);
        return inside;
    }

    /// True if every coplanar time of the interval is a contact: proper inclusion in some projection.
    [[nodiscard]] bool included(Interval i) const { return included_on<kind>(pair_, Between<double>{i.a, i.b}).value; }

    // See touching.hpp.
    [[nodiscard]] Touch<double> touch(const PairCoefficients& leaf, const ErrorBounds& bounds) const
    {
        return touch_in<kind>(leaf, pair_, bounds, all_lanes<double>());
    }
    [[nodiscard]] bool apart_by_area(Interval i) const { return apart_by_area_on<kind>(pair_, i.a, i.b).value; }
    // See meeting_along_directions.hpp.
    [[nodiscard]] AlongDirections<double> along_directions(double start, const ErrorBounds& bounds) const
    {
        return FASTCCD_KERNEL_NAMESPACE::along_directions<kind>(pair_, start, bounds, all_lanes<double>());
    }
    [[nodiscard]] bool meets_after_directions(double time, double leaf_width) const
    {
        return meeting_after_directions<kind>(pair_, time, leaf_width, all_lanes<double>()).present.value;
    }
    [[nodiscard]] bool contact_proven(Interval i) const { return contact_proven_on<kind>(pair_, Between<double>{i.a, i.b}).value; }
    [[nodiscard]] bool contact_proven_near(double s) const { return FASTCCD_KERNEL_NAMESPACE::contact_proven_near<kind>(pair_, s).value; }
    [[nodiscard]] bool zero_at_start() const { return FASTCCD_KERNEL_NAMESPACE::zero_at_start(pair_).value; }
    [[nodiscard]] bool in_contact_at_start(double leaf_width) const
    {
        return FASTCCD_KERNEL_NAMESPACE::in_contact_at_start<kind>(pair_, leaf_width).value;
    }
    [[nodiscard]] bool counts_as_contact_at_start(const ErrorBounds& bounds) const
    {
        return FASTCCD_KERNEL_NAMESPACE::counts_as_contact_at_start<kind>(pair_, bounds, all_lanes<double>()).value;
    }
    [[nodiscard]] bool has_area(double s) const { return has_area_at<kind>(pair_, s).value; }

    /// For kernels that take several intervals at a time.
    [[nodiscard]] const PairCoefficients& coefficients() const { return pair_; }

private:
    PairCoefficients pair_;
    bool apart_throughout_;
};

}  // namespace fastccd::scalar
