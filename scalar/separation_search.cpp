// The steps of separation_steps.hpp for one pair, which is scaled before where it is beyond the lanes' range.
#include <separation_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fastccd/pair_view.hpp>
#include <separation_steps.hpp>

namespace fastccd::scalar {

namespace {

using namespace FASTCCD_KERNEL_NAMESPACE;

bool finite(const double* coordinates)
{
    return std::all_of(coordinates, coordinates + pair_coordinates, [](double x) { return std::isfinite(x); });
}

/// d and what follows from it, in other units.
SeparationParameters in_units(const SeparationParameters& s, int exponent)
{
    SeparationParameters scaled;
    scaled.distance = std::scalbn(s.distance, exponent);
    scaled.threshold = std::scalbn(s.threshold, exponent);
    scaled.stop = std::scalbn(s.stop, exponent);
    scaled.aim = std::scalbn(s.aim, exponent);
    scaled.certain = std::scalbn(s.certain, exponent);
    return scaled;
}

/// The motion of a pair beyond the lanes' range, multiplied by the power of two that brings the largest extent near
/// 1: the same on all axes, and for d, because distances are compared. Differences are taken first, which keeps the digits
/// of small differences of large coordinates. Results that underflow err by 2^-1075, which separation_floor covers.
RelativeMotion<double> scaled_motion(const double* coordinates, SearchParameters& parameters)
{
    constexpr int halving = 4;  // where a difference could overflow
    double scaled[pair_coordinates] = {};
    int shift[3], exponent = std::numeric_limits<int>::min();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double largest_coordinate = 0.0, extent = 0.0;
        for (std::size_t i = axis; i < pair_coordinates; i += 3)
            largest_coordinate = std::max(largest_coordinate, std::abs(coordinates[i]));
        shift[axis] = largest_coordinate > 0x1p1021 ? halving : 0;
        const double factor = std::scalbn(1.0, -shift[axis]);
        for (std::size_t end = 0; end < pair_coordinates; end += 12)
            for (std::size_t i = end + axis + 3; i < end + 12; i += 3) {
                scaled[i] = coordinates[i] * factor - coordinates[end + axis] * factor;
                extent = std::max(extent, std::abs(scaled[i]));
            }
        if (extent > 0.0) exponent = std::max(exponent, std::ilogb(extent) + shift[axis]);
    }
    if (exponent != std::numeric_limits<int>::min()) {
        for (std::size_t i = 0; i < pair_coordinates; ++i) scaled[i] = std::scalbn(scaled[i], shift[i % 3] - exponent);
        parameters.separation = in_units(parameters.separation, -exponent);
    }
    return relative_motion<double>(scaled, 1, parameters.t_max);
}

template <PairKind kind>
SearchResult search(const double* coordinates, SearchParameters parameters, double limit)
{
    SeparationRecord<double> pair{};
    pair.r = relative_motion<double>(coordinates, 1, parameters.t_max);
    pair.extents = extents(pair.r);
    if (!in_separation_range(pair.r, pair.extents).value) {
        pair.r = scaled_motion(coordinates, parameters);
        pair.extents = extents(pair.r);
    }

    constexpr double never = std::numeric_limits<double>::infinity();
    Extents<double> same;
    const SeparationBounds bounds{parameters.bounds.rho};
    if (farther_along_axis<kind>(pair.r, parameters.separation, bounds, same).value) return {never, Proof::none, 0, 0};
    if (first_look<kind>(pair, parameters).value) return {never, Proof::none, 0, 1};
    while (true) {
        const StepOutcome<double> outcome = step<kind>(pair, parameters, limit);
        const auto looks = static_cast<unsigned>(pair.looks);
        if (outcome.farther.value) return {never, Proof::none, 0, looks};
        if (outcome.contact.value)
            return {parameters.time(pair.time), outcome.proven.value ? Proof::leaf : Proof::none, 0, looks};
    }
}

}  // namespace

SearchResult separation_search(PairKind kind, const double* coordinates, const SearchParameters& parameters, double limit)
{
    if (!finite(coordinates)) return {std::numeric_limits<double>::quiet_NaN(), Proof::none, 0, 0};
    return kind == PairKind::vertex_face ? search<PairKind::vertex_face>(coordinates, parameters, limit)
                                         : search<PairKind::edge_edge>(coordinates, parameters, limit);
}

}  // namespace fastccd::scalar
