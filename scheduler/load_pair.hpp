// One pair out of whatever holds the pairs of a call.
#pragma once

#include <cstddef>

#include <fastccd/options.hpp>
#include <pair_source.hpp>

namespace fastccd {

/// The 24 coordinates of pair i, in the order of PairView, number c to coordinates[c * stride].
void load_pair(PairKind kind, const PairSource& source, std::size_t i, double* coordinates, std::size_t stride = 1);

}  // namespace fastccd
