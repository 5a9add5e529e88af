#include "stress_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include <pair_polynomials.hpp>
#include <separation_search.hpp>
#include <separation_steps.hpp>

#include "../narrow_phase.hpp"
#include "../oracle/exact_ccd.hpp"
#include "../oracle/exact_distance.hpp"
#include "../oracle/exact_separation.hpp"

namespace fastccd::testing {
namespace {

Options options_of(const Question& question, Isa isa)
{
    Options options;
    options.tolerance = question.tolerance;
    options.t_max = question.t_max;
    options.minimum_separation = question.minimum_separation;
    options.distance_tolerance = question.distance_tolerance;
    options.isa = isa;
    return options;
}

Answer reference_answer(const Question& question, const std::vector<oracle::Pair>& pairs)
{
    Options options = options_of(question, Isa::automatic);
    options.reference = true;
    return answer(question.kind, interleaved(pairs), options);
}

/// Intervals after which the oracle does not know whether a pair comes within the separation: a fifth of what separation_test.cpp allows, which
/// leaves fewer than one pair in a thousand open.
constexpr int most_intervals = 1000;

oracle::Farther farther_before(const Question& question, const oracle::Pair& pair, double toi)
{
    const double until = toi >= 0.0 ? std::min(toi, question.t_max) : question.t_max;
    return oracle::farther_throughout(question.kind, pair, question.minimum_separation, 0.0, until, 200, most_intervals);
}

/// At toi, in units of the sum of the extents, beyond (1 + distance_tolerance) d, or at the start beyond d.
double excess_at(const Question& question, const oracle::Pair& pair, double toi)
{
    const mpq_class size = oracle::sum_of_extents(pair);
    mpq_class allowed = question.minimum_separation;
    if (toi > 0.0) allowed *= 1 + mpq_class(question.distance_tolerance);
    return sgn(size) == 0 ? 0.0 : oracle::excess_of_distance(question.kind, pair, toi, allowed, size);
}

unsigned looks_at(const Question& question, const oracle::Pair& pair)
{
    const SeparationParameters separation{question.minimum_separation, question.distance_tolerance};
    const SearchParameters parameters{question.tolerance, question.t_max, false, separation};
    return scalar::separation_search(pair_kind(question.kind), pair[0].data(), parameters).intervals;
}

std::string against_exact_distances(const Question& question, const oracle::Pair& pair, double toi, std::size_t& undecided)
{
    if (toi > 0.0) {
        const oracle::Farther farther = farther_before(question, pair, toi);
        if (farther == oracle::Farther::closer) return std::isinf(toi) ? "missed" : "late";
        undecided += farther == oracle::Farther::not_shown;
    }
    // 2^8 u (separation_test.cpp), but for the cap on looks. At time 0 this is that toi is positive where the pair is farther.
    constexpr double bound = 0x1p8 * 0x1p-53;
    if (std::isfinite(toi) && excess_at(question, pair, toi) > bound && looks_at(question, pair) < FASTCCD_KERNEL_NAMESPACE::most_looks)
        return "farther at toi than stated";
    return {};
}

/// That a search for contact takes, from the start of the step.
template <PairKind kind>
unsigned looks_along_directions(const SearchParameters& parameters, const oracle::Pair& pair)
{
    const scalar::PairPolynomials<kind> polynomials{pair[0].data(), parameters};
    return scalar::apart_until(polynomials.coefficients(), parameters, 0.0).intervals;
}

unsigned looks_along_directions(const Question& question, const oracle::Pair& pair)
{
    const SearchParameters parameters{question.tolerance, question.t_max, false};
    return question.kind == oracle::Kind::vertex_face ? looks_along_directions<PairKind::vertex_face>(parameters, pair)
                                                      : looks_along_directions<PairKind::edge_edge>(parameters, pair);
}

/// At toi, in units of the sum of the extents, beyond E_tol times the largest relative velocity of two end points, one of each primitive.
double excess_of_contact_at(const Question& question, const oracle::Pair& pair, double toi)
{
    const mpq_class size = oracle::sum_of_extents(pair);
    if (sgn(size) == 0) return 0.0;
    mpq_class fastest = 0;  // squared
    const std::size_t first = question.kind == oracle::Kind::vertex_face ? 1 : 2;
    for (std::size_t i = 0; i < first; ++i)
        for (std::size_t j = first; j < 4; ++j) {
            mpq_class square = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const mpq_class v = (mpq_class(pair[j + 4][k]) - pair[i + 4][k]) - (mpq_class(pair[j][k]) - pair[i][k]);
                square += v * v;
            }
            fastest = std::max(fastest, square);
        }
    const double tolerance = std::max(question.tolerance, 0x1p-50 * question.t_max);  // leaves are no narrower
    const mpf_class speed = sqrt(mpf_class(fastest, 256));
    return oracle::excess_of_distance(question.kind, pair, toi, mpq_class(tolerance) * mpq_class(speed), size);
}

std::string against_truth(const Question& question, const oracle::Pair& pair, double toi, std::size_t& undecided)
{
    if (!(toi >= 0.0) || (toi > question.t_max && !std::isinf(toi))) return "toi outside [0, t_max]";
    if (question.minimum_separation > 0.0) return against_exact_distances(question, pair, toi, undecided);
    const oracle::Verdict verdict = oracle::exact_ccd(question.kind, pair, question.t_max);
    if (verdict.contact && std::isinf(toi)) return "missed";
    if (verdict.contact && toi > verdict.t_lo) return "late";
    // 2^12 u, and 2^28 u after many looks, but for the cap (nothing_invented_test.cpp).
    if (std::isfinite(toi))
        if (const double excess = excess_of_contact_at(question, pair, toi);
            excess > 0x1p12 * 0x1p-53 && (looks_along_directions(question, pair) < 32 || excess > 0x1p28 * 0x1p-53))
            return "farther at toi than stated";
    return {};
}

/// Significant bits of all coordinates, and a little for each that is not zero or not an integer, and for signs.
double complexity(const Question& question, const oracle::Pair& pair)
{
    const auto of = [](double x) {
        if (x == 0.0) return 0.0;
        int exponent = 0;
        auto mantissa = static_cast<long long>(std::ldexp(std::frexp(std::fabs(x), &exponent), 53));
        double bits = 53;
        for (; mantissa % 2 == 0; mantissa /= 2) --bits;
        return bits + (x == std::floor(x) ? 1 : 2) + std::fabs(exponent) / 16.0 + (x < 0 ? 0.25 : 0);
    };
    double sum = of(question.t_max) + std::fabs(std::log10(question.tolerance) + 9) / 16;
    sum += of(question.minimum_separation) + of(question.distance_tolerance);
    for (const auto& point : pair)
        for (const double x : point) sum += of(x);
    return sum;
}

double with_bits(double x, int bits)
{
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    return std::ldexp(std::nearbyint(std::ldexp(fraction, bits)), exponent - bits);
}

}  // namespace

