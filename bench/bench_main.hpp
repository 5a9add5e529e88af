// What the benchmark programs share: the context they record and how they end.
#pragma once

#include <functional>
#include <string>

#include <benchmark/benchmark.h>

namespace fastccd::bench {

/// Reports a benchmark that cannot give a figure; the program then ends with status 1.
void fail(benchmark::State& state, const std::string& what);

/// Google Benchmark's main function. Calls `register_benchmarks(filtered)`, where `filtered` is true if the user chooses
/// benchmarks by --benchmark_filter. Adds to the recorded context: processor, instruction sets, compiler, flags.
/// Status 0 if at least one benchmark ran and none failed.
int run_benchmarks(int argc, char** argv, const std::function<void(bool filtered)>& register_benchmarks);

}  // namespace fastccd::bench
