// Options, results and errors of the public interface.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <fastccd/export.h>

namespace fastccd {

/// What a pair consists of. Four points x0..x3 each move linearly over the step.
enum class PairKind : std::uint8_t {
    vertex_face,  ///< x0 is the vertex, x1 x2 x3 the face (paper, section 4).
    edge_edge,    ///< x0 x1 is the first edge, x2 x3 the second (paper, section 5).
};

/// Instruction sets the kernels are built for. Results are the same bits on all.
enum class Isa : std::uint8_t {
    automatic,  ///< The widest one that this machine and this build offer.
    scalar,     ///< One pair at a time, in plain double.
    sse2,       ///< 2 pairs at a time.
    avx2,       ///< 4 pairs at a time.
    avx512,     ///< 8 pairs at a time (needs AVX-512 F, CD, DQ and BW).
    neon,       ///< 2 pairs at a time (arm64).
};

/// What a call asks for; the defaults are those of all functions.
struct Options {
    /// E_tol: width of the time interval, in units of the step (t in [0, 1]), within which the first contact is located if
    /// it is a regular one, at which the primitives cross beyond rounding. Where they only touch, toi may be earlier: the
    /// first time at which rounding cannot exclude contact (README, Accuracy). Below about 1e-12 regular ones may be earlier than
    /// this, too, as the sign of their cubic is lost in rounding so close to the root: random pairs by less than 1e-12.
    /// Positive and finite; values below 2^-50 t_max act as that.
    double tolerance = 1e-9;
    /// Contact is searched in [0, t_max], 0 < t_max <= 1. (Below 2^-98 of their size, pairs without
    /// a minimum separation are all left to the slower search for one pair.)
    double t_max = 1.0;
    /// Which kernels to run; Isa::automatic honours the environment variable FASTCCD_ISA.
    Isa isa = Isa::automatic;
    /// Run the certified search alone on every pair. Slower; the results are the same bits.
    bool reference = false;
    /// Settle by rational arithmetic every contact that rounding leaves possible but not proven, or does not locate
    /// within the tolerance: all contacts reported are contacts then, and toi is early by less than the tolerance (2^-50 t_max
    /// at least) and a rounding (2^-51), and 0 for contact at t = 0 alone (or before 2^-1071). Costs allocations and some ten to
    /// some hundred microseconds for each such pair, milliseconds for a few, and about a second (the longest found) if its
    /// coordinates' exponents spread over the whole range of double. Needs a build with GMP, which ends the program if memory runs out.
    bool exact = false;
    /// d: with d > 0, contact is a distance of at most d of the two primitives, and toi a lower bound of the first time at
    /// which they are as close; pairs not certainly farther apart than d at the start have toi 0 (Contact::at_start), all others in
    /// contact a positive one (or 0, as if at the start, if that time is below 2^-1071).
    /// Finite, in units of the coordinates. Not together with `exact`; contact roots are not counted.
    double minimum_separation = 0.0;
    /// With minimum_separation d: a pair counts as in contact once its distance is at most (1 + distance_tolerance) d
    /// (rounding, and what a cap on the work leaves undecided: README), which keeps the work bounded for pairs that graze. It is
    /// this, not `tolerance`, that says how early toi may be. Finite, at least 0.
    double distance_tolerance = 1e-6;
};

/// Index of no pair: SIZE_MAX.
inline constexpr std::size_t no_pair = std::numeric_limits<std::size_t>::max();
/// toi of what does not touch: +infinity. Written as bits, since to compilers that are told of none (-ffast-math) that of std::numeric_limits may
/// be any number.
inline constexpr double no_contact = std::bit_cast<double>(std::uint64_t{0x7ff} << 52);

/// One contact of a compact result.
struct Contact {
    std::size_t pair;  ///< Index of the pair in the input.
    double toi;        ///< Lower bound of its first time of contact, in [0, t_max].
    /// There is contact, certainly: the cubic changes sign beyond rounding around toi, within 2^-6 of the step, while inclusion
    /// holds, or Options::exact has settled it; with a minimum separation, the pair certainly comes as close at toi or later.
    /// Otherwise contact is not excluded, to within rounding, distance_tolerance or a cap on the work.
    bool proven = false;
    /// With a minimum separation: the pair is not certainly farther apart than that at t = 0 (or before 2^-1071).
    bool at_start = false;
};

/// Totals of one call, or of several: see add().
struct Summary {
    std::size_t pairs = 0;         ///< Pairs asked about.
    std::size_t contacts = 0;      ///< Pairs reported in contact.
    std::size_t proven = 0;        ///< Of these, the proven ones; see Contact.
    std::size_t at_start = 0;      ///< Of these, the ones with Contact::at_start.
    std::size_t odd = 0;           ///< Contacts at an odd number of roots, when roots were asked for.
    std::size_t even = 0;          ///< Contacts at an even number of roots, when roots were asked for.
    std::size_t invalid = 0;       ///< Pairs with a NaN or an infinity.
    std::size_t scalar_pairs = 0;  ///< Valid pairs that the lanes leave to the search for one pair at a time. No part of the answer:
                                   ///< may depend on instruction set, processor and threads.
    Contact earliest{no_pair, no_contact};  ///< Smallest toi, ties to the smaller index.
    Isa isa = Isa::automatic;      ///< Kernels that ran.

