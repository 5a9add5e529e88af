// One tile from input to results: the lanes, then the certified search for what they left undecided.
#pragma once

#include <cstddef>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>
#include <kernel_table.hpp>

namespace fastccd {

/// One validated call.
struct Job {
    PairKind kind;
    PairSource source;
    SearchParameters parameters;
    const KernelTable* kernels;  ///< Null: the certified search alone.
};

/// Checks options and chooses the kernels. On error the job must not be run.
Status prepare(PairKind kind, const PairSource& source, const Options& options, bool count_roots, Job& job);

/// Results of one tile.
struct TileResult {
    double toi[tile_pairs];
    std::uint8_t roots[tile_pairs];
};

/// Answers `count` <= tile_pairs pairs from `first` (a multiple of tile_pairs) on; adds to `totals`
/// everything but `pairs`. With cutoff < 1, pairs whose toi is greater than cutoff t_max may be left out.
void run_tile(const Job& job, std::size_t first, std::size_t count, double cutoff, TileScratch& scratch,
              TileResult& result, Summary& totals);

/// Adds the totals of a part to those of the whole.
void add(Summary& whole, const Summary& part);

}  // namespace fastccd
