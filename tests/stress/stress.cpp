// fastccd_stress --minutes M --seed S [--family F]
// fastccd_stress --kind vf|ee [--tolerance T] [--t-max X] [--min-separation D] [--distance-tolerance T] --replay "24 numbers"
//
// New hard pairs without end: every family, combinations of two, at scales that are no powers of two, at many
// tolerances and lengths of the step, and in some rounds with a minimum separation, on every instruction set of this
// machine, against exact truth and against the certified search. A failing pair is printed losslessly, with the arguments
// that replay it, and once more in the simplest form that still fails.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "../generators.hpp"
#include "../narrow_phase.hpp"
#include "../oracle/exact_distance.hpp"
#include "../thin_pairs.hpp"
#include "stress_case.hpp"

namespace fastccd::testing {
namespace {

constexpr const char* usage =
    "usage: fastccd_stress --minutes M --seed S [--family F]\n"
    "       fastccd_stress --kind vf|ee [--tolerance T] [--t-max X] [--min-separation D] [--distance-tolerance T]\n"
    "                      --replay \"24 numbers\"\n";

struct Arguments {
    double minutes = 1.0;
    std::uint64_t seed = 1;
    std::string family;  ///< Empty: all.
    std::string replay;
    Question question;
};

[[noreturn]] void refuse(const std::string& why)
{
    std::fprintf(stderr, "fastccd_stress: %s\n%s", why.c_str(), usage);
    std::exit(2);
}

double number(const std::string& option, const char* text)
{
    char* end = nullptr;
    const double value = std::strtod(text, &end);
    if (end == text || *end != '\0' || !std::isfinite(value)) refuse(option + ": no number: " + text);
    return value;
}

Arguments parse(int argc, char** argv)
{
    Arguments a;
    for (int i = 1; i < argc; i += 2) {
        const std::string option = argv[i];
        if (option == "--help") std::fputs(usage, stdout), std::exit(0);
        if (i + 1 == argc) refuse(option + " needs a value");
        const char* value = argv[i + 1];
        if (option == "--minutes") a.minutes = number(option, value);
        else if (option == "--seed") a.seed = std::strtoull(value, nullptr, 0);
        else if (option == "--family") a.family = value;
        else if (option == "--replay") a.replay = value;
        else if (option == "--tolerance") a.question.tolerance = number(option, value);
        else if (option == "--t-max") a.question.t_max = number(option, value);
        else if (option == "--min-separation") a.question.minimum_separation = number(option, value);
        else if (option == "--distance-tolerance") a.question.distance_tolerance = number(option, value);
        else if (option == "--kind" && std::strcmp(value, "vf") == 0) a.question.kind = oracle::Kind::vertex_face;
        else if (option == "--kind" && std::strcmp(value, "ee") == 0) a.question.kind = oracle::Kind::edge_edge;
        else refuse("what is " + option + ' ' + value + '?');
    }
    return a;
}

oracle::Pair read_pair(const std::string& text)
{
    oracle::Pair pair;
    const char* p = text.c_str();
    for (auto& point : pair)
        for (double& x : point) {
            char* end = nullptr;
            x = std::strtod(p, &end);
            if (end == p || !std::isfinite(x)) refuse("--replay: 24 finite numbers expected");
            p = end;
        }
    if (std::strspn(p, " ") != std::strlen(p)) refuse("--replay: more than 24 numbers");
    return pair;
}

/// One round: a question and pairs, from nothing but the seed.
class Round {
public:
    Round(const std::string& only_family, std::uint64_t seed) : bits_{seed}
    {
        question.kind = chance(0.5) ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
        question.tolerance = chance(0.4) ? 1e-9 : std::pow(10.0, uniform(-16, 0.3));
        if (chance(0.3)) question.t_max = chance(0.7) ? uniform(0.001, 1) : std::pow(10.0, uniform(-9, 0));
        family = only_family.empty() ? any_family() : only_family;
        constexpr std::size_t n = 192;
        make(family, n, pairs);
        if (only_family.empty() && chance(0.15)) combine(n);
        if (chance(0.3)) scale();
        if (chance(0.2)) keep_apart();
    }

    Question question;
    std::string family;
    std::vector<oracle::Pair> pairs;

private:
    static constexpr const char* thin = "thin";

    double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
    bool chance(double p) { return uniform(0, 1) < p; }
    std::string any_family()
    {
        const std::size_t i = bits_() % (families().size() + 3);
        return i < families().size() ? families()[i] : thin;
    }

