#include "bench_main.hpp"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string_view>

#include <fastccd/isa.hpp>
#include <report/machine.hpp>

#include "bench_table.hpp"

namespace fastccd::bench {

namespace {

constexpr int no_match = 3;  // exit status: no benchmark has a name that the filter matches; tools/bench.sh tells this from a failure

bool any_failed = false;

void add_context()
{
    std::string isas;
    for (const Isa isa : available_isas()) isas.append(isas.empty() ? "" : " ").append(fastccd::name(isa));
    benchmark::AddCustomContext("cpu", tools::report::processor());
    benchmark::AddCustomContext("isas", isas);
    benchmark::AddCustomContext("best_isa", fastccd::name(best_isa()));
#if defined(__clang__)
    benchmark::AddCustomContext("compiler", __VERSION__);
#else
    benchmark::AddCustomContext("compiler", "g++ " __VERSION__);
#endif
    benchmark::AddCustomContext("flags", FASTCCD_BENCH_FLAGS);
}

}  // namespace

void fail(benchmark::State& state, const std::string& what)
{
    any_failed = true;
    state.SkipWithError(what.c_str());
}

int run_benchmarks(int argc, char** argv, const std::function<void(bool filtered)>& register_benchmarks)
{
    bool filtered = std::getenv("BENCHMARK_FILTER") != nullptr;
    for (int i = 1; i < argc; ++i) filtered |= std::string_view(argv[i]).starts_with("--benchmark_filter");
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    try {
        add_context();
        register_benchmarks(filtered);
        if (benchmark::RunSpecifiedBenchmarks() == 0) return no_match;
        benchmark::Shutdown();
    } catch (const std::exception& error) {
        std::cerr << argv[0] << ": " << error.what() << '\n';
        return 1;
    }
    return any_failed ? 1 : 0;
}

}  // namespace fastccd::bench
