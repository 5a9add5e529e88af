// What the kernels of one instruction set export, and the memory they work in. Plain data only: this
// header is included by translation units compiled for different instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>
#include <pair_coefficients.hpp>
#include <pair_source.hpp>
#include <search_parameters.hpp>

namespace fastccd {

/// Pairs per tile, the unit of results, at most. At the end of a tile the queues run empty, in batches that are not full; so
/// tiles are large, but their times (32 KiB) with the queues are to stay in the L2 cache. A multiple of group_pairs.
inline constexpr std::size_t tile_pairs = 4096;

/// A queue of pairs or roots between two stages, structure of arrays: one row per field.
template <unsigned field_count>
struct LaneQueue {
    static constexpr unsigned fields = field_count;
    /// A stage drains the queue when it holds this many entries ...
    static constexpr unsigned drain_at = 64;
    /// ... and between two such checks, a batch of screening adds at most two batches of doubles. Storing the last ones, or reading them,
    /// touches a full batch.
    static constexpr unsigned most_added = 2 * most_lanes;
    static constexpr unsigned capacity = drain_at + most_added;

    alignas(64) double data[fields][capacity];
    unsigned size;
};
/// Fields: see PairRecord in simd/records.hpp.
using PairQueue = LaneQueue<19>;
using RootQueue = LaneQueue<21>;
/// Pairs that screening leaves: where the first of their coordinates lies, by its layout the others (simd/packed_pairs.hpp), and their numbers.
struct ScreenedQueue {
    static constexpr unsigned capacity = LaneQueue<1>::capacity;

