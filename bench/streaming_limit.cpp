#include "streaming_limit.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include <benchmark/benchmark.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace fastccd::bench {

namespace {

constexpr std::size_t line = 64;
constexpr std::size_t words_per_line = line / sizeof(std::uint64_t);
/// As many bytes as a tile of 1,024 packed pairs of double.
constexpr std::size_t tile_bytes = 1024 * 192;

// Wide loads where the machine has them: out of cache they make no difference, in cache they do.
#if defined(__x86_64__)
#define FASTCCD_WIDEST __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define FASTCCD_WIDEST
#endif

/// Adds up lines first..last-1 of each array, side by side; prefetches in each.
FASTCCD_WIDEST std::uint64_t read_lines(const std::byte* data, std::size_t arrays, std::size_t array_bytes,
                                        std::size_t first, std::size_t last, StreamingLimit::Prefetch prefetch)
{
    std::uint64_t sums[words_per_line] = {};
    for (std::size_t i = first; i < last; ++i) {
        for (std::size_t a = 0; a < arrays; ++a) {
            const std::byte* const at = data + a * array_bytes + i * line;
            // Past the end of the data this is harmless: a prefetch does not fault.
            if (prefetch.distance != 0) {
                if (prefetch.into_second_level)
                    __builtin_prefetch(at + prefetch.distance * line, 0, 2);
                else
                    __builtin_prefetch(at + prefetch.distance * line, 0, 3);
            }
            const auto* const words = reinterpret_cast<const std::uint64_t*>(at);
            for (std::size_t k = 0; k < words_per_line; ++k) sums[k] += words[k];
        }
    }
    std::uint64_t sum = 0;
    for (const std::uint64_t part : sums) sum += part;
    return sum;
}

}  // namespace

double StreamingLimit::pass(tbb::task_arena& arena, Prefetch prefetch) const
{
    const std::size_t lines = streams_.bytes / line;
    const std::size_t tile_lines = std::max<std::size_t>(tile_bytes / line / streams_.count, 1);
    const std::size_t tiles = (lines + tile_lines - 1) / tile_lines;
    const auto begin = std::chrono::steady_clock::now();
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles), [&](const auto& range) {
            const std::size_t last = std::min(range.end() * tile_lines, lines);
            benchmark::DoNotOptimize(read_lines(streams_.data, streams_.count, streams_.bytes,
                                                range.begin() * tile_lines, last, prefetch));
        });
    });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double StreamingLimit::pass(tbb::task_arena& arena)
{
    const auto [best, is_new] = best_.try_emplace(arena.max_concurrency(), Prefetch{});
    if (is_new) {
        // 0 to 32 blocks of 8 pairs ahead; 0 leaves it to the hardware's own prefetcher.
        const std::size_t lines_per_block = std::max<std::size_t>(24 / streams_.count, 1);
        double least = std::numeric_limits<double>::infinity();
        for (const bool into_second_level : {false, true})
            for (const std::size_t blocks : std::initializer_list<std::size_t>{0, 1, 2, 4, 8, 16, 32})
                for (int repetition = 0; repetition < 3; ++repetition) {
                    const Prefetch prefetch{blocks * lines_per_block, into_second_level};
                    const double seconds = pass(arena, prefetch);
                    if (seconds >= least) continue;
                    least = seconds;
                    best->second = prefetch;
                }
    }
    return pass(arena, best->second);
}

}  // namespace fastccd::bench
