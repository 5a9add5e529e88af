// What was found in a scene.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fastccd/options.hpp>

#include "pair_vertices.hpp"

namespace fastccd::tools {

/// A contact, by what touches.
struct SceneContact {
    std::size_t step;
    PairKind kind;
    std::size_t candidate;  ///< Its number among the step's candidates of its kind: the pair in the saved ones.
    PairVertices vertices;
    double toi;
};

/// Of the candidates of one kind, in one step or in many.
struct KindTotals {
    std::size_t candidates = 0;
    std::size_t contacts = 0;
    std::size_t proven = 0;    ///< Of the contacts.
    std::size_t at_start = 0;  ///< Of the contacts: closer than a minimum separation from the start.
    std::size_t scalar_pairs = 0;
    std::optional<SceneContact> earliest;  ///< Of the first step that has any.
    double broad_seconds = 0;              ///< Finding the candidates.
    double narrow_seconds = 0;             ///< Answering them.
};

struct StepTotals {
    std::array<KindTotals, 2> kinds;  ///< Vertex-face, edge-edge.
    std::size_t invalid = 0;          ///< Vertices with a NaN or an infinity at either end.
};

struct InvalidVertex {
    std::size_t step;
    std::int32_t vertex;
};

struct SceneTotals {
    std::vector<std::string> frames;
    std::size_t vertices = 0;
    std::size_t faces = 0;
    std::size_t edges = 0;
    std::vector<StepTotals> steps;
    std::vector<InvalidVertex> invalid;  ///< Of all steps.
    double read_seconds = 0;             ///< Reading frames and finding the edges.
    Isa isa = Isa::automatic;
    int threads = 1;
};

/// The earlier of two contacts: the earlier step, in it the smaller toi, of equal ones the first argument.
[[nodiscard]] inline std::optional<SceneContact> earlier(const std::optional<SceneContact>& a,
                                                         const std::optional<SceneContact>& b)
{
    if (!a || !b) return a ? a : b;
    if (a->step != b->step) return a->step < b->step ? a : b;
    return b->toi < a->toi ? b : a;
}

/// Of two parts, in their order, one total.
[[nodiscard]] inline KindTotals operator+(const KindTotals& a, const KindTotals& b)
{
    return {.candidates = a.candidates + b.candidates,
            .contacts = a.contacts + b.contacts,
            .proven = a.proven + b.proven,
            .at_start = a.at_start + b.at_start,
            .scalar_pairs = a.scalar_pairs + b.scalar_pairs,
            .earliest = earlier(a.earliest, b.earliest),
            .broad_seconds = a.broad_seconds + b.broad_seconds,
            .narrow_seconds = a.narrow_seconds + b.narrow_seconds};
}

/// The sums of one kind over all steps.
[[nodiscard]] inline KindTotals sum(const SceneTotals& totals, PairKind kind)
{
    KindTotals all;
    for (const StepTotals& step : totals.steps) all = all + step.kinds[static_cast<std::size_t>(kind)];
    return all;
}

}  // namespace fastccd::tools
