// The stages of the pipeline, one by one, as each instruction set exports them. Plain data only: this header is
// included by translation units compiled for different instruction sets.
#pragma once

#include <cstddef>

#include <fastccd/options.hpp>
#include <kernel_table.hpp>
#include <search_parameters.hpp>

namespace fastccd::bench {

/// Queues of one input: 512 entries, 150 to 180 KB, within the L2 cache.
inline constexpr unsigned stage_queues = 8;

/// Packed pairs: 192 KiB.
inline constexpr unsigned stage_pairs = 1024;

/// What the stages take. Queues hold PairQueue::drain_at entries each, as they do when the pipeline empties them.
struct StageInput {
    PairKind kind;
    const SearchParameters* parameters;
    const double* blocks;         ///< `pairs` packed pairs, a multiple of 8.
    std::size_t pairs;
    const PairQueue* candidates;  ///< Pairs that no certificate dismisses.
    const RootQueue* roots;       ///< Pieces with a sign change of their cubic; in `pair`, which no stage asks for, the guess after the first steps.
};

/// Runs over all entries of its input once; returns how many of them go on to the next stage.
using StageFunction = unsigned (*)(const StageInput&);

struct Stage {
    const char* name;
    StageFunction run;
    bool takes_blocks;  ///< Input is `blocks`; else the queues.
};

inline constexpr unsigned stage_count = 8;

struct StageTable {
    Isa isa;
    Stage stages[stage_count];
};

}  // namespace fastccd::bench
