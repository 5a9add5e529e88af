// The exact verdict on one pair, in rational arithmetic: for the few pairs in which rounding leaves contact possible
// but not proven.
#pragma once

#include <fastccd/options.hpp>
#include <search_parameters.hpp>

namespace fastccd::scalar {

/// Whether this build has it (it needs GMP).
bool exact_contact_available() noexcept;

struct ExactContact {
    bool contact;
    double leaf_start;  ///< Parameter s: left end of the leaf that holds the first time of contact; 1 if that is at s = 1.
};

/// `coordinates`: 24 finite ones, in the order of PairView. Tens of microseconds. May throw std::bad_alloc.
ExactContact exact_contact(PairKind kind, const double* coordinates, const SearchParameters& parameters);

}  // namespace fastccd::scalar
