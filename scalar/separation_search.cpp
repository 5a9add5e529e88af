// The steps of separation_steps.hpp for one pair, which is scaled before where it is beyond the lanes' range; and, for a pair that
// takes many, directions that follow the primitives in between.
#include <separation_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <contact_guess.hpp>
#include <farther_certificates.hpp>
#include <following_direction.hpp>
#include <interval_certificates.hpp>
#include <no_distance.hpp>
#include <scaling.hpp>
#include <separation_steps.hpp>

namespace fastccd::scalar {

namespace {

using namespace FASTCCD_KERNEL_NAMESPACE;

/// The motion of a pair beyond the lanes' range, multiplied by the power of two that brings the largest extent near
/// 1: the same on all axes, and for d, because distances are compared. Results that underflow err by some 2^-1074, which
/// separation_floor covers.
RelativeMotion<double> scaled_motion(const double* coordinates, SearchParameters& parameters)
{
    const AxisDifferences axes[] = {{coordinates, 0}, {coordinates, 1}, {coordinates, 2}};
    int exponent = std::numeric_limits<int>::min();
    for (const AxisDifferences& differences : axes)
        if (!differences.zero()) exponent = std::max(exponent, differences.exponent(parameters.t_max));
    RelativeMotion<double> r{};
    if (exponent == std::numeric_limits<int>::min()) return r;
    // What follows from d is formed anew: of a subnormal one it was rounded, of one next to the largest double it was infinite.
    // Beyond 2^200 of the pair's size all is within it, so that it need not become infinite.
    parameters.separation = SeparationParameters{std::min(std::scalbn(parameters.separation.distance, -exponent), 0x1p200),
                                                 parameters.separation.tolerance};
    double start[3][3], end[3][3];
    for (int axis = 0; axis < 3; ++axis) axes[axis].put(start[axis], end[axis], parameters.t_max, -exponent);
    for (int i = 0; i < 3; ++i) {
        r.start[i] = {start[0][i], start[1][i], start[2][i]};
        r.end[i] = {end[0][i], end[1][i], end[2][i]};
    }
    return r;
}

/// A stretch of time is not shortened below this: next to time 1 a shorter one might be none.
constexpr double shortest_stretch = 0x1p-50;

/// From where the last look reaches, as far as directions that follow the primitives prove a distance above d. `stretch`: how far
/// the next one is asked; doubled and halved with success. Each counts as a look, of which there are to be `most`. True if they prove it
/// to the end. Where not even the first does, as where shapes are nearly degenerate, the next look is the one that was planned.
template <PairKind kind>
bool follow(SeparationRecord<double>& pair, double& stretch, const SeparationParameters& wanted, const SeparationBounds& bounds, double most)
{
    const double start = past_window(pair, pair.high);
    double time = start;
    bool farther = true;
    while (farther && time < 1.0 && pair.looks < most) {
        const double end = std::min(time + stretch, 1.0);
        farther = FollowingDirection<kind>{pair.r, time, end}.farther(pair.extents, wanted, bounds);
        pair.looks += 1.0;
        if (farther) time = past_window(pair, end);
        stretch = farther ? 2.0 * stretch : std::max(0.5 * stretch, shortest_stretch);
    }
    if (!farther && time == start && pair.looks < most) return false;
    pair.time = pair.at = time;
    pair.purpose = going_on;
    return 1.0 <= time;
}

/// Where contact is asked for, looks after which a pair counts as touching at twice the distance, and again after as many, `most_doublings` times:
/// some edges that glide along one line take all of them otherwise (bounded_test.cpp). Choices: seventeen times keeps it below 3e-8 of the size.
constexpr double looks_to_double = 16;
constexpr int most_doublings = 17;

/// SeparationParameters::stop then: what that is more than the resolution.
double stop_for_contact(double looks, double size)
{
    const int doublings = std::min(static_cast<int>(looks / looks_to_double), most_doublings);
    return SeparationParameters::resolution * size * (std::scalbn(1.0, doublings) - 1.0);
}

constexpr double never = std::numeric_limits<double>::infinity();

enum class AskedFor { distance, contact };

/// From where the pair is on its way; the time in units of t_max. After `most` looks, fewer than most_looks, the time reached.
template <PairKind kind, AskedFor what>
SearchResult walk(SeparationRecord<double>& pair, SearchParameters parameters, double limit, double most = most_looks)
{
    const SeparationBounds bounds{parameters.bounds.rho};
    double stretch = 1.0;
    while (true) {
        if (what == AskedFor::contact) parameters.separation.stop = stop_for_contact(pair.looks, sum(pair.extents));
        const StepOutcome<double> outcome = step<kind>(pair, next_look<kind>(pair, parameters), parameters, limit);
        const bool followed = outcome.left.value && follow<kind>(pair, stretch, parameters.separation, bounds, most);
        const auto looks = static_cast<unsigned>(pair.looks);
        if (outcome.farther.value || followed) return {.toi = never, .intervals = looks};
        if (outcome.contact.value) return {.toi = pair.time, .proof = outcome.proven.value ? Proof::leaf : Proof::none, .intervals = looks};
        if (most < most_looks && most <= pair.looks) return {.toi = pair.time, .intervals = looks};
    }
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
    const FartherBounds bounds = SeparationBounds{parameters.bounds.rho}.certificates(parameters.separation);
    const ApartOnHalves<double> farther = farther_on_halves<kind>(pair.r, bounds, pair.extents);
    if ((farther.first & farther.second).value) return {.toi = never};
    if (first_look<kind>(pair, farther, parameters).value) return {.toi = never, .intervals = 1};
    guess_contact<kind>(pair, parameters);
    SearchResult result = walk<kind, AskedFor::distance>(pair, parameters, limit);
    if (result.toi <= 1.0) result.toi = parameters.time(result.toi);
    return result;
}

template <PairKind kind>
SearchResult search_on(const PairCoefficients& coefficients, SearchParameters parameters, double time, double most)
{
    parameters.separation = SeparationParameters{};
    SeparationRecord<double> pair{};
    pair.r = with_normalized_extents(motion_of<double>(coefficients));
    pair.extents = extents(pair.r);
    pair.time = pair.at = pair.high = pair.window_low = pair.window_high = time;
    return walk<kind, AskedFor::contact>(pair, parameters, 1.0, most);
}

}  // namespace

SearchResult separation_search(PairKind kind, const double* coordinates, const SearchParameters& parameters, double limit)
{
    if (!all_finite(coordinates)) return {.toi = std::numeric_limits<double>::quiet_NaN()};
    return kind == PairKind::vertex_face ? search<PairKind::vertex_face>(coordinates, parameters, limit)
                                         : search<PairKind::edge_edge>(coordinates, parameters, limit);
}

SearchResult apart_until(const PairCoefficients& pair, const SearchParameters& parameters, double time, unsigned most)
{
    return pair.kind == PairKind::vertex_face ? search_on<PairKind::vertex_face>(pair, parameters, time, most)
                                              : search_on<PairKind::edge_edge>(pair, parameters, time, most);
}

}  // namespace fastccd::scalar
