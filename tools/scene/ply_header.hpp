// The header of a PLY file (Greg Turk, The PLY Polygon File Format, 1994).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_text.hpp"

namespace fastccd::tools::detail {

enum class PlyFormat : std::uint8_t { ascii, little_endian, big_endian };

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] std::size_t size_of(PlyType type);  ///< in a binary file, in bytes
[[nodiscard]] bool is_floating(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type;  ///< of the value, or of a list's elements
    std::optional<PlyType>
        count_type;  ///< lists only: integer type of the length before the elements
};

struct PlyElement {
    std::string name;
    std::uint64_t count;  ///< as the header claims; nothing may be allocated on its word alone
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format;
    std::vector<PlyElement> elements;

    [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

/// Reads from the first line ("ply") to "end_header"; the cursor is left on the body. Throws
/// MeshError, naming the line.
PlyHeader parse_ply_header(LineCursor& lines);

}  // namespace fastccd::tools::detail