BatchFault first_fault(const Question& question, const std::vector<oracle::Pair>& pairs)
{
    const Answer expected = reference_answer(question, pairs);
    std::size_t undecided = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (std::string what = against_truth(question, pairs[i], expected.toi[i], undecided); !what.empty())
            return {i, "certified search: " + what, undecided};
    for (const Isa isa : isas_to_test()) {
        const Answer found = answer(question.kind, interleaved(pairs), options_of(question, isa));
        if (const std::size_t i = first_difference(expected, found); i != pairs.size())
            return {i, std::string(name(isa)) + ": other bits than the certified search", undecided};
    }
    return {pairs.size(), {}, undecided};
}

std::string fault(const Question& question, const oracle::Pair& pair)
{
    // Not a multiple of any number of lanes, so that it also falls into a last, partly filled batch.
    return first_fault(question, std::vector<oracle::Pair>(11, pair)).what;
}

void shrink(Question& question, oracle::Pair& pair)
{
    double current = complexity(question, pair);
    const auto accept = [&](const Question& q, const oracle::Pair& p) {
        if (!oracle::is_finite(p) || !(complexity(q, p) < current) || fault(q, p).empty()) return false;
        question = q;
        pair = p;
        current = complexity(q, p);
        return true;
    };
    const auto with = [&](std::size_t c, double x) {
        oracle::Pair p = pair;
        p[c / 3][c % 3] = x;
        return p;
    };
    for (bool progress = true; progress;) {
        progress = false;
        for (const double tolerance : {1e-9, 1e-6, 1.0}) {
            Question q = question;
            q.tolerance = tolerance;
            progress |= accept(q, pair);
        }
        for (const double t_max : {1.0, 0.5, with_bits(question.t_max, 4)}) {
            Question q = question;
            q.t_max = t_max;
            progress |= t_max > 0.0 && t_max <= 1.0 && accept(q, pair);
        }
        for (const double d : {0.0, 1.0, with_bits(question.minimum_separation, 1), with_bits(question.minimum_separation, 8)}) {
            Question q = question;
            q.minimum_separation = d;
            progress |= accept(q, pair);
        }
        for (const double distance_tolerance : {1e-6, 0.0}) {
            Question q = question;
            q.distance_tolerance = distance_tolerance;
            progress |= accept(q, pair);
        }
        // All of an axis at once: to zero, translated to x0, to another binade, rounded.
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto all = [&](const std::function<double(double)>& change) {
                oracle::Pair p = pair;
                for (auto& point : p) point[axis] = change(point[axis]);
                progress |= accept(question, p);
            };
            const double origin = pair[0][axis];
            all([](double) { return 0.0; });
            all([&](double x) { return x - origin; });
            all([](double x) { return std::nearbyint(x); });
            for (const int shift : {-64, -8, -1, 1, 8, 64}) all([=](double x) { return std::ldexp(x, shift); });
            for (const int bits : {4, 8, 16, 24, 32, 40, 48}) all([=](double x) { return with_bits(x, bits); });
        }
        for (std::size_t c = 0; c < 24; ++c) {
            const double x = pair[c / 3][c % 3];
            if (x == 0.0) continue;
            const double other_end = pair[(c / 3 + 4) % 8][c % 3];
            for (const double simpler : {0.0, std::nearbyint(x), other_end, -x}) progress |= accept(question, with(c, simpler));
            for (const int bits : {1, 2, 4, 8, 16, 26, 40, 46, 50, 52}) progress |= accept(question, with(c, with_bits(x, bits)));
        }
    }
}