    /// Adds the totals of another call, whose pairs are counted from `first` on in the whole: for pairs of one kind that come in pieces.
    /// (Of earliest_contact, which counts no contacts, there are none to add.)
    constexpr void add(const Summary& part, std::size_t first = 0) noexcept
    {
        pairs += part.pairs;
        contacts += part.contacts;
        proven += part.proven;
        at_start += part.at_start;
        odd += part.odd;
        even += part.even;
        invalid += part.invalid;
        scalar_pairs += part.scalar_pairs;
        if (isa == Isa::automatic) isa = part.isa;
        if (part.earliest.pair == no_pair) return;
        Contact other = part.earliest;
        other.pair += first;
        if (earliest.pair == no_pair || other.toi < earliest.toi || (other.toi == earliest.toi && other.pair < earliest.pair)) earliest = other;
    }
};

/// What can go wrong. `pair` is Status::pair.
enum class Error : std::uint8_t {
    none,
    bad_tolerance,         ///< tolerance is not a positive finite number.
    bad_t_max,             ///< t_max is not in (0, 1].
    wrong_size,            ///< an output span does not have one element per pair, or a view is malformed, has no data or no room in memory.
    exact_unavailable,     ///< options.exact in a build without GMP.
    isa_unavailable,       ///< options.isa is not in this build or not on this machine.
    bad_isa_environment,   ///< FASTCCD_ISA names no instruction set, or one that is unavailable.
    index_out_of_range,    ///< an index of pair `pair` points outside its array.
    invalid_pair,          ///< pair `pair` has a NaN or an infinity, in a call that cannot leave it out.
    out_of_memory,         ///< an allocation failed, or the system refused a thread; what arrays hold is unspecified.
    bad_minimum_separation,  ///< minimum_separation is negative, infinite or not a number.
    bad_distance_tolerance,  ///< distance_tolerance is negative, infinite or not a number.
    exact_separation,        ///< options.exact together with a minimum separation.
    bad_face_index,          ///< face `pair` of a mesh refers to a vertex that is not there.
    bad_edge_index,          ///< edge `pair` of a mesh refers to a vertex that is not there.
    bad_kind,                ///< a PairKind that is neither of the two.
};

/// Outcome of a call: `error` and, where one pair, face or edge is at fault, its number and the index it holds.
struct Status {
    Error error = Error::none;
    std::size_t pair = no_pair;
    std::int64_t index = 0;

    [[nodiscard]] constexpr bool ok() const noexcept { return error == Error::none; }
};

/// A sentence for people; static storage.
[[nodiscard]] FASTCCD_API const char* message(Error error) noexcept;

}  // namespace fastccd
