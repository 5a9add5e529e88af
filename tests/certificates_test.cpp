// What the proofs of absence claim, on whole pairs: none is given over an interval that holds an exact contact, and
// what lanes conclude, the certified search can prove leaf by leaf.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <halves_certificate.hpp>
#include <kernel_table.hpp>
#include <leaf_search.hpp>
#include <part_certificates.hpp>
#include <projected_inclusion.hpp>

#include "amount.hpp"
#include "bounds/measured_bound.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"

namespace fastccd::testing {
namespace {

using scalar::Interval;
using scalar::PairPolynomials;

constexpr oracle::Kind kinds[] = {oracle::Kind::vertex_face, oracle::Kind::edge_edge};

double uniform(std::mt19937_64& bits) { return static_cast<double>(bits() >> 11) * 0x1p-53; }

const double* coordinates(const oracle::Pair& pair) { return pair[0].data(); }

/// An interval of [0, 1] that holds [low, high], tight or wide on either side.
Interval around(double low, double high, std::mt19937_64& bits)
{
    const auto widen = [&] { return bits() % 4 == 0 ? 0.0 : std::ldexp(uniform(bits), -static_cast<int>(bits() % 60)); };
    return {std::max(0.0, low - widen()), std::min(1.0, high + widen())};
}

/// Every proof of absence that the lanes have, over [i.a, i.b] or all of [0, 1]; empty if none is given.
template <PairKind kind>
std::string lane_proof(const oracle::Pair& pair, const SearchParameters& parameters, Interval i)
{
    const ErrorBounds& bounds = parameters.bounds;
    const auto r = portable::relative_motion<double>(coordinates(pair), 1, parameters.t_max);
    portable::Extents<double> extents;
    const bool linear = portable::linear_certificate<kind>(r, bounds.certificates(), extents).value;
    const auto scale = portable::scales(extents);
    const auto cubic = portable::coplanarity_cubic(r, portable::cross_product(r, 0, 1));
    if (!portable::in_lane_range(cubic, extents, bounds.screening()).value) return {};
    if (linear) return "linear";
    if (portable::cubic_certificate(cubic, scale.volume, bounds.certificates()).value) return "cubic";
    const auto in_projections = [&](const portable::RelativeMotion<double>& motion, const CertificateBounds& chosen) {
        return portable::visit_edge_functions<kind>(motion, [&](const auto& p, const auto& q, const auto& t, const auto& s) {
                   return portable::quadratic_certificate<kind>(p, q, t, s, scale, chosen);
               }).value;
    };
    if (in_projections(r, bounds.certificates())) return "quadratic";
    const auto on_halves = portable::visit_edge_functions<kind>(r, [&](const auto& p, const auto& q, const auto& t, const auto& s) {
        return portable::halves_certificate<kind>(cubic, p, q, t, s, scale, bounds.halves());
    });
    if ((on_halves.first.value && i.b <= 0.5) || (on_halves.second.value && i.a >= 0.5) ||
        (on_halves.first.value && on_halves.second.value))
        return "halves";

    const double low = i.a >= 0.5 ? 0.5 : 0.0, high = low == 0.0 && i.b <= 0.5 ? 0.5 : 1.0;
    if (portable::apart_on_quarters<kind>(r, scale, bounds.on_part(), low, high, 1) != 0) return "quarters";

    for (const double start : {0.0, i.a}) {
        const auto part = portable::RelativeMotion<double>{
            {portable::position(r, 0, start), portable::position(r, 1, start), portable::position(r, 2, start)},
            {portable::position(r, 0, i.b), portable::position(r, 1, i.b), portable::position(r, 2, i.b)}};
        const auto cubic_on_part = portable::coplanarity_cubic(part, portable::cross_product(part, 0, 1));
        if (portable::cubic_certificate(cubic_on_part, scale.volume, bounds.on_part()).value) return "cubic on part";
        if (in_projections(part, bounds.on_part())) return "quadratic on part";
        if (portable::separated_on_part<kind>(part, extents, bounds.on_part()).value) return "linear on part";
    }

    const double centre = i.a + 0.5 * (i.b - i.a), delta = std::max(centre - i.a, i.b - centre);
    if (portable::projected_inclusion<kind>(r, scale, centre, delta, bounds).absent.value) return "projected inclusion";
    if (portable::area_certificate<kind>(r, scale, centre, delta, bounds).value) return "area inclusion";
    return {};
}

/// Every proof of absence in single precision, as screening gives it.
template <PairKind kind>
std::string single_proof(const oracle::Pair& pair, const SearchParameters& parameters, Interval i)
{
    const ComputedInSingle c{coordinates(pair), parameters.t_max};
    const auto given = [](const auto& mask) { return mask.value[0]; };
    portable::Extents<Single> extents;
    const bool linear = given(portable::linear_certificate<kind>(c.r, c.bounds.whole, extents));
    const auto cubic = portable::coplanarity_cubic(c.r, portable::cross_product(c.r, 0, 1));
    if (!given(portable::in_lane_range(cubic, extents, c.bounds))) return {};
    if (linear) return "linear, single";
    if (given(portable::cubic_certificate(cubic, c.scale.volume, c.bounds.whole))) return "cubic, single";
    const auto on_halves = portable::visit_edge_functions<kind>(c.r, [&](const auto& p, const auto& q, const auto& t, const auto& s) {
        return portable::halves_certificate<kind>(cubic, p, q, t, s, c.scale, c.bounds.halves);
    });
    const bool first = given(on_halves.first), second = given(on_halves.second);
    if ((first && i.b <= 0.5) || (second && i.a >= 0.5) || (first && second)) return "halves, single";
    const auto end = portable::broadcast<Single>(std::min(1.0, i.b * (1 + 0x1p-22)));
    const portable::RelativeMotion<Single> part{{c.r.start[0], c.r.start[1], c.r.start[2]},
                                                {portable::position(c.r, 0, end), portable::position(c.r, 1, end), portable::position(c.r, 2, end)}};
    if (given(portable::part_certificate<kind>(part, c.scale, c.bounds.part))) return "part, single";
    return {};
}

template <PairKind kind>
std::string search_proof(const oracle::Pair& pair, const SearchParameters& parameters, Interval i)
{
    const PairPolynomials<kind> polynomials{coordinates(pair), parameters};
    if (polynomials.apart()) return "search, whole";
    if (polynomials.apart(i)) return "search";
    if (portable::apart_by_area_on<kind>(polynomials.coefficients(), i.a, i.b).value) return "search, area";
    return {};
}

TEST(Certificates, NoneIsGivenAroundAContact)
{
    std::mt19937_64 bits{61};
    std::size_t tried = 0;
    for (const auto kind : kinds)
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 62, amount(150), pairs);
            for (const oracle::Pair& pair : pairs)
                for (const double t_max : {1.0, 0.75, 1.0 / 3.0}) {
                    const oracle::Verdict verdict = oracle::exact_ccd(kind, pair, t_max);
                    if (!verdict.contact) continue;
                    const SearchParameters parameters{1e-9, t_max, false};
                    // s = t / t_max, rounded outwards.
                    const bool whole = t_max == 1.0;
                    const double low = whole ? verdict.t_lo : verdict.t_lo / t_max * (1 - 0x1p-51);
                    const double high = whole ? verdict.t_hi : std::min(1.0, verdict.t_hi / t_max * (1 + 0x1p-51));
                    for (int k = 0; k < 6; ++k, ++tried) {
                        const Interval i = around(low, high, bits);
                        const bool vf = kind == oracle::Kind::vertex_face;
                        const std::string given = vf ? lane_proof<PairKind::vertex_face>(pair, parameters, i)
                                                     : lane_proof<PairKind::edge_edge>(pair, parameters, i);
                        const std::string in_single = vf ? single_proof<PairKind::vertex_face>(pair, parameters, i)
                                                         : single_proof<PairKind::edge_edge>(pair, parameters, i);
                        const std::string searched = vf ? search_proof<PairKind::vertex_face>(pair, parameters, i)
                                                        : search_proof<PairKind::edge_edge>(pair, parameters, i);
                        ASSERT_EQ(given + in_single + searched, "") << family << " t_max " << t_max << " on [" << i.a << ", " << i.b
                                                        << "] " << kind_name(kind) << ' ' << lossless(pair);
                    }
                }
        }
    EXPECT_GT(tried, amount(50000));
}

