// The certified search for the first time of contact of one pair: the reference for everything.
#pragma once

#include <cstdint>

#include <fastccd/options.hpp>
#include <pair_coefficients.hpp>
#include <search_parameters.hpp>

namespace fastccd::scalar {

/// Cap on the intervals halved for one pair, far above what any pair of the public data needs. On reaching it those still waiting, some
/// hundred at most, are examined once. One without a certificate that is wider than a leaf gets `extension` more, and so do
/// `most_extensions` of them; a leaf, or the first after those, is the answer: contact, with the lower bound reached. So one pair takes at
/// most 4,096 + 16 * 64 intervals and what waits, and before a leaf is halved the certificates of one look at it (touching.hpp), some eight
/// times what an interval takes, which are not counted, nor are four looks along directions (meeting_along_directions.hpp). Other looks along
/// directions on the way count as intervals, `most_looks_to_skip` each time, below the cap, so that they may pass it by as many; those at the
/// end do not count, at most 4,098. Counting roots has 4,096 for itself, and no number if they are used up.
inline constexpr unsigned most_intervals = 4096, extension = 64, most_extensions = 16, most_looks_to_skip = 256;

/// What is certain about a contact that is reported.
enum class Proof : std::uint8_t {
    none,    ///< Contact is not excluded, to within rounding.
    nearby,  ///< There is contact in a wider interval around toi than a leaf.
    leaf,    ///< There is contact in the leaf that toi lies in; with a minimum separation, the pair comes as close soon after toi.
};

struct SearchResult {
    double toi = 0.0;             ///< In [0, t_max]; +infinity: certainly apart; NaN: invalid coordinates.
    Proof proof = Proof::none;    ///< If there is contact.
    std::uint8_t roots = 0;       ///< Contact roots, if asked for; 0 if there is no contact or they cannot be counted.
    unsigned intervals = 0;       ///< Examined on the way, for benchmarks and tests,
    unsigned root_intervals = 0;  ///< and to count roots.
};

/// `coordinates`: 24, in the order of PairView. `lanes`: with a kernel for several intervals the same result, sooner. `most`: the cap on intervals;
/// hardly any pair comes to the ordinary one, so tests set others.
SearchResult certified_search(PairKind kind, const double* coordinates, const SearchParameters& parameters,
                              const IntervalKernel* lanes = nullptr, unsigned most = most_intervals);

}  // namespace fastccd::scalar