    void make(const std::string& name, std::size_t n, std::vector<oracle::Pair>& out)
    {
        const std::uint64_t seed = bits_();
        if (name == thin)
            out = ThinPairs{question.kind, seed}.next(n);
        else
            generate(name, question.kind, seed, n, out);
    }

    /// Points, axes or ends of the motion from another family.
    void combine(std::size_t n)
    {
        const std::string other = any_family();
        std::vector<oracle::Pair> more;
        make(other, n, more);
        family += " with " + other;
        const auto how = bits_() % 3;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t c = 0; c < 24; ++c)
                if (how == 0 ? c >= 12 : how == 1 ? c % 3 == i % 3 : c / 3 % 4 == i % 4) pairs[i][c / 3][c % 3] = more[i][c / 3][c % 3];
    }

    /// By a number of any bits, the same for all axes, or by powers of two, one per axis, which keep exact contacts.
    void scale()
    {
        const bool powers = chance(0.5), wide = chance(0.5);
        for (oracle::Pair& pair : pairs) {
            const double factor = std::pow(10.0, uniform(-6, 6));
            const double range = wide ? 330 : 40;
            int shift[3];
            for (int& s : shift) s = static_cast<int>(uniform(-range, range));
            oracle::Pair scaled = pair;
            for (auto& point : scaled)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    point[axis] = powers ? std::ldexp(point[axis], shift[axis]) : factor * point[axis];
            if (oracle::is_finite(scaled)) pair = scaled;
        }
    }

    /// Asks for a minimum separation, in terms of the size of one of the pairs; of fewer pairs, as exact distances take long.
    void keep_apart()
    {
        constexpr std::size_t fewer = 24;
        const double size = oracle::sum_of_extents(pairs[bits_() % fewer]).get_d();
        const double separation = std::pow(10.0, uniform(-12, 0.3)) * size;
        if (!(separation > 0.0) || std::isinf(separation)) return;
        pairs.resize(fewer);
        question.minimum_separation = separation;
        if (chance(0.4)) question.distance_tolerance = chance(0.2) ? 0.0 : std::pow(10.0, uniform(-13, 0));
    }

    std::mt19937_64 bits_;
};

int report(Question question, oracle::Pair pair, const std::string& what, const char* program)
{
    std::printf("FAULT: %s\n%s\nagain: %s %s\n", what.c_str(), describe(question, pair).c_str(), program,
                replay_arguments(question, pair).c_str());
    if (fault(question, pair).empty()) {
        std::printf("alone, the pair is answered well\n");
        return 1;
    }
    shrink(question, pair);
    std::printf("\nshrunk: %s\n%s\nagain: %s %s\n", fault(question, pair).c_str(), describe(question, pair).c_str(), program,
                replay_arguments(question, pair).c_str());
    return 1;
}

int run(const Arguments& arguments, const char* program)
{
    if (!arguments.replay.empty()) {
        const oracle::Pair pair = read_pair(arguments.replay);
        if (const std::string what = fault(arguments.question, pair); !what.empty())
            return report(arguments.question, pair, what, program);
        std::printf("no fault\n%s", describe(arguments.question, pair).c_str());
        return 0;
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(60 * arguments.minutes);
    std::uint64_t rounds = 0, asked = 0, asked_with_separation = 0, undecided = 0;
    do {
        const std::uint64_t seed = arguments.seed + 0x9e3779b97f4a7c15u * rounds++;
        const Round round{arguments.family, seed};
        (round.question.minimum_separation > 0.0 ? asked_with_separation : asked) += round.pairs.size();
        const BatchFault found = first_fault(round.question, round.pairs);
        undecided += found.undecided;
        if (found.pair == round.pairs.size()) continue;
        std::printf("family %s, round %llu of seed %llu\n", round.family.c_str(), static_cast<unsigned long long>(rounds),
                    static_cast<unsigned long long>(arguments.seed));
        return report(round.question, round.pairs[found.pair], found.what, program);
    } while (std::chrono::steady_clock::now() < end);
    std::printf("seed %llu: %llu pairs, %llu more with a minimum separation (%llu of them beyond the oracle), in %llu rounds on %zu "
                "instruction sets: nothing missed, late or farther than stated, the same bits\n",
                static_cast<unsigned long long>(arguments.seed), static_cast<unsigned long long>(asked),
                static_cast<unsigned long long>(asked_with_separation), static_cast<unsigned long long>(undecided),
                static_cast<unsigned long long>(rounds), isas_to_test().size());
    return 0;
}

}  // namespace
}  // namespace fastccd::testing

int main(int argc, char** argv)
{
    try {
        return fastccd::testing::run(fastccd::testing::parse(argc, argv), argv[0]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fastccd_stress: %s\n", error.what());
        return 2;
    }
}
