#include "stress_case.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "../narrow_phase.hpp"
#include "../oracle/exact_ccd.hpp"

namespace fastccd::testing {
namespace {

Options options_of(const Question& question, Isa isa)
{
    Options options;
    options.tolerance = question.tolerance;
    options.t_max = question.t_max;
    options.isa = isa;
    return options;
}

Answer reference_answer(const Question& question, const std::vector<oracle::Pair>& pairs)
{
    Options options = options_of(question, Isa::automatic);
    options.reference = true;
    return answer(question.kind, interleaved(pairs), options);
}

std::string against_truth(const Question& question, const oracle::Pair& pair, double toi)
{
    if (!(toi >= 0.0) || (toi > question.t_max && !std::isinf(toi))) return "toi outside [0, t_max]";
    const oracle::Verdict verdict = oracle::exact_ccd(question.kind, pair, question.t_max);
    if (!verdict.contact) return {};
    return std::isinf(toi) ? "missed" : toi > verdict.t_hi ? "late" : "";
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
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (std::string what = against_truth(question, pairs[i], expected.toi[i]); !what.empty())
            return {i, "certified search: " + what};
    for (const Isa isa : isas_to_test()) {
        const Answer found = answer(question.kind, interleaved(pairs), options_of(question, isa));
        if (const std::size_t i = first_difference(expected, found); i != pairs.size())
            return {i, std::string(name(isa)) + ": other bits than the certified search"};
    }
    return {pairs.size(), {}};
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
    char text[160];
    std::snprintf(text, sizeof text, "--kind %s --tolerance %a --t-max %a --replay \"",
                  question.kind == oracle::Kind::vertex_face ? "vf" : "ee", question.tolerance, question.t_max);
    std::string pair_text = lossless(pair);
    pair_text.pop_back();
    return text + pair_text + '"';
}

std::string describe(const Question& question, const oracle::Pair& pair)
{
    const oracle::Verdict verdict = oracle::exact_ccd(question.kind, pair, question.t_max);
    char line[200];
    std::snprintf(line, sizeof line, "truth: %s, first at [%.17g, %.17g], %d roots\n", verdict.contact ? "contact" : "no contact",
                  verdict.t_lo, verdict.t_hi, verdict.roots);
    std::string text = line;
    const std::vector<oracle::Pair> pairs{pair};
    const auto add = [&](const char* what, const Answer& found) {
        std::snprintf(line, sizeof line, "%-16s toi %.17g, %d roots\n", what, found.toi[0], found.roots[0]);
        text += line;
    };
    add("certified search", reference_answer(question, pairs));
    for (const Isa isa : isas_to_test()) add(name(isa), answer(question.kind, interleaved(pairs), options_of(question, isa)));
    return text;
}

}  // namespace fastccd::testing