std::string replay_arguments(const Question& question, const oracle::Pair& pair)
{
    char text[240];
    std::snprintf(text, sizeof text, "--kind %s --tolerance %a --t-max %a --min-separation %a --distance-tolerance %a --replay \"",
                  question.kind == oracle::Kind::vertex_face ? "vf" : "ee", question.tolerance, question.t_max, question.minimum_separation,
                  question.distance_tolerance);
    std::string pair_text = lossless(pair);
    pair_text.pop_back();
    return text + pair_text + '"';
}

std::string describe(const Question& question, const oracle::Pair& pair)
{
    const std::vector<oracle::Pair> pairs{pair};
    char line[200];
    if (question.minimum_separation > 0.0) {
        const double toi = reference_answer(question, pairs).toi[0];
        const oracle::Farther farther = farther_before(question, pair, toi);
        const char* const before = farther == oracle::Farther::certainly ? "farther than"
                                   : farther == oracle::Farther::closer  ? "within"
                                                                         : "not known whether within";
        char at_toi[64] = "";
        if (std::isfinite(toi)) std::snprintf(at_toi, sizeof at_toi, "; at toi %.3g of its size beyond", excess_at(question, pair, toi));
        if (toi == 0.0)
            std::snprintf(line, sizeof line, "at the start%s\n", at_toi);
        else
            std::snprintf(line, sizeof line, "before toi: %s the separation%s; %u looks\n", before, at_toi, looks_at(question, pair));
    } else {
        const oracle::Verdict verdict = oracle::exact_ccd(question.kind, pair, question.t_max);
        std::snprintf(line, sizeof line, "truth: %s, first at [%.17g, %.17g], %d roots\n", verdict.contact ? "contact" : "no contact",
                      verdict.t_lo, verdict.t_hi, verdict.roots);
    }
    std::string text = line;
    const auto add = [&](const char* what, const Answer& found) {
        std::snprintf(line, sizeof line, "%-16s toi %.17g, %d roots\n", what, found.toi[0], found.roots[0]);
        text += line;
    };
    add("certified search", reference_answer(question, pairs));
    for (const Isa isa : isas_to_test()) add(name(isa), answer(question.kind, interleaved(pairs), options_of(question, isa)));
    return text;
}

}  // namespace fastccd::testing
