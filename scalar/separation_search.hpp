// The search for the first time at which one pair comes within a distance: the reference for Options::minimum_separation.
#pragma once

#include <certified_search.hpp>
#include <pair_coefficients.hpp>
#include <separation_steps.hpp>

namespace fastccd::scalar {

/// First time at which the pair's distance is not certainly above parameters.separation.distance > 0. 0: at the start
/// already. Proof::leaf: it certainly comes that close at or after that time. `intervals` counts looks. A pair that
/// stays farther until after `limit`, in units of t_max, may be reported as farther throughout.
/// `coordinates`: 24, in the order of PairView.
SearchResult separation_search(PairKind kind, const double* coordinates, const SearchParameters& parameters,
                               double limit = 1.0);

/// The same without any distance, for a pair that is certainly apart before `time`: the first time from there on at which it is not,
/// or at which it is that close that computed positions cannot tell, 2^8 u of the sum of the extents, axes scaled so that these are
/// alike; after n looks, 2^(n / 16) times that, up to 2^17 times; +infinity if there is none. Times in units of t_max; `intervals` counts
/// looks. After `most` of them, if that is fewer than the most_looks that there are at most, a time until which it is apart.
SearchResult apart_until(const PairCoefficients& pair, const SearchParameters& parameters, double time,
                         unsigned most = static_cast<unsigned>(FASTCCD_KERNEL_NAMESPACE::most_looks));

}  // namespace fastccd::scalar
