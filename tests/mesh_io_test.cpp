#include "tools/scene/mesh_io.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace fastccd::tools {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Appends values in a chosen byte order: the machine's own tells nothing about the other one.
class Bytes {
public:
    explicit Bytes(std::endian order, std::string text = {})
        : order_(order), bytes_(std::move(text))
    {
    }

    template <class T>
    Bytes& add(T value)
    {
        auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
        bytes_.append(raw.begin(), raw.end());
        return *this;
    }

    [[nodiscard]] const std::string& text() const { return bytes_; }

private:
    std::endian order_;
    std::string bytes_;
};

std::string format_name(std::endian order)
{
    return order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
}

// Bits, not values: -0 and NaN must survive, too.
std::vector<std::uint64_t> bits(const std::vector<double>& values)
{
    std::vector<std::uint64_t> result;
    for (const double value : values) result.push_back(std::bit_cast<std::uint64_t>(value));
    return result;
}

Mesh parse_ply(const std::string& content)
{
    return parse_mesh(content, "mesh.ply");
}
Mesh parse_obj(const std::string& content)
{
    return parse_mesh(content, "mesh.obj");
}

std::string error_of(const std::string& content, const fs::path& path)
{
    try {
        (void)parse_mesh(content, path);
    } catch (const InputError& error) {
        EXPECT_EQ(error.path(), path);
        return error.what();
    }
    return "no error";
}

std::string ascii_ply(const std::string& vertices, const std::string& faces,
                      const std::string& type = "double")
{
    const auto lines = [](const std::string& text) {
        return std::to_string(std::count(text.begin(), text.end(), '\n'));
    };
    return "ply\nformat ascii 1.0\nelement vertex " + lines(vertices) + "\nproperty " + type +
           " x\nproperty " + type + " y\nproperty " + type + " z\nelement face " + lines(faces) +
           "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces;
}

const std::string triangle_vertices = "0 0 0\n1 0 0\n0 1 0\n";
const std::string triangle = ascii_ply(triangle_vertices, "3 0 1 2\n");
const std::vector<double> triangle_positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<std::int32_t> triangle_faces{0, 1, 2};

TEST(MeshIo, ReadsAsciiPly)
{
    const Mesh mesh = parse_ply(triangle);
    EXPECT_EQ(mesh.positions, triangle_positions);
    EXPECT_EQ(mesh.faces, triangle_faces);

    // Line ends of other systems, blank lines, and a last line without an end.
    std::string other = triangle;
    other.pop_back();
    for (std::size_t i = 0; (i = other.find('\n', i)) != std::string::npos; i += 2)
        other.replace(i, 1, "\r\n");
    EXPECT_EQ(parse_ply(other).positions, triangle_positions);
    EXPECT_EQ(parse_ply(ascii_ply("0 0 0\n1 0 0\n0 1 0\n", "3 0 1 2\n") + "\n \n").faces,
              triangle_faces);
}

TEST(MeshIo, AsciiNumbersAreCorrectlyRounded)
{
    // Decimal text halfway between doubles or just beside, at the ends of the range, and below it.
    const std::string vertices =
        "0.1 1e23 9007199254740993\n"
        "9007199254740993.00000000000000000000001 5e-324 1.7976931348623157e308\n"
        "2.2250738585072011e-308 -0.0 +3.5\n"
        "1e-400 -1e-400 nan\n"
        "inf -inf 2e-324\n";
    const Mesh mesh = parse_ply(ascii_ply(vertices, "3 0 1 2\n"));
    const std::vector<double> expected{0.1,
                                       1e23,
                                       9007199254740992.0,
                                       9007199254740994.0,
                                       5e-324,
                                       1.7976931348623157e308,
                                       2.2250738585072011e-308,
                                       -0.0,
                                       3.5,
                                       0.0,
                                       -0.0,
                                       std::numeric_limits<double>::quiet_NaN(),
                                       infinity,
                                       -infinity,
                                       0.0};
    EXPECT_EQ(bits(mesh.positions), bits(expected));

    // A float property is rounded once, to float: 1 + 2^-24 + 2^-60 is above the tie between 1 and
    // 1 + 2^-23, which rounding by way of double would not see.
    const Mesh narrow = parse_ply(
        ascii_ply("0.1 1.000000059604644776257 1e-60\n0 0 0\n0 0 0\n", "3 0 1 2\n", "float"));
    EXPECT_EQ(narrow.positions[0], double{0.1F});
    EXPECT_EQ(narrow.positions[1], 1.0 + 0x1p-23);
    EXPECT_EQ(narrow.positions[2], 0.0);
}

