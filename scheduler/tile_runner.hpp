// One tile from input to results: the lanes, then touching pairs, then the certified search for what is left undecided.
#pragma once

#include <bit>
#include <cstddef>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>
#include <certified_search.hpp>
#include <kernel_table.hpp>

namespace fastccd {

/// One validated call.
struct Job {
    PairKind kind;
    PairSource source;
    SearchParameters parameters;
    const KernelTable* kernels;  ///< Null: the certified search alone.
    bool exact;                  ///< Settle unproven contacts by rational arithmetic.
};

/// Checks options and chooses the kernels. On error the job must not be run.
Status prepare(PairKind kind, const PairSource& source, const Options& options, bool count_roots, Job& job);

/// Answers one pair, of 24 coordinates in the order of PairView, by the scalar search. `cutoff`: see run_tile.
scalar::SearchResult answer_pair(const Job& job, const double* coordinates, double cutoff);

/// Answers `count` <= tile_pairs pairs from `first` (a multiple of group_pairs) on, into time, roots and reported of
/// the scratch; adds to `totals` everything but `pairs`. With cutoff < 1, pairs whose toi is greater than
/// cutoff t_max may be left out.
void run_tile(const Job& job, std::size_t first, std::size_t count, double cutoff, TileScratch& scratch, Summary& totals);

/// Calls visit(i) for each set bit of a tile of `count` pairs, in order.
template <class Visit>
void for_each_bit(const std::uint64_t (&words)[tile_pairs / 64], std::size_t count, Visit visit)
{
    for (std::size_t w = 0; w < (count + 63) / 64; ++w)
        for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1)
            visit(64 * w + static_cast<std::size_t>(std::countr_zero(bits)));
}

/// How many bits are set in the words of a tile of `count` pairs.
inline std::size_t count_bits(const std::uint64_t (&words)[tile_pairs / 64], std::size_t count)
{
    std::size_t bits = 0;
    for (std::size_t w = 0; w < (count + 63) / 64; ++w) bits += static_cast<std::size_t>(std::popcount(words[w]));
    return bits;
}

/// Pair `i` of a tile that starts at `first`, which the tile reports in contact.
inline Contact contact_of(const Job& job, const TileScratch& scratch, std::size_t first, std::size_t i)
{
    const double toi = scratch.time[i];
    return {first + i, toi, !is_set(scratch.is_unproven, i), job.parameters.separation.distance > 0.0 && toi == 0.0};
}

}  // namespace fastccd
