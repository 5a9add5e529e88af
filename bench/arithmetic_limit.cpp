#include "arithmetic_limit.hpp"

#include <chrono>
#include <cstddef>

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <fastccd/isa.hpp>

namespace fastccd::bench {

namespace {

/// x[i] = x[i] factor, over and over, each after itself and beside the others.
template <std::size_t bytes>
[[gnu::always_inline]] inline void multiply_chains()
{
    using Vector [[gnu::vector_size(bytes)]] = double;
    const Vector factor = Vector{} + (1.0 + 1e-9);  // stays far from overflow
    Vector x[chains];
#pragma GCC unroll 12
    for (int i = 0; i < chains; ++i) x[i] = Vector{} + (i + 1.0);
    for (int n = 0; n < products_per_chain; ++n)
#pragma GCC unroll 12
        for (int i = 0; i < chains; ++i) x[i] *= factor;
    void* elements = x;  // of which all are used, so the compiler must keep every product
    benchmark::DoNotOptimize(elements);
}

using Part = void (*)();

#if defined(__x86_64__)
[[gnu::target("avx512f")]] void multiply_512() { multiply_chains<64>(); }
[[gnu::target("avx2")]] void multiply_256() { multiply_chains<32>(); }
#endif
void multiply_128() { multiply_chains<16>(); }

Part widest()
{
#if defined(__x86_64__)
    if (isa_available(Isa::avx512)) return multiply_512;
    if (isa_available(Isa::avx2)) return multiply_256;
#endif
    return multiply_128;
}

}  // namespace

double multiply(tbb::task_arena& arena)
{
    const Part part = widest();
    const auto begin = std::chrono::steady_clock::now();
    arena.execute([&] { tbb::parallel_for(0, parts, [&](int) { part(); }); });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace fastccd::bench
