// Rational CSV: coordinates are finite, truth is there for every pair or for none; rounding changes nothing that is exact.
#include <cmath>
#include <cstring>

#include <tools/rational_csv.hpp>

#include "fuzz/fuzz_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace fastccd;
    return testing::read_or_refuse(data, size, [](std::string_view text) {
        const tools::RationalCsv rounded = tools::parse_rational_csv(text, "fuzz.csv", tools::Rounding::nearest);
        for (std::size_t i = 0; i < rounded.pairs.size(); ++i)
            for (std::size_t c = 0; c < pair_coordinates; ++c) testing::require(std::isfinite(rounded.pairs.at(i, c)));
        testing::require(rounded.truth.empty() || rounded.truth.size() == rounded.pairs.size());
        const tools::RationalCsv exact = tools::parse_rational_csv(text, "fuzz.csv", tools::Rounding::exact_only);
        testing::require(exact.pairs.size() == rounded.pairs.size());
        const std::size_t bytes = exact.pairs.block_count() * block_coordinates * sizeof(double);
        testing::require(bytes == 0 || std::memcmp(exact.pairs.data(), rounded.pairs.data(), bytes) == 0);
    });
}