template <PairKind kind>
void expect_no_false_proof(std::size_t& misses)
{
    const oracle::Kind exact_kind = kind == PairKind::vertex_face ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
    const SearchParameters parameters{1e-9, 1.0, false};
    for (const char* family : {"grazing", "grazing_exact", "f32_grazing", "near_interior"}) {
        std::vector<oracle::Pair> pairs;
        generate(family, exact_kind, 66, amount(4000), pairs);
        Options options;
        options.reference = true;
        const Answer found = answer(exact_kind, interleaved(pairs), options);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (!(found.toi[i] <= 1.0) || oracle::exact_ccd(exact_kind, pairs[i]).contact) continue;
            const double left = std::floor(found.toi[i] * parameters.leaf_count) * parameters.leaf_width;
            const PairPolynomials<kind> polynomials{coordinates(pairs[i]), parameters};
            ++misses;
            ASSERT_FALSE(polynomials.contact_proven({left, left + parameters.leaf_width}))
                << "contact counts as proven: " << family << ' ' << lossless(pairs[i]);
        }
    }
}

TEST(Certificates, ContactIsNotProvenWhereThereIsNone)
{
    std::size_t misses = 0;
    expect_no_false_proof<PairKind::vertex_face>(misses);
    expect_no_false_proof<PairKind::edge_edge>(misses);
    EXPECT_GT(misses, amount(50)) << "no near miss was reported: nothing was tested";
    std::printf("%zu near misses that rounding cannot tell from contact\n", misses);
}

