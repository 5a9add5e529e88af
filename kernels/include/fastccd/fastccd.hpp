// fastccd: narrow phase of continuous collision detection for bulk buffers of vertex-face and
// edge-edge pairs in linear motion.
//
// Promise, for every pair with finite coordinates, rounding included: no contact in [0, t_max] is
// missed; `toi` is never after the exact first contact; at `toi` a reported pair is within the distance given in the
// README (Accuracy); a pair apart at t = 0 by more than rounding hides (the part of that distance without E_tol) gets toi > 0 (but for
// times below 2^-1071); the same bits on every instruction set, layout and thread count; bounded work per pair. A pair with a NaN or
// an infinity gets toi = NaN, the others are answered.
//
// All functions may be called from any number of threads at once, also with one MovingMesh, run in the caller's oneTBB arena,
// throw nothing and print nothing: what goes wrong is in the Status. Times are in units of the step, coordinates in
// any unit. Spans and views must stay valid and unchanged during the call, and outputs apart from inputs; none or null for no
// pairs is no error. On an error outputs are as they were before, except where a function says otherwise, and `toi` and `roots`
// on Error::out_of_memory. The caller's floating-point environment (direction of rounding, subnormal numbers flushed, exceptions
// trapped) changes no answer, and is the same after the call, with the exceptions that were raised before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fastccd/export.h>
#include <fastccd/indexed.hpp>
#include <fastccd/isa.hpp>
#include <fastccd/options.hpp>
#include <fastccd/pair_buffer.hpp>
#include <fastccd/pair_view.hpp>
#include <fastccd/single_pair.hpp>
#include <fastccd/version.h>

namespace fastccd {

// Errors of all functions: bad_tolerance, bad_t_max, bad_minimum_separation, bad_distance_tolerance, exact_separation, exact_unavailable,
// isa_unavailable, bad_isa_environment, wrong_size and out_of_memory; of packed pairs bad_kind, too; with a mesh those of MovingMesh::status()
// and index_out_of_range, too; collision_free_step: invalid_pair, too.

/// toi[i]: lower bound of the first time of contact of pair i in [0, t_max]; +infinity: certainly
/// apart throughout; NaN: a coordinate of the pair is NaN or infinite. `toi` has one element per pair.
///
/// With Options::minimum_separation d > 0, here and below, contact is a distance of at most d: toi is 0 exactly for the
/// pairs that are not certainly farther apart at t = 0 (or before 2^-1071), and no roots are counted.
///
/// `roots`, when not empty, has one element per pair and gets the number of roots of the
/// coplanarity cubic (paper, eq. 5 and 12) in [0, t_max] at which there is contact: 1 where the cubic changes sign, as at a
/// simple or triple root, 2 at a tangential one, and 1 for whatever lies at t = 0 or t_max, where its sign is known on one side
/// alone; 3 at most. 0 for no contact and for contacts whose roots cannot be counted (the motion stays coplanar to within
/// rounding, or counting comes to its cap). This is the paper's odd / even distinction (Table 1).
///
/// O(pairs); no allocation that grows with the number of pairs (but for Options::exact).
FASTCCD_API Status time_of_impact(PairKind kind, const PairView& pairs, const Options& options, std::span<double> toi,
                                  Summary* summary = nullptr, std::span<std::uint8_t> roots = {}) noexcept;

/// Appends every pair in contact to `contacts`, in pair order, and the index of every invalid pair
/// to `invalid` when given; on an error, nothing. O(pairs) over many calls with the same vectors, too; memory for twice
/// what is appended, besides the vectors' own growth, and 10 bytes for every 1,024 pairs, 3 KB for fewer than 65,536.
FASTCCD_API Status find_contacts(PairKind kind, const PairView& pairs, const Options& options, std::vector<Contact>& contacts,
                                 std::vector<std::size_t>* invalid = nullptr, Summary* summary = nullptr) noexcept;

/// The first contact of all: smallest toi, ties to the smallest pair index. pair is SIZE_MAX and toi +infinity if
/// no pair touches. Pairs that cannot beat the best so far are dropped early; the result is the same as the minimum
/// of the dense answer, on any number of threads. Invalid pairs are counted in summary->invalid only as far as they
/// were looked at; contacts are not counted.
FASTCCD_API Status earliest_contact(PairKind kind, const PairView& pairs, const Options& options, Contact& earliest,
                                    Summary* summary = nullptr) noexcept;

// The same questions about pairs of a moving mesh, with the same bits as for packed pairs. An index out of range is
// Error::index_out_of_range with the pair and the index in the Status, before any work.

FASTCCD_API Status time_of_impact(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                                  std::span<double> toi, Summary* summary = nullptr, std::span<std::uint8_t> roots = {}) noexcept;
FASTCCD_API Status time_of_impact(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                                  std::span<double> toi, Summary* summary = nullptr, std::span<std::uint8_t> roots = {}) noexcept;

FASTCCD_API Status find_contacts(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                                 std::vector<Contact>& contacts, std::vector<std::size_t>* invalid = nullptr,
                                 Summary* summary = nullptr) noexcept;
FASTCCD_API Status find_contacts(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                                 std::vector<Contact>& contacts, std::vector<std::size_t>* invalid = nullptr,
                                 Summary* summary = nullptr) noexcept;

FASTCCD_API Status earliest_contact(const MovingMesh& mesh, std::span<const VertexFace> pairs, const Options& options,
                                    Contact& earliest, Summary* summary = nullptr) noexcept;
FASTCCD_API Status earliest_contact(const MovingMesh& mesh, std::span<const EdgeEdge> pairs, const Options& options,
                                    Contact& earliest, Summary* summary = nullptr) noexcept;

/// How far a line search may go.
struct CollisionFreeStep {
    /// Nothing touches in [0, step): the smallest toi of all candidates. Without any contact it is t_max, and nothing
    /// touches in [0, t_max] either. A toi is a lower bound, so the step is safe as it is; scale it to keep a distance.
    double step = 0.0;
    PairKind kind = PairKind::vertex_face;  ///< Of the pair that limits the step,
    std::size_t pair = no_pair;             ///< and its index among those; SIZE_MAX: none does.

    [[nodiscard]] constexpr bool limited() const noexcept { return pair != no_pair; }
};

/// The largest step that vertex-face and edge-edge candidates together allow: the minimum of their dense answers, ties
/// to vertex-face, then to the smaller index, on any number of threads. Pairs that cannot limit the step further are
/// dropped early, across both kinds. At most O(candidates).
///
/// An invalid pair allows no step: unless a pair before it is in contact at time 0, the error is invalid_pair with that
/// pair. Whenever there is an error of a pair, or an index out of range, `step.kind` tells which candidates `Status::pair`
/// counts; the step is 0 then, as for every error. Without candidates it is t_max.
FASTCCD_API Status collision_free_step(const MovingMesh& mesh, std::span<const VertexFace> vertex_face,
                                       std::span<const EdgeEdge> edge_edge, const Options& options,
                                       CollisionFreeStep& step) noexcept;
FASTCCD_API Status collision_free_step(const PairView& vertex_face, const PairView& edge_edge, const Options& options,
                                       CollisionFreeStep& step) noexcept;

}  // namespace fastccd