    const void* pairs[capacity];
    alignas(64) double numbers[capacity];
    unsigned size;
};
/// With a minimum separation: fields of SeparationRecord after its first look.
struct AdvancingQueue : LaneQueue<35> {};

/// What the search for roots works on, next to the rows of `candidates`.
struct RootSearch {
    alignas(64) double scale[4][PairQueue::capacity];  ///< Scales, in their order.
    alignas(64) double f[4][PairQueue::capacity];  ///< The cubic in the power basis.
    alignas(64) double threshold[PairQueue::capacity];
    alignas(64) double low[PairQueue::capacity], high[PairQueue::capacity];  ///< The piece in which the cubic changes sign.
    alignas(64) double guess[PairQueue::capacity];
    alignas(64) double later_low[PairQueue::capacity], later_high[PairQueue::capacity];  ///< The piece after that.
    alignas(64) double end[PairQueue::capacity];  ///< Of the last piece.
    /// Per batch, bits of the lanes that have a first, second, third such piece.
    unsigned pieces[3][PairQueue::capacity];
};

/// Pairs that are screened before any of them goes on. Their blocks, 12 KiB, are then still in the first-level cache.
inline constexpr std::size_t group_pairs = 64;
/// A batch may wait in [screened] when the next group is listed, eight at a time.
static_assert(group_pairs + most_lanes + 8 <= ScreenedQueue::capacity && tile_pairs % group_pairs == 0);

/// Copies of packed pairs that cannot be read in place.
template <class Number>
struct CopiedPairs {
    /// Strided pairs of a group, in blocks of the native layout.
    alignas(64) Number group[group_pairs / block_pairs * block_coordinates];
    /// Strided pairs that wait in `screened` while the next group takes their place; or the interleaved ones past the last whole block of a tile.
    alignas(64) Number block[block_coordinates];
};

/// What refinement works on, next to the rows of `slow`.
struct Refinement {
    alignas(64) double f[4][RootQueue::capacity];
    alignas(64) double low[RootQueue::capacity], high[RootQueue::capacity];  ///< A bracket that closes around the root.
    alignas(64) double slope[RootQueue::capacity];                           ///< Positive where f rises over the piece.
    alignas(64) double guess[RootQueue::capacity];
};

/// Of pairs new in `advancing`: ClosingPlanes, and the times that guesses have come to.
struct ContactGuesses {
    alignas(64) double f[4][AdvancingQueue::capacity], n[9][AdvancingQueue::capacity], aim[AdvancingQueue::capacity];
    alignas(64) double time[AdvancingQueue::capacity];
};

/// What the last looks at the pairs of `advancing` showed: a Separation.
struct Looks {
    alignas(64) double n[3][AdvancingQueue::capacity], gap[AdvancingQueue::capacity], square_to_side[AdvancingQueue::capacity];
    unsigned open[AdvancingQueue::capacity];  ///< First pairs of the batches in which that of one is not all that its features can show.
};

/// Blocks of indexed pairs whose vertices are asked for before they are read.
inline constexpr std::size_t indexed_ahead = 2;
/// Blocks of which the vertex records are known at a time: those of a group and the ones ahead.
inline constexpr std::size_t record_blocks = 16;
static_assert(record_blocks >= group_pairs / block_pairs + indexed_ahead);
/// Pairs whose boxes are asked for before they are read.
inline constexpr std::size_t boxes_ahead = 32;

// Bits of a tile's pairs, in words of 64.
FASTCCD_INLINE bool is_set(const std::uint64_t* words, std::size_t i) { return (words[i / 64] >> i % 64 & 1) != 0; }
FASTCCD_INLINE void set_bit(std::uint64_t* words, std::size_t i) { words[i / 64] |= std::uint64_t{1} << i % 64; }
FASTCCD_INLINE void clear_bit(std::uint64_t* words, std::size_t i) { words[i / 64] &= ~(std::uint64_t{1} << i % 64); }

/// Results of one tile and scratch for it; one per thread, reused.
struct TileScratch {
    /// First time of contact: from the lanes the parameter s, in the end toi; +infinity if there is none. Here and in `roots`, lanes
    /// without a contact write past the last pair.
    alignas(64) double time[tile_pairs + most_lanes];
    std::size_t cleared;  ///< So many times are known, +infinity but for those of words in `reported` that are not 0. 0 to begin with.
    std::uint8_t roots[tile_pairs + most_lanes];  ///< Contact roots.
    std::uint64_t reported[tile_pairs / 64];   ///< Bit i: pair i has a time that is not +infinity. So that nothing
                                               ///< but contacts and undecided pairs is looked at one by one.
    std::uint64_t is_undecided[tile_pairs / 64];
    /// Bit i: pair i may be in contact in the leaf that starts at touch_time[i] or in the next one, neither proven nor disproved by the
    /// lanes. In leaves before it is apart, unless a contact proven there is recorded or is_undecided is set. touch_time[i] = 0: in any leaf.
    std::uint64_t may_touch[tile_pairs / 64];
    double touch_time[tile_pairs];
    double earliest;                           ///< From the lanes: none of their times is before this.
    std::uint64_t is_unproven[tile_pairs / 64];  ///< Contact is possible, not proven. Without a minimum separation KernelTable::run_tile sets none.
    ScreenedQueue screened;  ///< Pairs without a linear or cubic certificate.
    PairQueue candidates;    ///< Pairs without certificates on both halves either.
    bool dense;              ///< Screening left most pairs of the group before.
    RootSearch search;
    RootQueue slow;          ///< Roots that few steps do not decide, and those after a pair's first.
    Refinement refinement;
    AdvancingQueue advancing;  ///< With a minimum separation: candidates that the first look does not settle.
    ContactGuesses guesses;
    Looks looks;
    CopiedPairs<double> copied;
    CopiedPairs<float> copied_floats;
    /// Indexed pairs that their boxes do not keep apart, by their number in the tile; the last one again for the blocks after.
    std::uint16_t listed[tile_pairs + (indexed_ahead + 1) * block_pairs];
    alignas(64) double numbers[group_pairs];                   ///< Those of the blocks of a group, as lanes know them.
    const double* records[record_blocks][4][block_pairs];      ///< Vertex records of indexed pairs, a ring of blocks,
    const double* collected_records[4][block_pairs];           ///< and those of a batch of pairs from anywhere.
};

enum class CacheLevel : std::uint8_t { first, second };

/// Ways to go about a tile of which some processors are faster with one, some with the other. No result depends on them.
struct Preferences {
    CacheLevel into = CacheLevel::first;  ///< The cache into which packed pairs are asked for before they are read.
    bool scenes_in_double = false;        ///< Screens in double where few pairs go on, if lanes have the choice; else in single precision.
};

/// Those of this machine's processor.
Preferences preferences() noexcept;

/// `count` pairs of the source from `first` on; first is a multiple of group_pairs, count at most tile_pairs.
struct TileRequest {
    PairKind kind;
    const PairSource* source;
    std::size_t first;
    std::size_t count;
    const SearchParameters* parameters;
    /// Pairs whose toi is certainly greater than cutoff t_max may be reported as apart; 1: none.
    double cutoff;
    Preferences preferences = {};
};

/// The searched parameter s beyond which times are certainly greater than cutoff t_max, rounding of cutoff (one
/// quotient) and of SearchParameters::time included.
[[nodiscard]] FASTCCD_INLINE constexpr double time_limit(double cutoff) { return cutoff < 1.0 ? cutoff * (1.0 + 0x1p-49) : 1.0; }

/// What the certified search reports of the pairs of a block, as far as lanes can tell: of others none of the bits is set.
struct TouchAnswers {
    /// Asked: where the leaf starts, not the step's first, such that the search finds the pair apart before it.
    alignas(64) double left[block_pairs];
    alignas(64) double time[block_pairs];  ///< Answered, of the pairs reported.
    unsigned reported, proven;             ///< Bits of the pairs that are reported, and of the proven ones of them.
    unsigned apart;                        ///< Of those that are not reported at all.
};

using TouchingBlock = void(PairKind, const double* block, const SearchParameters&, TouchAnswers&);

struct KernelTable {
    Isa isa;
    /// Fills time, roots, reported, is_undecided, may_touch, touch_time and earliest of the scratch, and adds to is_unproven. What the
    /// lanes found of an undecided pair is to be overwritten.
    void (*run_tile)(const TileRequest&, TileScratch&);
    TouchingBlock* contact_in_leaves;  ///< Of pairs that may be in contact in the leaf asked for or, if that is apart, in the next one,
    TouchingBlock* contact_anywhere;   ///< and of pairs that may be in any.
    /// For the certified search of one pair; null if intervals are better looked at one by one.
    IntervalKernel intervals;
};

/// Tables in this build; null where the instruction set was not built.
const KernelTable* kernel_table(Isa isa) noexcept;

}  // namespace fastccd