/// A vertex that hovers over a face at rest, its distance all rounding: f is linear and exactly positive at both ends, but
/// often computed with both signs.
TEST(Certificates, ContactIsNotProvenByRounding)
{
    std::mt19937_64 bits{91};
    const SearchParameters parameters{0.5, 1.0, false};
    std::size_t computed_signs_differ = 0;
    for (std::size_t tries = 0; tries < amount(200000); ++tries) {
        oracle::Pair pair{};
        const double slope_x = uniform(bits) - 0.5, slope_y = uniform(bits) - 0.5;
        const auto set = [&](std::size_t row, double x, double y) { pair[row] = {x, y, slope_x * x + slope_y * y}; };
        set(0, 0.2 * uniform(bits), 0.2 * uniform(bits));
        set(4, 0.2 * uniform(bits), 0.2 * uniform(bits));
        for (const std::size_t start : {std::size_t{0}, std::size_t{4}}) {
            set(start + 1, -1, -1);
            set(start + 2, 1, -1);
            set(start + 3, 0, 1);
        }
        const PairPolynomials<PairKind::vertex_face> polynomials{coordinates(pair), parameters};
        const auto f = polynomials.coplanarity({0.5, 1.0});
        if (!(f.c0 < 0 && f.c3 > 0) && !(f.c0 > 0 && f.c3 < 0)) continue;
        if (oracle::exact_ccd(oracle::Kind::vertex_face, pair).contact) continue;
        ++computed_signs_differ;
        ASSERT_FALSE(polynomials.contact_proven({0.5, 1.0})) << "contact counts as proven: " << lossless(pair);
    }
    EXPECT_GT(computed_signs_differ, amount(100)) << "nothing was tested";
}

/// A flat face, or an edge, that reaches a point at rest, or a crossing edge, along one axis by less than rounding shows:
/// the exact gap at t_max is zero or negative, the computed one positive.
TEST(Certificates, ContactAtTheVeryEndOfAShorterStepIsNotRoundedAway)
{
    std::mt19937_64 bits{65};
    std::size_t rounded_away = 0;
    for (int i = 0; i < 1000000 && rounded_away < 200; ++i) {
        const double t_max = 0.001 + 0.9 * uniform(bits), from = 0.5 + uniform(bits);
        const double to = -(1 - t_max) * from / t_max * (1 + static_cast<double>(bits() % 5) * 0x1p-53);
        const double computed = portable::lerp(from, to, t_max);
        if (!(computed > 0.0)) continue;
        const mpq_class exact = (mpq_class(1) - mpq_class(t_max)) * mpq_class(from) + mpq_class(t_max) * mpq_class(to);
        if (sgn(exact) > 0) continue;
        ++rounded_away;
        const auto axis = static_cast<std::size_t>(bits() % 3);
        for (const auto kind : kinds) {
            oracle::Pair pair = kind == oracle::Kind::vertex_face
                                    ? oracle::Pair{{{0, 0, 0}, {0, -1, -1}, {0, 2, -1}, {0, -1, 2}, {0, 0, 0}, {0, -1, -1}, {0, 2, -1}, {0, -1, 2}}}
                                    : oracle::Pair{{{0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 2}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 2}}};
            for (std::size_t point = kind == oracle::Kind::vertex_face ? 1 : 2; point < 4; ++point)
                pair[point][0] = from, pair[point + 4][0] = to;
            for (auto& point : pair) std::swap(point[0], point[axis]);
            ASSERT_TRUE(oracle::exact_ccd(kind, pair, t_max).contact);
            for (const bool reference : {true, false}) {
                Options options;
                options.t_max = t_max;
                options.reference = reference;
                ASSERT_LE(answer(kind, interleaved({pair}), options).toi[0], t_max) << "missed: " << t_max << ' ' << lossless(pair);
            }
        }
    }
    EXPECT_GT(rounded_away, 100u);
}

