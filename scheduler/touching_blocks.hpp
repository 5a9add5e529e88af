// Pairs of a tile that may touch, after the lanes and before the certified search.
#pragma once

#include <cstddef>

#include <tile_runner.hpp>

namespace fastccd {

/// Of the pairs that the lanes noted in `may_touch` and have not left undecided: those of which lanes can tell what the search says are
/// reported, at the parameter s, or not; the others are left undecided. So are all where an exact verdict is asked for. (Where roots
/// are counted, lanes note none.)
void decide_touching(const Job& job, std::size_t first, std::size_t count, TileScratch& scratch);

}  // namespace fastccd
