// The handcrafted queries of the NYU benchmark, file by file: `queries/edge_edge/avx2/unit-tests/data_0_1`. Few pairs each, many of them
// degenerate: what a pair takes where hardly any is ordinary. In cache, one thread, in one call for each file.
#include "query_bench.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <fastccd/fastccd.hpp>
#include <rational_csv.hpp>
#include <test_data.hpp>

#include "bench_main.hpp"
#include "bench_table.hpp"
#include "datasets.hpp"

namespace fastccd::bench {

namespace {

namespace fs = std::filesystem;

/// A file of queries/SET/KIND/, which is not read before it is asked about.
struct QueryFile {
    fs::path path;
    std::string set;  ///< Its set and its own name, without the ending.
    PairKind kind;
};

std::vector<QueryFile> query_files()
{
    std::vector<QueryFile> files;
    const auto data = testing::data_directory();
    if (!data || !fs::is_directory(*data / "queries")) return files;
    for (const auto& entry : fs::recursive_directory_iterator(*data / "queries")) {
        const fs::path& path = entry.path();
        if (path.extension() != ".csv") continue;
        const fs::path folder = path.parent_path();
        const bool is_vertex_face = folder.filename() == "vertex-face";
        if (!is_vertex_face && folder.filename() != "edge-edge") continue;
        files.push_back({path, (folder.parent_path().filename() / path.stem()).string(),
                         is_vertex_face ? PairKind::vertex_face : PairKind::edge_edge});
    }
    std::ranges::sort(files, {}, &QueryFile::path);
    return files;
}

void run_queries(benchmark::State& state, const QueryFile& file, Isa isa)
{
    const PairBuffer pairs = tools::read_rational_csv(file.path, tools::Rounding::exact_only).pairs;
    std::vector<double> toi(pairs.size());
    Options options;
    options.isa = isa;
    tbb::task_arena arena(1);
    Status status;
    Summary summary;
    arena.execute([&] {
        for ([[maybe_unused]] auto _ : state) {
            summary = {};
            status = time_of_impact(file.kind, pairs.view(), options, toi, &summary);
        }
    });
    if (!status.ok()) return fail(state, message(status.error));

    using benchmark::Counter;
    const auto count = static_cast<double>(pairs.size());
    state.counters["s/pair"] = Counter(count, static_cast<Counter::Flags>(Counter::kIsIterationInvariantRate | Counter::kInvert));
    state.counters["pairs"] = count;
    state.counters["contacts"] = static_cast<double>(summary.contacts);
    state.counters["scalar_share"] = static_cast<double>(summary.scalar_pairs) / count;
}

}  // namespace

void register_query_benchmarks()
{
    for (const QueryFile& file : query_files())
        for (const Isa isa : available_isas()) {
            const std::string full_name = std::string("queries/").append(name(file.kind)) + "/" + fastccd::name(isa) + "/" + file.set;
            benchmark::RegisterBenchmark(full_name.c_str(), [=](benchmark::State& state) { run_queries(state, file, isa); })
                ->Unit(benchmark::kMicrosecond);
        }
}

}  // namespace fastccd::bench
