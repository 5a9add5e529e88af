// Any bytes as pairs, both kinds: a byte chooses tolerance and t_max, then 24 doubles a pair. Every instruction set gives the
// bits of the certified search; a time is in [0, t_max] or infinite, and NaN exactly where a coordinate is not finite.
#include <cmath>
#include <cstring>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "fuzz/fuzz_bytes.hpp"

namespace {

using namespace fastccd;

std::vector<double> times(PairKind kind, const std::vector<double>& coordinates, const Options& options)
{
    std::vector<double> toi(coordinates.size() / pair_coordinates);
    testing::require(
        time_of_impact(kind, PairView::interleaved(coordinates.data(), toi.size()), options, toi).ok());
    return toi;
}

bool all_finite(const double* coordinates)
{
    for (std::size_t c = 0; c < pair_coordinates; ++c)
        if (!std::isfinite(coordinates[c])) return false;
    return true;
}

void check(PairKind kind, const std::vector<double>& coordinates, Options options)
{
    options.reference = true;
    const std::vector<double> expected = times(kind, coordinates, options);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const bool valid = all_finite(&coordinates[i * pair_coordinates]);
        testing::require(std::isnan(expected[i]) == !valid);
        if (valid) testing::require(expected[i] == INFINITY || (expected[i] >= 0.0 && expected[i] <= options.t_max));
    }
    options.reference = false;
    for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
        if (!isa_available(isa)) continue;
        options.isa = isa;
        const std::vector<double> found = times(kind, coordinates, options);
        testing::require(std::memcmp(found.data(), expected.data(), found.size() * sizeof(double)) == 0);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr std::size_t pair_bytes = pair_coordinates * sizeof(double);
    if (size < 1 + pair_bytes) return 0;
    Options options;
    options.tolerance = std::ldexp(1.0, -static_cast<int>(data[0] % 51));
    options.t_max = data[0] % 3 == 0 ? 1.0 : 1.0 / (1 + data[0]);
    std::vector<double> coordinates((size - 1) / pair_bytes * pair_coordinates);
    std::memcpy(coordinates.data(), data + 1, coordinates.size() * sizeof(double));
    check(PairKind::vertex_face, coordinates, options);
    check(PairKind::edge_edge, coordinates, options);
    return 0;
}
