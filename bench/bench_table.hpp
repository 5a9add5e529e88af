// The table that the narrow-phase benchmarks are registered from.
#pragma once

#include <string>
#include <vector>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>

namespace fastccd::bench {

enum class Layout { blocked, strided, interleaved, indexed };
enum class Question {
    dense,     ///< time_of_impact: one time per pair.
    contacts,  ///< find_contacts: the list of pairs in contact.
    earliest,  ///< earliest_contact: the first contact of all.
    separation,           ///< time_of_impact with a minimum separation; see bench_separation.
    separation_earliest,  ///< earliest_contact with the same.
};

/// The minimum separation asked for: this times the mean length of an edge; random pairs: this.
inline constexpr double bench_separation = 1e-3;

[[nodiscard]] inline bool is_earliest(Question question)
{
    return question == Question::earliest || question == Question::separation_earliest;
}
[[nodiscard]] inline bool has_separation(Question question)
{
    return question == Question::separation || question == Question::separation_earliest;
}

struct Case {
    PairKind kind;
    Isa isa;
    std::string data;
    Layout layout;
    PairView::Scalar scalar;
    Question question;
    int threads;
};

[[nodiscard]] const char* name(PairKind kind) noexcept;

/// "vertex_face/avx2/cloth-ball/blocked/double/threads:1"; before the threads "/contacts", "/earliest",
/// "/separation" or "/separation_earliest" where the question is not the dense one.
[[nodiscard]] std::string name(const Case& c);

/// Instruction sets of this build that this machine has, narrowest first.
[[nodiscard]] std::vector<Isa> available_isas();

/// Every combination there is: kind x data x layout x float or double x question x instruction set x threads. Indexed
/// pairs exist for scenes only, and in double only, because a MovingMesh holds doubles whatever it is made from. Cases
/// that share memory follow each other. Threads: 1, 2, 4, ... and all.
[[nodiscard]] std::vector<Case> all_cases();

/// The part of the table that answers the usual questions in a few minutes: every instruction set on packed and indexed
/// doubles; more threads and other questions on the widest instruction set; other layouts on random pairs and one scene.
[[nodiscard]] bool in_default_selection(const Case& c);

}  // namespace fastccd::bench