TEST(MeshIo, ReadsBinaryPlyOfBothEndiannesses)
{
    const std::vector<double> positions{0.1, -1e300, 5e-324, infinity, -0.0, 1.0 / 3, 2, 3, 4};
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        Bytes file(
            order,
            "ply\nformat " + format_name(order) +
                " 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n");
        for (const double x : positions) file.add(x);
        file.add(std::uint8_t{3}).add(std::int32_t{2}).add(std::int32_t{0}).add(std::int32_t{1});
        const Mesh mesh = parse_ply(file.text());
        EXPECT_EQ(bits(mesh.positions), bits(positions)) << format_name(order);
        EXPECT_EQ(mesh.faces, (std::vector<std::int32_t>{2, 0, 1}));
        EXPECT_EQ(parse_ply(file.text() + "\n").faces, mesh.faces)
            << "a line break at the end is harmless";
    }
}

TEST(MeshIo, ReadsEveryTypeAndSkipsWhatIsExtra)
{
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        // Faces before vertices, integer coordinates out of order, lists and elements to skip.
        Bytes file(
            order,
            "ply\nformat " + format_name(order) +
                " 1.0\ncomment any words\nobj_info more\n"
                "element empty 1000000000000\n"
                "element camera 2\nproperty list ushort double views\nproperty char kind\n"
                "element face 2\nproperty uint8 flag\nproperty list int32 uint16 vertex_index\n"
                "property list uint8 float32 texcoord\n"
                "element vertex 3\nproperty float32 z\nproperty uchar red\nproperty int16 x\n"
                "property list char short tags\nproperty uint y\nend_header\n");
        file.add(std::uint16_t{2}).add(1.0).add(2.0).add(char{5});
        file.add(std::uint16_t{0}).add(char{6});
        file.add(std::uint8_t{1}).add(std::int32_t{3});
        for (std::uint16_t i = 0; i < 3; ++i) file.add(i);
        file.add(std::uint8_t{2}).add(1.0F).add(2.0F);
        file.add(std::uint8_t{1}).add(std::int32_t{3});
        for (std::uint16_t i = 3; i-- > 0;) file.add(i);
        file.add(std::uint8_t{0});
        file.add(0.1F)
            .add(std::uint8_t{255})
            .add(std::int16_t{-300})
            .add(char{0})
            .add(std::uint32_t{4294967295});
        file.add(-2.0F)
            .add(std::uint8_t{0})
            .add(std::int16_t{7})
            .add(char{1})
            .add(std::int16_t{9})
            .add(std::uint32_t{8});
        file.add(0.0F).add(std::uint8_t{0}).add(std::int16_t{0}).add(char{0}).add(std::uint32_t{0});
        const Mesh mesh = parse_ply(file.text());
        EXPECT_EQ(mesh.positions,
                  (std::vector<double>{-300, 4294967295.0, double{0.1F}, 7, 8, -2, 0, 0, 0}));
        EXPECT_EQ(mesh.faces, (std::vector<std::int32_t>{0, 1, 2, 2, 1, 0}));
    }

    const Mesh mesh = parse_ply(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty list uchar float "
        "extra\nproperty int y\n"
        "property uchar red\nproperty int z\nelement edge 1\nproperty int a\nproperty int b\n"
        "element face 1\nproperty list uchar uint vertex_indices\nproperty uchar flag\nend_header\n"
        "1 2 0.5 0.5 2 255 3\n4 0 5 0 6\n7 1 9 8 0 9\n0 1\n3 0 1 2 1\n");
    EXPECT_EQ(mesh.positions, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(mesh.faces, triangle_faces);
}

