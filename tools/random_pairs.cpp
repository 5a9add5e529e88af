#include "random_pairs.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace fastccd::tools {
namespace {

constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15;  // odd, about 2^64 / 1.618

/// SplitMix64's output function: the finaliser of MurmurHash3 with Stafford's constants "Mix13".
constexpr std::uint64_t mix(std::uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

constexpr double unit_interval(std::uint64_t bits)
{
    // Signed: 53 bits fit, and x86-64 before AVX-512 converts nothing else directly.
    return static_cast<double>(static_cast<std::int64_t>(bits >> 11)) * 0x1p-53;
}

}  // namespace

void fill_random_pairs(std::uint64_t seed, std::uint64_t first_pair, PairBuffer& pairs)
{
    const std::uint64_t start = mix(seed + golden_ratio);
    const auto state = [start](std::uint64_t pair) { return start + (pair * pair_coordinates + 1) * golden_ratio; };

    const std::size_t whole_blocks = pairs.size() / block_pairs;
    constexpr std::size_t grain = 128;  // blocks; 200 kB, many times what spawning a task costs
    tbb::parallel_for(tbb::blocked_range<std::size_t>{0, whole_blocks, grain}, [&](const auto& range) {
        for (std::size_t b = range.begin(); b != range.end(); ++b) {
            double* out = pairs.data() + b * block_coordinates;
            std::uint64_t row = state(first_pair + b * block_pairs);
            for (std::size_t c = 0; c < pair_coordinates; ++c, row += golden_ratio, out += block_pairs) {
                for (std::size_t lane = 0; lane < block_pairs; ++lane) {
                    out[lane] = unit_interval(mix(row + lane * (pair_coordinates * golden_ratio)));
                }
            }
        }
    });
    for (std::size_t i = whole_blocks * block_pairs; i < pairs.size(); ++i) {
        for (std::size_t c = 0; c < pair_coordinates; ++c) {
            pairs.at(i, c) = unit_interval(mix(state(first_pair + i) + c * golden_ratio));
        }
    }
}

}  // namespace fastccd::tools
