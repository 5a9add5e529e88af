// The pairs that the benchmarks run on, built when first asked for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fastccd/indexed.hpp>
#include <fastccd/options.hpp>
#include <fastccd/pair_buffer.hpp>

namespace fastccd::bench {

/// One step of a mesh.
struct SceneStep {
    std::vector<double> start, end;    ///< n x 3, row-major, at t = 0 and t = 1
    std::vector<std::int32_t> faces;   ///< m x 3, row-major
    std::vector<std::array<std::int32_t, 2>> edges;
};

/// All pairs of one kind of a data set: packed, and, if they come from a mesh, by index too. Either
/// list holds the same pairs in the same order.
struct Dataset {
    std::string name;
    PairKind kind = PairKind::vertex_face;
    PairBuffer packed;
    std::optional<SceneStep> scene;
    std::vector<VertexFace> vertex_face;
    std::vector<EdgeEdge> edge_edge;
};

/// Larger sets are cut here, at the first pairs in the order of the broad phase: 1.5 GB packed.
inline constexpr std::size_t most_pairs = 8'000'000;

/// "random" (the paper's test: every coordinate uniform in the unit cube), "generated" (a cloth on a spinning ball, made on the spot),
/// "grids" (two sheets of one grid, made as well), and the public scenes "cloth-ball", "n-body" and "cloth-funnel" as far as their files
/// are there.
[[nodiscard]] std::vector<std::string> available_datasets();
[[nodiscard]] bool is_scene(const std::string& dataset);

/// The data set of that name. Only the latest one is kept, because several would not fit into memory:
/// the reference is valid until the next call with other arguments.
[[nodiscard]] const Dataset& dataset(const std::string& name, PairKind kind);

}  // namespace fastccd::bench
