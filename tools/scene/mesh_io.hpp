#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "../input_error.hpp"
#include "../output_file.hpp"
#include "edge.hpp"

// Why an own reader: what Debian 12 packages was weighed first.
//   CGAL 5.5 (polygon soup)  Keeps doubles and both endiannesses, but answers true or false with no
//                            place in the file, allocates whatever length a list claims, accepts
//                            OBJ indices 0 and n + 1, refuses unknown OBJ statements and 8- and
//                            16-bit face indices. Brings Boost, GMP and MPFR.
//   assimp 5.2               Built with float positions.
//   OpenMesh 9               A half-edge structure: only manifold meshes keep the file's indices.
//   tinyobjloader 2          OBJ only; its numbers are not correctly rounded.
// Exact doubles and bad files being named are promises here, so the two formats are read below;
// the numbers themselves are left to std::from_chars.

namespace fastccd::tools {

/// A mesh of triangles and lines as it stands in its file.
struct Mesh {
    std::vector<double> positions = {};  ///< n x 3, row-major, in the file's units; may hold NaN or inf
    std::vector<std::int32_t> faces = {};  ///< m x 3, row-major; every index is in [0, n)
    std::vector<Edge> lines = {};  ///< Edges on their own, of rods and hair: OBJ's lines, PLY's edges; every index is in [0, n)
};

/// Reads a PLY (ascii, binary_little_endian, binary_big_endian) or OBJ file.
///
/// A file that begins with the line "ply" (a mark of UTF-8 before it, as before OBJ, is left out) is PLY, any other named *.obj is OBJ. Positions keep full
/// precision: ascii numbers are correctly rounded to the property's type (OBJ: double), floats and
/// integers widened exactly. Extra PLY properties and elements (edges without two vertices, too) and all OBJ statements but `v`, `f` and
/// `l` are skipped. NaN and infinity are read as they are.
///
/// Throws InputError, naming line or byte and element, when the file is missing, unreadable,
/// malformed, truncated or longer than its header says, holds a face that is not a triangle, or a face or line that
/// refers to a vertex that does not exist, or has no vertices, or neither faces nor lines. Memory stays within a
/// small multiple of the file's size, whatever its header claims. Throws Interrupted after a signal.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& path);

/// `read_mesh` on a file's content; `path` gives the extension and the name for messages.
[[nodiscard]] Mesh parse_mesh(std::string_view content, const std::filesystem::path& path);

/// Whether a file of that name is taken for a frame: *.ply or *.obj, in capitals, too.
[[nodiscard]] bool named_as_mesh(const std::filesystem::path& path);

/// Writes PLY, binary little endian: double x y z, faces as lists of int, and lines, if there are any, as edges. Throws as
/// OutputFile::write.
void write_ply(const OutputFile& file, const Mesh& mesh);

/// The edges of a triangle list (m x 3, indices not negative) and of lines: each as (low, high), once, sorted
/// lexicographically. A face or line that repeats a vertex adds no edge from that vertex to itself.
[[nodiscard]] std::vector<Edge> unique_edges(const std::vector<std::int32_t>& faces, const std::vector<Edge>& lines = {});

}  // namespace fastccd::tools
