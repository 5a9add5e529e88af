// Tiles in parallel, in the caller's oneTBB arena.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

#include <tbb/cache_aligned_allocator.h>
#include <tbb/combinable.h>

#include <parallel_ranges.hpp>
#include <tile_runner.hpp>

namespace fastccd {

/// Memory of one worker during one call: under 512 KiB, whatever the number of pairs.
struct TileWorker {
    TileScratch scratch;
    Summary totals;

    /// What else kernels read before they write it, past the end of queues and results, decides nothing.
    TileWorker()
    {
        scratch.cleared = 0;
        scratch.dense = false;
    }
};
static_assert(sizeof(TileWorker) < 512 * 1024);

/// One worker per thread, made when it is first asked for. oneTBB clears what it holds for a thread, which for the scratch would
/// take as long as a hundred pairs; so it holds a pointer.
template <class Worker>
class Workers {
public:
    Worker& local()
    {
        Owner& owner = owners_.local();
        if (owner == nullptr) owner.reset(::new (Memory{}.allocate(1)) Worker);
        return *owner;
    }

    template <class Visit>
    void combine_each(Visit visit)
    {
        owners_.combine_each([&](const Owner& owner) {
            if (owner != nullptr) visit(*owner);
        });
    }

private:
    using Memory = tbb::cache_aligned_allocator<Worker>;
    struct Release {
        void operator()(Worker* worker) const
        {
            worker->~Worker();
            Memory{}.deallocate(worker, 1);
        }
    };
    using Owner = std::unique_ptr<Worker, Release>;

    tbb::combinable<Owner> owners_;
};

/// Few pairs are cut into smaller tiles, so that every thread gets its share of them. The longer a pair may take, the smaller: of a thousand
/// exact verdicts, one tile would keep one thread busy for a tenth of a second while the others wait.
inline std::size_t pairs_per_tile(const Job& job)
{
    constexpr std::size_t least_tiles = 16, factor = 4;
    static_assert(tile_pairs == factor * factor * factor * group_pairs);
    const std::size_t size = job.source.size;
    std::size_t least = tile_pairs / factor;
    if (job.exact || job.kernels == nullptr)
        least = group_pairs;  // one pair at a time
    else if (job.parameters.separation.distance > 0.0)
        least = size < tile_pairs / factor ? group_pairs : factor * group_pairs;  // looks in lanes, of which each tile leaves some empty at its end
    std::size_t pairs = tile_pairs;
    while (pairs > least && size < least_tiles * pairs) pairs /= factor;
    return pairs;
}

/// Runs every tile of the job up to a cutoff, cutoff(first) (see TileRequest; negative: the tile is left out), and
/// calls consume(worker, first, count) after each, on the worker's thread.
/// Tiles do not depend on the number of threads. One tile runs on the caller's thread without a task.
template <class Worker, class Cutoff, class Consume>
Summary for_each_tile(const Job& job, Workers<Worker>& workers, Cutoff cutoff, Consume consume)
{
    const std::size_t size = job.source.size;
    const std::size_t most = pairs_per_tile(job), tiles = (size + most - 1) / most;
    const auto run = [&](std::size_t tile, Worker& worker) {
        const std::size_t first = tile * most;
        const std::size_t count = std::min(most, size - first);
        const double until = cutoff(first);
        if (until < 0.0) return;
        run_tile(job, first, count, until, worker.scratch, worker.totals);
        consume(worker, first, count);
    };
    for_each_range(tiles, 1, [&](const Range& range) {
        Worker& worker = workers.local();
        for (std::size_t tile = range.begin(); tile != range.end(); ++tile) run(tile, worker);
    });
    Summary summary;
    summary.pairs = size;
    summary.isa = job.kernels != nullptr ? job.kernels->isa : Isa::scalar;
    workers.combine_each([&](const Worker& worker) { summary.add(worker.totals); });
    return summary;
}

/// The cutoff of a dense answer.
inline double whole_interval(std::size_t) { return 1.0; }

}  // namespace fastccd
