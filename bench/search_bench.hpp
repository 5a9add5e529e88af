// Benchmarks of the certified search.
#pragma once

namespace fastccd::bench {

/// Registers all of them.
void register_search_benchmarks();

}  // namespace fastccd::bench
