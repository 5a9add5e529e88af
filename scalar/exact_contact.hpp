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
    /// Parameter s, not after the first time of contact: the left end of the leaf that holds it (1 if it is 1), and in the first
    /// leaf, for a pair that is apart at the start, the largest power of two that is (0 below 2^-1074).
    double lower_bound;
};

/// `coordinates`: 24 finite ones, in the order of PairView. Takes what Options::exact says. May throw std::bad_alloc.
ExactContact exact_contact(PairKind kind, const double* coordinates, const SearchParameters& parameters);

}  // namespace fastccd::scalar
