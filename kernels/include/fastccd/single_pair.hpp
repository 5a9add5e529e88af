// One pair at a time: to try things out, for a debugger, and for code that is written around one pair.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include <fastccd/export.h>
#include <fastccd/options.hpp>

namespace fastccd {

/// x y z.
using Point = std::array<double, 3>;

/// The answer for one pair.
struct PairToi {
    /// As in the dense answer: lower bound of the first time of contact in [0, t_max]; +infinity: certainly apart; NaN: a
    /// coordinate is NaN or infinite, or there is an error.
    double toi = std::bit_cast<double>(std::uint64_t{0x7ff8} << 48);
    bool proven = false;    ///< See Contact::proven.
    bool at_start = false;  ///< See Contact::at_start.
    Status status;          ///< An error in the options; with Options::exact also out_of_memory.
};

/// Four points at t = 0, `x0`, and at t = 1, `x1`; the first is the vertex, the others are the face (paper, section 4).
/// The same bits as in a batch. Runs the certified search in the caller's thread, whatever options.isa: microseconds, with a
/// minimum separation up to a millisecond, without allocation (but for Options::exact); at most 4,096 intervals, 1,024 more for what
/// is left then, and some hundred that wait; and at its distance 4,098 looks, without a minimum separation some 8,500.
[[nodiscard]] FASTCCD_API PairToi vertex_face_toi(std::span<const Point, 4> x0, std::span<const Point, 4> x1,
                                                  const Options& options = {}) noexcept;

/// The same for two edges, of which the first two points are one (paper, section 5).
[[nodiscard]] FASTCCD_API PairToi edge_edge_toi(std::span<const Point, 4> x0, std::span<const Point, 4> x1,
                                                const Options& options = {}) noexcept;

}  // namespace fastccd
