// fastccd_digest [PAIRS]: a line per family of hard pairs, and one of all in every layout, with a checksum of everything that is answered, from every
// instruction set of this machine. Two machines promise the same output: tools/test.sh --all compares this one, an emulated x86-64 without
// AVX, and an emulated arm64.
// fastccd_digest --compare FILE: only the lines that differ from those of FILE, which another machine or an earlier commit has
// written, as tests/digests.txt. Exit 1 if there are any, or if instruction sets differ on one machine already.
#include <algorithm>
#include <array>
#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "all_layouts.hpp"
#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

/// FNV-1a over 64-bit words.
class Checksum {
public:
    void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3u; }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

std::uint64_t checksum(const Answer& answer)
{
    Checksum sum;
    for (const double toi : answer.toi) sum.add(std::bit_cast<std::uint64_t>(toi));
    for (const std::uint8_t roots : answer.roots) sum.add(roots);
    sum.add(answer.summary.contacts);
    sum.add(answer.summary.proven);
    sum.add(answer.summary.earliest.pair);
    return sum.value();
}

/// Appends to `lines`. True if all instruction sets and the certified search agree.
bool add_digest(const std::string& family, oracle::Kind kind, std::size_t pairs_per_family, std::vector<std::string>& lines)
{
    std::vector<oracle::Pair> pairs;
    generate(family, kind, 4711, pairs_per_family, pairs);
    const PairBuffer buffer = to_buffer(pairs);
    bool agree = true;
    for (const double tolerance : {1e-6, 1e-12})
        for (const double t_max : {1.0, 0.75}) {
            Options options;
            options.tolerance = tolerance;
            options.t_max = t_max;
            options.reference = true;
            const Answer expected = answer(kind, buffer.view(), options);
            const std::uint64_t sum = checksum(expected);
            char line[200];
            std::snprintf(line, sizeof line, "%s %s %g %g %zu %016" PRIx64, family.c_str(), kind_name(kind), tolerance, t_max,
                          expected.summary.contacts, sum);
            lines.emplace_back(line);
            options.reference = false;
            for (const Isa isa : isas_to_test()) {
                options.isa = isa;
                if (checksum(answer(kind, buffer.view(), options)) == sum) continue;
                std::fprintf(stderr, "%s differs from the certified search: %s %s\n", name(isa), family.c_str(), kind_name(kind));
                agree = false;
            }
        }
    return agree;
}

/// The same of pairs of all families at once, as floats and as doubles, in every layout. Their coordinates are numbers of either kind.
bool add_digest_of_layouts(oracle::Kind kind, std::size_t pairs_per_family, std::vector<std::string>& lines)
{
    std::vector<oracle::Pair> pairs = mixed_pairs(kind, 4712, pairs_per_family);
    for (oracle::Pair& pair : pairs)
        for (std::array<double, 3>& point : pair)
            for (double& x : point) x = static_cast<float>(std::clamp(x, -0x1.fffffep127, 0x1.fffffep127));
    const AllLayouts<float> floats{pairs};
    const AllLayouts<double> doubles{pairs};
    Options options;
    options.reference = true;
    const Answer expected = answer(kind, interleaved(pairs), options);
    options.reference = false;
    const std::uint64_t sum = checksum(expected);
    char line[200];
    std::snprintf(line, sizeof line, "layouts %s %zu %016" PRIx64, kind_name(kind), expected.summary.contacts, sum);
    lines.emplace_back(line);
    bool agree = true;
    for (const auto& views : {floats.views, doubles.views})
        for (const auto& [layout, view] : views)
            for (const Isa isa : isas_to_test()) {
                options.isa = isa;
                if (checksum(answer(kind, view, options)) == sum) continue;
                std::fprintf(stderr, "%s differs from the certified search: %s %s\n", name(isa), layout.c_str(), kind_name(kind));
                agree = false;
            }
    return agree;
}

std::vector<std::string> all_digests(std::size_t pairs_per_family, bool& agree)
{
    std::vector<std::string> lines;
    for (const std::string& family : families())
        for (const oracle::Kind kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
            agree &= add_digest(family, kind, pairs_per_family, lines);
    for (const oracle::Kind kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        agree &= add_digest_of_layouts(kind, (pairs_per_family + 7) / 8, lines);
    return lines;
}

/// True if `lines` are those of the file; prints which are not, by their numbers in it.
bool same_as_file(const std::vector<std::string>& lines, const char* file)
{
    std::ifstream in{file};
    if (!in) {
        std::fprintf(stderr, "%s: cannot be read\n", file);
        return false;
    }
    std::vector<std::string> expected;
    for (std::string line; std::getline(in, line);) expected.push_back(line);
    if (expected.size() != lines.size()) {
        std::fprintf(stderr, "%s: %zu lines, but there are %zu digests. If families were added, write it anew: fastccd_digest > %s\n", file,
                     expected.size(), lines.size(), file);
        return false;
    }
    std::size_t differ = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i] == expected[i]) continue;
        ++differ;
        std::printf("%s:%zu: %s\n    is now %s\n", file, i + 1, expected[i].c_str(), lines[i].c_str());
    }
    if (differ > 0)
        std::fprintf(stderr, "%s: %zu of %zu digests differ. If the bits of answers were meant to change, write it anew: fastccd_digest > %s\n",
                     file, differ, lines.size(), file);
    return differ == 0;
}

}  // namespace
}  // namespace fastccd::testing

int main(int argc, char** argv)
{
    using namespace fastccd::testing;
    constexpr std::size_t usual_pairs = 200;
    const bool compare = argc == 3 && std::string_view{argv[1]} == "--compare";
    const std::size_t pairs = argc == 2 ? std::strtoull(argv[1], nullptr, 10) : usual_pairs;
    if ((argc > 2 && !compare) || pairs == 0) {
        std::fprintf(stderr, "usage: fastccd_digest [PAIRS of each family]\n       fastccd_digest --compare FILE\n");
        return 2;
    }
    bool agree = true;
    const std::vector<std::string> lines = all_digests(pairs, agree);
    if (compare)
        agree &= same_as_file(lines, argv[2]);
    else
        for (const std::string& line : lines) std::printf("%s\n", line.c_str());
    return agree ? 0 : 1;
}
