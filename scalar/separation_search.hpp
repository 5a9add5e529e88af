// The search for the first time at which one pair comes within a distance: the reference for Options::minimum_separation.
#pragma once

#include <certified_search.hpp>

namespace fastccd::scalar {

/// First time at which the pair's distance is not certainly above parameters.separation.distance > 0. 0: at the start
/// already. Proof::leaf: it certainly comes that close at or after that time. `intervals` counts looks. A pair that
/// stays farther until after `limit`, in units of t_max, may be reported as farther throughout.
/// `coordinates`: 24, in the order of PairView.
SearchResult separation_search(PairKind kind, const double* coordinates, const SearchParameters& parameters,
                               double limit = 1.0);

}  // namespace fastccd::scalar
