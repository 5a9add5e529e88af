// The parsers behind parse_mesh, one per format. They throw MeshError; parse_mesh adds the path.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "mesh_io.hpp"

namespace fastccd::tools::detail {

/// A message without the file's name.
struct MeshError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Indices are int32, so no mesh has more vertices, faces or lines than this.
inline constexpr std::uint64_t max_count = std::numeric_limits<std::int32_t>::max();

Mesh parse_ply(std::string_view content);
Mesh parse_obj(std::string_view content);

}  // namespace fastccd::tools::detail
