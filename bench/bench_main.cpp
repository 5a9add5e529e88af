#include "bench_main.hpp"

#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <string_view>

#include <fastccd/isa.hpp>

#include "bench_table.hpp"

namespace fastccd::bench {

namespace {

bool any_failed = false;

/// The values of /proc/cpuinfo for the first processor; a virtual machine may hide the model's name but not its number.
std::string processor()
{
    std::ifstream info("/proc/cpuinfo");
    std::string name, family, model;
    for (std::string line; std::getline(info, line) && !line.empty();) {
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos) continue;
        const std::string value = line.substr(colon + 2);
        if (line.starts_with("model name")) name = value;
        else if (line.starts_with("cpu family")) family = value;
        else if (line.starts_with("model")) model = value;
    }
    if (name.empty()) return "unknown";
    return family.empty() ? name : name + " (family " + family + ", model " + model + ")";
}

void add_context()
{
    std::string isas;
    for (const Isa isa : available_isas()) isas.append(isas.empty() ? "" : " ").append(fastccd::name(isa));
    benchmark::AddCustomContext("cpu", processor());
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
        if (benchmark::RunSpecifiedBenchmarks() == 0) return 1;
        benchmark::Shutdown();
    } catch (const std::exception& error) {
        std::cerr << argv[0] << ": " << error.what() << '\n';
        return 1;
    }
    return any_failed ? 1 : 0;
}

}  // namespace fastccd::bench
