// Benchmarks of the public query sets.
#pragma once

namespace fastccd::bench {

/// Registers all of them, as far as the folder of public data has them (datasets.hpp).
void register_query_benchmarks();

}  // namespace fastccd::bench
