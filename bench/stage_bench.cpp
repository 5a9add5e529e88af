// The stages of the pipeline one by one, on data in the L2 cache, per instruction set: what each costs when nothing has
// to be waited for. `stage/vertex_face/avx2/certificates/random`. And the certified search.
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include <fastccd/isa.hpp>

#include "bench_main.hpp"
#include "bench_table.hpp"
#include "datasets.hpp"
#include "search_bench.hpp"
#include "stage_input.hpp"
#include "stage_table.hpp"

namespace fastccd {

// From stage_kernels.cpp, once per instruction set, as in simd/kernel_tables.cpp.
namespace scalar_stages {
extern const bench::StageTable stage_table;
}
#if defined(FASTCCD_HAVE_X86)
namespace sse2_stages {
extern const bench::StageTable stage_table;
}
#endif
#if defined(FASTCCD_HAVE_AVX2)
namespace avx2_stages {
extern const bench::StageTable stage_table;
}
#endif
#if defined(FASTCCD_HAVE_AVX512)
namespace avx512_stages {
extern const bench::StageTable stage_table;
}
#endif
#if defined(FASTCCD_HAVE_NEON)
namespace neon_stages {
extern const bench::StageTable stage_table;
}
#endif

}  // namespace fastccd

namespace fastccd::bench {

namespace {

constexpr double tolerance = 1e-9;

const StageTable* const tables[] = {
    &scalar_stages::stage_table,
#if defined(FASTCCD_HAVE_X86)
    &sse2_stages::stage_table,
#endif
#if defined(FASTCCD_HAVE_AVX2)
    &avx2_stages::stage_table,
#endif
#if defined(FASTCCD_HAVE_AVX512)
    &avx512_stages::stage_table,
#endif
#if defined(FASTCCD_HAVE_NEON)
    &neon_stages::stage_table,
#endif
};

/// Consecutive benchmarks of one data set and kind share their input.
const StageData& stage_data(const std::string& data, PairKind kind)
{
    static std::unique_ptr<StageData> latest;
    static std::string latest_data;
    if (!latest || latest_data != data || latest->input().kind != kind) {
        latest = std::make_unique<StageData>(kind, dataset(data, kind).packed, SearchParameters{tolerance, 1.0, false});
        latest_data = data;
    }
    return *latest;
}

/// Times calls of run(), each over `entries` entries of which it returns how many go on.
template <class Run>
void time_stage(benchmark::State& state, std::size_t entries, Run run)
{
    unsigned kept = 0;
    for ([[maybe_unused]] auto _ : state) {
        kept = run();
        benchmark::DoNotOptimize(kept);
    }
    using benchmark::Counter;
    state.counters["s/pair"] = Counter(static_cast<double>(entries),
                                       static_cast<Counter::Flags>(Counter::kIsIterationInvariantRate | Counter::kInvert));
    state.counters["kept"] = static_cast<double>(kept) / static_cast<double>(entries);
}

void run_stage(benchmark::State& state, const Stage& stage, const std::string& data, PairKind kind)
{
    const StageInput input = stage_data(data, kind).input();
    const std::size_t entries = stage.takes_blocks ? input.pairs : stage_queues * PairQueue::drain_at;
    time_stage(state, entries, [&] { return stage.run(input); });
}

void register_benchmarks(bool)
{
    const auto add = [](PairKind kind, const std::string& isa, const std::string& stage, const std::string& data, auto run) {
        const std::string full_name = std::string("stage/").append(name(kind)) + "/" + isa + "/" + stage + "/" + data;
        benchmark::RegisterBenchmark(full_name.c_str(), [=](benchmark::State& state) { run(state, data, kind); })
            ->Unit(benchmark::kMicrosecond);
    };
    const auto add_table = [&](PairKind kind, const std::string& data, const StageTable& table) {
        if (!isa_available(table.isa)) return;
        for (const Stage& stage : table.stages)
            add(kind, fastccd::name(table.isa), stage.name, data,
                [stage](benchmark::State& state, const std::string& d, PairKind k) { run_stage(state, stage, d, k); });
    };
    // What a stage costs depends little on the scene, what it keeps does: public ones on the widest instruction set alone. None of
    // "grids", whose contacts at sides and ends are decided after all stages.
    for (const PairKind kind : {PairKind::vertex_face, PairKind::edge_edge})
        for (const std::string& data : available_datasets())
            for (const StageTable* table : tables)
                if (data == "random" || data == "generated" || (data != "grids" && table->isa == available_isas().back()))
                    add_table(kind, data, *table);
    register_search_benchmarks();
}

}  // namespace

}  // namespace fastccd::bench

int main(int argc, char** argv) { return fastccd::bench::run_benchmarks(argc, argv, fastccd::bench::register_benchmarks); }
