// How fast the machine can merely read the pairs: the roof over everything that streams them.
#pragma once

#include <cstddef>
#include <map>

#include <tbb/task_arena.h>

#include "layouts.hpp"

namespace fastccd::bench {

/// Reads the very buffer that a benchmark answers, in its layout, in tiles of the size that the library
/// cuts, on the threads of an arena, with software prefetch at the best of several distances. All that is done
/// with the data is to add it up in integers, which takes fewer instructions than any use of it.
class StreamingLimit {
public:
    explicit StreamingLimit(const Streams& streams) : streams_{streams} {}

    /// Seconds of one pass. The first pass on an arena of a new size finds the best distance.
    [[nodiscard]] double pass(tbb::task_arena& arena);

    /// Bytes of one pass.
    [[nodiscard]] std::size_t bytes() const noexcept { return streams_.count * streams_.bytes; }

private:
    [[nodiscard]] double pass(tbb::task_arena& arena, std::size_t distance) const;

    Streams streams_;
    std::map<int, std::size_t> best_distance_;  ///< In lines of each array, per number of threads.
};

}  // namespace fastccd::bench
