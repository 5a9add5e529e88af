// Other libraries on the same pairs, one thread each, for scale: speed, and how many contacts they miss or invent
// against this library's verdict. `peer/vertex_face/fcl-cubic/random`.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <fastccd/fastccd.hpp>
#include <peers/peers.hpp>

#include "bench_main.hpp"
#include "bench_table.hpp"
#include "datasets.hpp"

namespace fastccd::bench {

namespace {

using peers::NamedPeer, peers::Peer;

/// Larger sets are thinned out evenly to about this.
constexpr std::size_t sampled_pairs = 400'000;
/// Pairs that a peer gets at a time: small enough for its structures, up to 2 KB a pair, to stay in cache.
constexpr std::size_t batch_pairs = 128;

/// Pairs of one data set, and whether each is in contact.
struct Sample {
    std::string data;
    PairKind kind;
    std::vector<double> coordinates;  ///< 24 a pair.
    std::vector<double> toi;

    [[nodiscard]] std::size_t size() const { return toi.size(); }
    [[nodiscard]] PairView view() const { return PairView::interleaved(coordinates.data(), size()); }
};

const Sample& sample(const std::string& data, PairKind kind)
{
    static std::unique_ptr<Sample> latest;
    if (latest && latest->data == data && latest->kind == kind) return *latest;
    const Dataset& set = dataset(data, kind);
    latest = std::make_unique<Sample>(Sample{data, kind, {}, {}});
    const std::size_t step = std::max<std::size_t>(set.packed.size() / sampled_pairs, 1);
    for (std::size_t i = 0; i < set.packed.size(); i += step)
        for (std::size_t c = 0; c < pair_coordinates; ++c) latest->coordinates.push_back(set.packed.at(i, c));
    latest->toi.resize(latest->coordinates.size() / pair_coordinates);
    if (const Status status = time_of_impact(kind, latest->view(), {}, latest->toi); !status.ok())
        throw std::runtime_error(message(status.error));
    return *latest;
}

void report(benchmark::State& state, std::size_t pairs)
{
    state.counters["pairs"] = static_cast<double>(pairs);
    state.counters["pairs/s"] =
        benchmark::Counter(static_cast<double>(pairs), benchmark::Counter::kIsIterationInvariantRate);
}

void run_peer(benchmark::State& state, const NamedPeer& named, const std::string& data)
{
    using clock = std::chrono::steady_clock;
    const Sample& pairs = sample(data, named.kind);
    const std::unique_ptr<Peer> peer = named.make();
    std::size_t contacts = 0, missed = 0, extra = 0;
    for ([[maybe_unused]] auto _ : state) {
        contacts = missed = extra = 0;
        clock::duration elapsed{};
        for (std::size_t first = 0; first < pairs.size(); first += batch_pairs) {
            const std::size_t count = std::min(batch_pairs, pairs.size() - first);
            std::array<double, batch_pairs> toi{};
            peer->prepare(&pairs.coordinates[first * pair_coordinates], count);
            const auto begin = clock::now();
            peer->run(toi.data());
            elapsed += clock::now() - begin;
            for (std::size_t i = 0; i < count; ++i) {
                const bool ours = pairs.toi[first + i] <= 1.0;
                const bool theirs = !std::isinf(toi[i]);  // NaN: contact, at a time not told
                contacts += theirs;
                missed += ours && !theirs;
                extra += theirs && !ours;
            }
        }
        state.SetIterationTime(std::chrono::duration<double>(elapsed).count());
    }
    report(state, pairs.size());
    state.counters["contacts"] = static_cast<double>(contacts);
    state.counters["missed"] = static_cast<double>(missed);
    state.counters["extra"] = static_cast<double>(extra);
}

/// This library on the sample, from interleaved records, which is how the peers' pairs lie: one thread.
void run_fastccd(benchmark::State& state, const std::string& data, PairKind kind)
{
    const Sample& pairs = sample(data, kind);
    std::vector<double> toi(pairs.size());
    tbb::task_arena arena(1);
    Summary summary;
    for ([[maybe_unused]] auto _ : state) {
        const auto begin = std::chrono::steady_clock::now();
        arena.execute([&] { (void)time_of_impact(kind, pairs.view(), {}, toi, &summary); });
        state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    report(state, pairs.size());
    state.counters["contacts"] = static_cast<double>(summary.contacts);
}

void register_benchmarks(bool)
{
    std::vector<NamedPeer> all = peers::fcl_peers();
    for (NamedPeer& peer : peers::bullet_peers()) all.push_back(peer);
    const auto add = [](PairKind kind, const std::string& peer, const std::string& data, auto run) {
        const std::string full_name = std::string("peer/").append(name(kind)) + "/" + peer + "/" + data;
        benchmark::RegisterBenchmark(full_name.c_str(), run)->UseManualTime()->Unit(benchmark::kMillisecond);
    };
    for (const PairKind kind : {PairKind::vertex_face, PairKind::edge_edge})
        for (const std::string& data : available_datasets()) {
            if (data != "random" && data != "generated" && data != "cloth-ball") continue;
            add(kind, std::string("fastccd-") + fastccd::name(best_isa()), data,
                [=](benchmark::State& state) { run_fastccd(state, data, kind); });
            for (const NamedPeer& peer : all)
                if (peer.kind == kind)
                    add(kind, peer.name, data, [=](benchmark::State& state) { run_peer(state, peer, data); });
        }
}

}  // namespace

}  // namespace fastccd::bench

int main(int argc, char** argv) { return fastccd::bench::run_benchmarks(argc, argv, fastccd::bench::register_benchmarks); }