/// Leaves to look at: all if they are few; else those at the ends of the intervals that the search drops on its way,
/// and some between.
template <PairKind kind>
class Leaves {
public:
    Leaves(const oracle::Pair& pair, const SearchParameters& parameters)
        : polynomials_{coordinates(pair), parameters}, parameters_{parameters}
    {
    }

    /// Left end of the first leaf seen in [0, until] without a certificate; `until` if all have one.
    double first_without_certificate(double until, std::mt19937_64& bits)
    {
        if (polynomials_.apart()) return until;
        const double w = parameters_.leaf_width;
        std::vector<Interval> stack{{0.0, 1.0}};
        while (!stack.empty()) {
            const Interval i = stack.back();
            stack.pop_back();
            if (i.a >= until) return until;
            if (i.b - i.a > w && (i.b - i.a > 1.0 / 64 || !polynomials_.apart(i))) {
                const double middle = i.a + 0.5 * (i.b - i.a);
                stack.push_back({middle, i.b});
                stack.push_back({i.a, middle});
                continue;
            }
            const double inside = i.a + std::floor(uniform(bits) * (i.b - i.a) / w) * w;
            for (const double a : {i.a, inside, i.b - w}) {
                const Interval leaf{a, a + w};
                if (until <= a || polynomials_.apart(leaf)) continue;
                if (!portable::apart_by_area_on<kind>(polynomials_.coefficients(), leaf.a, leaf.b).value) return a;
            }
        }
        return until;
    }

private:
    const PairPolynomials<kind> polynomials_;
    const SearchParameters& parameters_;
};

template <PairKind kind>
void expect_proofs(const std::vector<oracle::Pair>& pairs, const std::string& family, double tolerance, double t_max,
                   TileScratch& scratch, std::size_t& apart, std::size_t& contacts)
{
    const oracle::Kind exact_kind = kind == PairKind::vertex_face ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
    const SearchParameters parameters{tolerance, t_max, true};
    const PairView view = interleaved(pairs);
    const PairSource source{&view, {}, view.size()};
    kernel_table(Isa::scalar)->run_tile({kind, &source, 0, pairs.size(), &parameters, 1.0}, scratch);
    std::mt19937_64 bits{63};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (is_set(scratch.is_undecided, i)) continue;
        const double found = scratch.time[i];
        const double until = std::min(found, 1.0);
        const double open = Leaves<kind>{pairs[i], parameters}.first_without_certificate(until, bits);
        ASSERT_EQ(open, until) << family << " tolerance " << tolerance << " t_max " << t_max
                               << ": no certificate for a leaf that lanes passed over: " << lossless(pairs[i]);
        if (found > 1.0) {
            ++apart;
            continue;
        }
        ++contacts;
        // Contact is concluded from a proof, so the exact first contact is in that very leaf.
        const oracle::Verdict verdict = oracle::exact_ccd(exact_kind, pairs[i], t_max);
        ASSERT_TRUE(verdict.contact) << family << ' ' << lossless(pairs[i]);
        ASSERT_GE(verdict.t_hi, found * t_max * (1 - 0x1p-51)) << family << ' ' << lossless(pairs[i]);
        ASSERT_LE(verdict.t_lo, (found + parameters.leaf_width) * t_max * (1 + 0x1p-51)) << family << ' ' << lossless(pairs[i]);
    }
}

TEST(Certificates, TheSearchCanProveWhatLanesConclude)
{
    const auto scratch = std::make_unique<TileScratch>();
    std::size_t apart = 0, contacts = 0;
    struct Step {
        double tolerance, t_max;
    };
    for (const Step step : {Step{0.5, 1.0}, {0.25, 1.0}, {0.06, 0.9}, {1e-2, 1.0}, {1e-5, 0.3}, {1e-9, 1.0}})
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, oracle::Kind::vertex_face, 64, 60, pairs);
            expect_proofs<PairKind::vertex_face>(pairs, family, step.tolerance, step.t_max, *scratch, apart, contacts);
            generate(family, oracle::Kind::edge_edge, 64, 60, pairs);
            expect_proofs<PairKind::edge_edge>(pairs, family, step.tolerance, step.t_max, *scratch, apart, contacts);
            if (HasFatalFailure()) return;
        }
    EXPECT_GT(apart, 5000u);
    EXPECT_GT(contacts, 500u);
}

}  // namespace
}  // namespace fastccd::testing
