// How fast the machine can merely read the pairs: the roof over everything that streams them.
#pragma once

#include <cstddef>
#include <map>

#include <tbb/task_arena.h>

#include "layouts.hpp"

namespace fastccd::bench {

/// Reads the very buffer that a benchmark answers, in its layout, in tiles of the size that the library
/// cuts, on the threads of an arena, with software prefetch at the best of several distances and into the better of two
/// caches. All that is done with the data is to add it up in integers, which takes fewer instructions than any use of it.
class StreamingLimit {
public:
    struct Prefetch {
        std::size_t distance = 0;        ///< In lines of each array; 0: none.
        bool into_second_level = false;  ///< Or into the first-level cache.
    };

    explicit StreamingLimit(const Streams& streams) : streams_{streams} {}

    /// Seconds of one pass. The first pass on an arena of a new size finds the best prefetch.
    [[nodiscard]] double pass(tbb::task_arena& arena);

    /// Bytes of one pass.
    [[nodiscard]] std::size_t bytes() const noexcept { return streams_.count * streams_.bytes; }

private:
    [[nodiscard]] double pass(tbb::task_arena& arena, Prefetch prefetch) const;

    Streams streams_;
    std::map<int, Prefetch> best_;  ///< Per number of threads.
};

}  // namespace fastccd::bench
