// Meshes that are refused, and by which words.
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <random>
#include <string_view>

#include "mesh_texts.hpp"

namespace fastccd::tools {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

std::string error_of(const std::string& content, const fs::path& path)
{
    try {
        (void)parse_mesh(content, path);
    } catch (const InputError& error) {
        EXPECT_TRUE(std::string_view(error.what()).starts_with(path.string() + ": ")) << error.what();
        return error.what();
    }
    return "no error";
}

struct Malformed {
    std::string content;
    std::string message;  // what the error must say, after the file's name
};

/// In time in proportion to the file.
TEST(MeshErrors, HeadersOfNothingButElements)
{
    std::string content = "ply\nformat ascii 1.0\n";
    for (int i = 0; i < 200'000; ++i) content += "element e" + std::to_string(i) + " 0\n";
    EXPECT_NE(error_of(content + "end_header\n", "many.ply").find("the mesh is empty"), std::string::npos);
    EXPECT_NE(error_of(content + "element e7 0\n", "many.ply").find("line 200003: element 'e7' is declared twice"), std::string::npos);
}

TEST(MeshErrors, NamesWhatIsWrongWithPly)
{
    const auto edited = [](std::string_view from, std::string_view to) {
        std::string content = triangle;
        content.replace(content.find(from), from.size(), to);
        return content;
    };
    const auto with_edge = [&](const std::string& properties, const std::string& edge) {
        return edited("end_header\n", "element edge 1\n" + properties + "end_header\n") + edge;
    };
    const std::string binary_header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float "
        "y\nproperty float z\n"
        "element face 1\nproperty list char int vertex_indices\nend_header\n";
    const std::string vertex(12, '\0');
    const std::vector<Malformed> cases{
        {"", "the file is empty"},
        {"plyx\n", "not a mesh that is read here"},
        {"ply\n", "line 1: the file ends within the header"},
        {"ply\nelement vertex 1\nend_header\n", "line 3: the header names no format"},
        {edited("ascii", "utf8"), "line 2: format 'utf8'"},
        {edited("1.0", "2.0"), "line 2: PLY version '2.0'"},
        {edited("1.0", "1.0 x"), "line 2: 'x' is more"},
        {edited("format ascii 1.0", "format ascii 1.0\nformat ascii 1.0"),
         "line 3: the format is named twice"},
        {edited("element vertex 3", "element vertex"),
         "line 3: '' is not a number of 'vertex' elements"},
        {edited("element vertex 3", "element vertex -3"), "line 3: '-3' is not a number"},
        {edited("element vertex 3", "element"), "line 3: the element has no name"},
        {edited("element vertex 3", "elephant"), "line 3: 'elephant' is not a PLY header line"},
        {edited("element face", "element vertex"), "line 7: element 'vertex' is declared twice"},
        {edited("element vertex 3\n", ""), "line 3: a property stands before the first element"},
        {edited("double x", "quad x"), "line 4: 'quad' is not a PLY type"},
        {edited("double x", "double"), "line 4: the property has no name"},
        {edited("list uchar", "list float"),
         "line 8: the length of a list must have an integer type"},
        {edited("double x", "double u"), "vertex property 'x' 0 times"},
        {edited("double y", "double x"), "vertex property 'x' 2 times"},
        {edited("double x", "list uchar double x"), "vertex property 'x' is a list"},
        {edited("uchar int", "uchar float"),
         "face property 'vertex_indices' must be a list of integers"},
        {edited("vertex_indices", "corners"), "the header declares 0 face properties"},
        {edited("element face 1\n", "element faces 1\n"),
         "the mesh is empty: the header declares no elements 'face' or 'edge'"},
        {ascii_ply("", "3 0 0 0\n"), "the mesh is empty: the header declares no elements 'vertex'"},
        {ascii_ply(triangle_vertices, ""), "the mesh is empty"},
        {edited("vertex 3", "vertex 4294967296"),
         "the header claims 4294967296 elements 'vertex'; at most"},
        {edited("vertex 3", "vertex 2000000000"),
         "the header claims 2000000000 elements 'vertex', more than the rest"},
        {edited("vertex 3", "vertex 99999999999999999999"),
         "line 3: '99999999999999999999' is not a number"},
        {edited("face 1", "face 3"), "line 13: face 1: the file ends before it"},
        {edited("face 1", "face 300"), "the header claims 300 elements 'face', more than"},
        {edited("1 0 0", "1 0"), "line 11: vertex 1: the line ends before its last value"},
        {edited("1 0 0", "1 0 0 0"),
         "line 11: vertex 1: '0' is more than the header says it holds"},
        {edited("1 0 0", "1 zero 0"), "line 11: vertex 1: 'zero' is not a number"},
        {edited("1 0 0", "1 0x1 0"), "line 11: vertex 1: '0x1' is not a number"},
        {edited("1 0 0", "1 1e999 0"),
         "line 11: vertex 1: '1e999' is not a number that double can hold"},
        {edited("1 0 0", "1 \x01\xff 0"), "line 11: vertex 1: '\\x01\\xff' is not a number"},
        {edited("3 0 1 2", "3 0 1 3"),
         "line 13: face 0: it refers to vertex 3; the file has vertices 0 to 2"},
        {edited("3 0 1 2", "3 0 1 -1"), "line 13: face 0: it refers to vertex -1"},
        {edited("3 0 1 2", "3 0 1 1.5"), "line 13: face 0: '1.5' is not an integer"},
        {edited("3 0 1 2", "4 0 1 2 0"),
         "line 13: face 0: it has 4 vertices; only triangles are read"},
        {edited("3 0 1 2", "2 0 1"), "line 13: face 0: it has 2 vertices"},
        {triangle + "3 0 1 2\n", "line 14: the file goes on after the last element"},
        {edited("element face 1\n", "element edge 1\n"), "the mesh is empty: the header declares no elements 'face' or 'edge'"},
        {edited("end_header\n", "element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n") + "0 1\n\n\n\n\n",
         "edge 1: the file ends before it"},
        {edited("end_header\n", "element edge 200\nproperty int vertex1\nproperty int vertex2\nend_header\n") + "0 1\n",
         "the header claims 200 elements 'edge', more than"},
        {edited("end_header\n", "element edge 4294967296\nproperty int vertex1\nproperty int vertex2\nend_header\n"),
         "the header claims 4294967296 elements 'edge'; at most"},
        {with_edge("property int v1\n", "0\n"), "the header declares edge property 'v0' 0 times; each of v0, v1 is needed once"},
        {with_edge("property int vertex1\nproperty int vertex1\n", "0 1\n"), "the header declares edge property 'vertex1' 2 times"},
        {with_edge("property int vertex1\nproperty float vertex2\n", "0 1\n"), "edge property 'vertex2' must be an integer"},
        {with_edge("property int vertex1\nproperty list uchar int vertex2\n", "0 1 1\n"), "edge property 'vertex2' must be an integer"},
        {with_edge("property int vertex1\nproperty int vertex2\n", "0 3\n"), "line 17: edge 0: it refers to vertex 3; the file has vertices 0 to 2"},
        {with_edge("property int vertex1\nproperty int vertex2\n", "0 \n\n\n"), "line 17: edge 0: the line ends before its last value"},
        {binary_header + vertex + "\3" + vertex.substr(1),
         "face 0: the file ends within it, at byte"},
        {binary_header + vertex, "the header claims 1 elements 'face', more than"},
        {binary_header + vertex + "\3\0\0\0\0\0\0\0\0\1\0\0\0"s, "face 0: it refers to vertex 1"},
        {binary_header + vertex + "\3\0\0\0\0\0\0\0\0\xff\xff\xff\xff"s,
         "face 0: it refers to vertex -1"},
        {binary_header + vertex + "\xff"s, "face 0: it has -1 vertices"},
        {binary_header + vertex + "\3" + vertex + "tail",
         "the file goes on for 4 bytes after the last element"},
    };
    for (const Malformed& malformed : cases) {
        const std::string error = error_of(malformed.content, "mesh.ply");
        EXPECT_TRUE(error.starts_with("mesh.ply: ")) << error;
        EXPECT_NE(error.find(malformed.message), std::string::npos)
            << "expected: " << malformed.message << "\ngot: " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << "one line: " << error;
    }
}

TEST(MeshErrors, NamesWhatIsWrongWithObj)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const std::vector<Malformed> cases{
        {"", "the mesh is empty (0 vertices, 0 faces)"},
        {"g nothing\n", "the mesh is empty (0 vertices, 0 faces)"},
        {vertices, "the mesh is empty (3 vertices, 0 faces)"},
        {"v 0 0\n", "line 1: vertex 1 has no z coordinate"},
        {"v 0 0 0\nv 0 zero 0\n", "line 2: vertex 2: 'zero' is not a number"},
        {"v 0 1e999 0\n", "line 1: vertex 1: '1e999' is not a number that double can hold"},
        {vertices + "f 1 2\n", "line 4: the face has 2 vertices; only triangles"},
        {vertices + "f 1 2 3 1\n", "line 4: the face has 4 vertices; only triangles"},
        {vertices + "f\n", "line 4: the face has 0 vertices"},
        {vertices + "f 1 2 0\n", "line 4: the face refers to vertex 0, but OBJ counts from 1"},
        {vertices + "l 1\n", "line 4: the line has 1 vertices; it needs two at least"},
        {vertices + "l 1 4\n", "line 4: the line refers to vertex 4, but the file has 3"},
        {vertices + "l 1 2 -4\n", "line 4: the line refers to vertex -4, but 3 vertices come before it"},
        {vertices + "l 1 b\n", "line 4: 'b' is not a vertex of a line"},
        {vertices + "f 1 2 \\\n 9\n", "line 4: the face refers to vertex 9"},
        {vertices + "f 1 2 -4\n",
         "line 4: the face refers to vertex -4, but 3 vertices come before it"},
        {vertices + "f 1 2 4\n#\n", "line 4: the face refers to vertex 4, but the file has 3"},
        {vertices + "f 1 2 99999999999\n", "line 4: the face refers to vertex 99999999999"},
        {vertices + "f 1 2 99999999999999999999\n",
         "line 4: '99999999999999999999' is not a vertex of a face"},
        {vertices + "f 1 2 3x\n", "line 4: '3x' is not a vertex of a face"},
        {vertices + "f 1 2 /1\n", "line 4: '/1' is not a vertex of a face"},
        {vertices + "f 1 2 3/a\n", "line 4: '3/a' is not a vertex of a face"},
    };
    for (const Malformed& malformed : cases) {
        const std::string error = error_of(malformed.content, "mesh.obj");
        EXPECT_NE(error.find("mesh.obj: " + malformed.message), std::string::npos)
            << "expected: " << malformed.message << "\ngot: " << error;
    }
}

// Every beginning of a good file, and every good file with bytes changed, is either read or refused
// with InputError: no other exception, no crash, no endless loop.
TEST(MeshErrors, SurvivesDamagedFiles)
{
    Bytes binary(
        std::endian::big,
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
        "property list uint uchar skipped\nproperty double z\nelement face 1\n"
        "property list uint int vertex_indices\nend_header\n");
    for (int i = 0; i < 3; ++i)
        binary.add(1.0).add(2.0F).add(std::uint32_t{2}).add(std::uint16_t{7}).add(3.0);
    binary.add(std::uint32_t{3}).add(std::int32_t{0}).add(std::int32_t{1}).add(std::int32_t{2});
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 -1//3\nl 1 2 \\\n3\n";
    const std::string edges =
        "ply\nformat ascii 1.0\nelement edge 1\nproperty int vertex2\nproperty int v0\nproperty int vertex1\nelement vertex 2\n"
        "property char x\nproperty char y\nproperty char z\nelement face 0\nend_header\n1 0 0\n0 0 0\n1 1 1\n";

    const auto check = [](const std::string& content, const char* path) {
        try {
            const Mesh mesh = parse_mesh(content, path);
            const auto n = static_cast<std::int32_t>(mesh.positions.size() / 3);
            for (const std::int32_t index : mesh.faces) EXPECT_TRUE(index >= 0 && index < n);
            for (const auto& [a, b] : mesh.lines) EXPECT_TRUE(a >= 0 && a < n && b >= 0 && b < n);
            EXPECT_FALSE(mesh.faces.empty() && mesh.lines.empty());
        } catch (const InputError&) {
        }
    };
    std::mt19937 random(1);
    std::uniform_int_distribution<int> byte(0, 255);
    for (const auto& [content, path] :
         {std::pair{triangle, "a.ply"}, std::pair{binary.text(), "a.ply"},
          std::pair{edges, "a.ply"}, std::pair{obj, "a.obj"}}) {
        ASSERT_NO_THROW((void)parse_mesh(content, path));
        for (std::size_t size = 0; size < content.size(); ++size)
            check(content.substr(0, size), path);
        std::uniform_int_distribution<std::size_t> place(0, content.size() - 1);
        for (int round = 0; round < 20000; ++round) {
            std::string damaged = content;
            for (int change = round % 4; change >= 0; --change)
                damaged[place(random)] = static_cast<char>(byte(random));
            check(damaged, path);
        }
    }
}

}  // namespace
}  // namespace fastccd::tools