TEST(MeshIo, ReadsObj)
{
    const Mesh mesh = parse_obj(
        "# a comment\nmtllib a.mtl\no thing\r\nv 0.1 1e23 -0.0\nv 1 2 3 1.0\n  v\t4 5 6 0.5 0.5 "
        "0.5\nvt 0 0\nvn 0 0 1\n"
        "usemtl wood\ns off\nunheard of\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 "
        "3/1/1 # note\n"
        "f -3 -2 -1\nl 1 2\nf 4 1 2\nv 7 8 9\nf -1 -2 -4");
    EXPECT_EQ(bits(mesh.positions), bits({0.1, 1e23, -0.0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(mesh.faces, (std::vector<std::int32_t>{0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1,
                                                     2, 0, 1, 2, 3, 0, 1, 3, 2, 0}));
    EXPECT_EQ(mesh.lines, (std::vector<Edge>{{0, 1}}));
    EXPECT_EQ(parse_mesh("v 0 0 0\nf 1 1 1\n", "UPPER.OBJ").faces,
              (std::vector<std::int32_t>{0, 0, 0}));
}

TEST(MeshIo, ObjStatementsGoOnAfterABackslash)
{
    const Mesh mesh = parse_obj("# not \\\nv 0 0 \\\r\n0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 \\\n\t3\nl 1 \\\n2");
    EXPECT_EQ(mesh.positions, triangle_positions);
    EXPECT_EQ(mesh.faces, triangle_faces);
    EXPECT_EQ(mesh.lines, (std::vector<Edge>{{0, 1}}));
    const Mesh comments = parse_obj("v 0 0 0 # C:\\\nv 1 0 0\nv 0 1 0\nf\\\n1 2 3 # D:\\\nf 3 2 1 #\\\nl 1 2\n");
    EXPECT_EQ(comments.positions, triangle_positions) << "comments do not go on";
    EXPECT_EQ(comments.faces, (std::vector<std::int32_t>{0, 1, 2, 2, 1, 0}));
    EXPECT_EQ(comments.lines, (std::vector<Edge>{{0, 1}}));
    EXPECT_EQ(parse_obj("v 0 0 0\nv 1 0 0\nl 1 2 \\").lines, (std::vector<Edge>{{0, 1}})) << "nothing comes after the last one";
}

/// Of rods and hair, alone or beside faces.
TEST(MeshIo, ReadsLines)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const Mesh mesh = parse_obj(vertices + "l 1 2/7 3 # a polyline\nl -1 -3\nl 4 4\nv 2 2 2\n");
    EXPECT_TRUE(mesh.faces.empty());
    EXPECT_EQ(mesh.lines, (std::vector<Edge>{{0, 1}, {1, 2}, {2, 0}, {3, 3}}));

    const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string edges = "element edge 2\nproperty uint vertex2\nproperty uchar red\nproperty int vertex1\n";
    EXPECT_EQ(parse_ply(header + edges + "end_header\n" + triangle_vertices + "0 255 1\n2 255 1\n").lines, (std::vector<Edge>{{1, 0}, {1, 2}}));
    const Mesh both = parse_ply(header + edges + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + triangle_vertices +
                                "0 255 1\n2 255 1\n3 0 1 2\n");
    EXPECT_EQ(both.lines, (std::vector<Edge>{{1, 0}, {1, 2}}));
    EXPECT_EQ(both.faces, triangle_faces);
    EXPECT_EQ(parse_ply(header + "element edge 1\nproperty int v0\nproperty int v1\nend_header\n" + triangle_vertices + "2 0\n").lines,
              (std::vector<Edge>{{2, 0}}));
    Bytes binary(std::endian::big,
                 "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty char x\nproperty char y\nproperty char z\n"
                 "element edge 1\nproperty ushort vertex1\nproperty int vertex2\nend_header\n");
    binary.add(char{1}).add(char{2}).add(char{3}).add(std::uint16_t{0}).add(std::int32_t{0});
    EXPECT_EQ(parse_ply(binary.text()).lines, (std::vector<Edge>{{0, 0}}));
}

/// Unknown statements are skipped, so that it would hide the first vertex.
TEST(MeshIo, ObjAfterAByteOrderMark)
{
    const Mesh mesh = parse_obj("\xEF\xBB\xBFv 1 2 3\nv 4 5 6\nv 7 8 9\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(mesh.faces, (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(MeshIo, ContentDecidesForPly)
{
    EXPECT_EQ(parse_mesh(triangle, "mesh.obj").faces, triangle_faces);
    EXPECT_EQ(parse_mesh(triangle, "mesh").faces, triangle_faces);
}

struct Malformed {
    std::string content;
    std::string message;  // what the error must say, after the file's name
};

TEST(MeshIo, NamesWhatIsWrongWithPly)
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
        {edited("1 0 0", "1 \x01\xff 0"), "line 11: vertex 1: '\?\?' is not a number"},
        {edited("3 0 1 2", "3 0 1 3"),
         "line 13: face 0: it refers to vertex 3; the file has vertices 0 to 2"},
        {edited("3 0 1 2", "3 0 1 -1"), "line 13: face 0: it refers to vertex -1"},
        {edited("3 0 1 2", "3 0 1 1.5"), "line 13: face 0: '1.5' is not an integer"},
        {edited("3 0 1 2", "4 0 1 2 0"),
         "line 13: face 0: it has 4 vertices; only triangles are read"},
        {edited("3 0 1 2", "2 0 1"), "line 13: face 0: it has 2 vertices"},
        {triangle + "3 0 1 2\n", "line 14: the file goes on after the last element"},
        {edited("element face 1\n", "element edge 1\n"), "the mesh is empty: the header declares no elements 'face' or 'edge'"},
        {with_edge("property int v1\n", "0\n"), "the header declares edge property 'v0' 0 times; each of v0 and v1"},
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

TEST(MeshIo, NamesWhatIsWrongWithObj)
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
TEST(MeshIo, SurvivesDamagedFiles)
{
    Bytes binary(
        std::endian::big,
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
        "property list uint uchar skipped\nproperty double z\nelement face 1\n"
        "property list uint int vertex_indices\nend_header\n");
    for (int i = 0; i < 3; ++i)
        binary.add(1.0).add(2.0F).add(std::uint32_t{2}).add(std::uint16_t{7}).add(3.0);
    binary.add(std::uint32_t{3}).add(std::int32_t{0}).add(std::int32_t{1}).add(std::int32_t{2});
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 -1//3\n";

    const auto check = [](const std::string& content, const char* path) {
        try {
            const Mesh mesh = parse_mesh(content, path);
            const auto n = static_cast<std::int32_t>(mesh.positions.size() / 3);
            for (const std::int32_t index : mesh.faces) EXPECT_TRUE(index >= 0 && index < n);
            EXPECT_FALSE(mesh.faces.empty() && mesh.lines.empty());
        } catch (const InputError&) {
        }
    };
    std::mt19937 random(1);
    std::uniform_int_distribution<int> byte(0, 255);
    for (const auto& [content, path] :
         {std::pair{triangle, "a.ply"}, std::pair{binary.text(), "a.ply"},
          std::pair{obj, "a.obj"}}) {
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

class MeshFiles : public testing::Test {
protected:
    MeshFiles()
        : directory_(fs::temp_directory_path() / ("fastccd_mesh_io_" + std::to_string(::getpid())))
    {
        fs::create_directories(directory_);
    }
    ~MeshFiles() override
    {
        std::error_code ignored;
        fs::remove_all(directory_, ignored);
    }

    fs::path directory_;
};

TEST_F(MeshFiles, WhatIsWrittenReadsBack)
{
    std::mt19937_64 random(1);
    Mesh mesh;
    for (int i = 0; i < 300; ++i)
        mesh.positions.push_back(std::bit_cast<double>(random()));  // NaNs, too
    for (int i = 0; i < 600; ++i) mesh.faces.push_back(static_cast<std::int32_t>(random() % 100));
    const fs::path path = directory_ / "mesh.ply";
    for (int round = 0; round < 2; ++round) {  // the second time over the first, and with lines
        if (round == 1) mesh.lines = {{7, 5}, {99, 0}};
        OutputFile file(path);
        write_ply(file, mesh);
        file.commit();
        const Mesh back = read_mesh(path);
        EXPECT_EQ(bits(back.positions), bits(mesh.positions));
        EXPECT_EQ(back.faces, mesh.faces);
        EXPECT_EQ(back.lines, mesh.lines);
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 1)
        << "nothing left behind";
}

TEST_F(MeshFiles, FailuresOfTheFileSystemAreNamed)
{
    const auto error_of_reading = [](const fs::path& path) -> std::string {
        try {
            (void)read_mesh(path);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    const fs::path missing = directory_ / "missing.ply";
    EXPECT_EQ(error_of_reading(missing),
              missing.string() + ": cannot be opened: No such file or directory");
    EXPECT_EQ(error_of_reading(directory_),
              directory_.string() + ": cannot be read: Is a directory");
    EXPECT_THROW(write_ply(OutputFile("/dev/full"), parse_ply(triangle)), InputError);
}

TEST(UniqueEdges, EqualsASet)
{
    EXPECT_TRUE(unique_edges({}).empty());
    EXPECT_TRUE(unique_edges({0, 0, 0}).empty()) << "no edge from a vertex to itself";
    EXPECT_EQ(unique_edges({5, 5, 2}), (std::vector<Edge>{{2, 5}}));
    EXPECT_EQ(unique_edges({5, 5, 2}, {{7, 7}, {5, 2}, {9, 0}}), (std::vector<Edge>{{0, 9}, {2, 5}}));

    std::mt19937 random(1);
    for (const std::int32_t largest :
         {1, 7, 1000, 100000, std::numeric_limits<std::int32_t>::max()}) {
        std::uniform_int_distribution<std::int32_t> vertex(0, largest);
        std::vector<std::int32_t> faces(3000);
        for (std::int32_t& index : faces) index = vertex(random);
        std::set<Edge> expected;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const std::int32_t a = faces[i];
            const std::int32_t b = faces[i % 3 == 2 ? i - 2 : i + 1];
            if (a != b) expected.insert({std::min(a, b), std::max(a, b)});
        }
        const std::vector<Edge> edges = unique_edges(faces);
        EXPECT_TRUE(std::equal(edges.begin(), edges.end(), expected.begin(), expected.end()))
            << "largest " << largest;
    }
}

}  // namespace
}  // namespace fastccd::tools
