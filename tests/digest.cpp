// fastccd_digest [PAIRS]: a line per family of hard pairs with a checksum of everything that is answered, from every instruction
// set of this machine. Two machines promise the same output: tools/test.sh --all compares this one, an emulated x86-64 without
// AVX, and an emulated arm64. Exit 1 if instruction sets differ on one machine already.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

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

/// True if all instruction sets and the certified search agree.
bool print_digest(const std::string& family, oracle::Kind kind, std::size_t pairs_per_family)
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
            std::printf("%s %s %g %g %zu %016llx\n", family.c_str(), kind_name(kind), tolerance, t_max,
                        expected.summary.contacts, static_cast<unsigned long long>(sum));
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

}  // namespace
}  // namespace fastccd::testing

int main(int argc, char** argv)
{
    using namespace fastccd;
    using namespace fastccd::testing;
    const std::size_t pairs = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 200;
    if (argc > 2 || pairs == 0) {
        std::fprintf(stderr, "usage: fastccd_digest [PAIRS of each family]\n");
        return 2;
    }
    bool agree = true;
    for (const std::string& family : families())
        for (const oracle::Kind kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
            agree &= print_digest(family, kind, pairs);
    return agree ? 0 : 1;
}
