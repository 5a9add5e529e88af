// PLY and OBJ: what is accepted is a mesh of triangles and lines, and its edges can be listed.
#include <tools/scene/mesh_io.hpp>

#include "fuzz/fuzz_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace fastccd;
    return testing::read_or_refuse(data, size, [](std::string_view content) {
        const tools::Mesh mesh = tools::parse_mesh(content, "fuzz.obj");  // PLY if it begins so
        testing::require(!mesh.positions.empty() && mesh.positions.size() % 3 == 0);
        testing::require(!(mesh.faces.empty() && mesh.lines.empty()) && mesh.faces.size() % 3 == 0);
        const auto is_vertex = [&](std::int32_t vertex) { return vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.positions.size() / 3; };
        for (const std::int32_t vertex : mesh.faces) testing::require(is_vertex(vertex));
        for (const tools::Edge& line : mesh.lines) testing::require(is_vertex(line[0]) && is_vertex(line[1]));
        for (const tools::Edge& edge : tools::unique_edges(mesh.faces, mesh.lines)) testing::require(edge[0] < edge[1]);
    });
}
