// Meshes that are read and written as they should be.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <random>
#include <set>
#include <string_view>
#include <system_error>

#include "mesh_texts.hpp"

namespace fastccd::tools {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

constexpr double infinity = std::numeric_limits<double>::infinity();

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
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_EQ(parse_obj(vertices + "g a \\\nf 3 2 1\nf 1 2 3\nvn 0 \\\nf \\\n0\n").faces, triangle_faces) << "nor is what goes on a face";
    EXPECT_EQ(parse_obj(vertices + "\\\nf 1 2 3\n").faces, triangle_faces) << "of nothing, the next line";
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
    // Before the vertices they refer to, and beside no faces.
    EXPECT_EQ(parse_ply("ply\nformat ascii 1.0\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nelement face 0\n" + header.substr(21) +
                        "end_header\n1 2\n" + triangle_vertices).lines, (std::vector<Edge>{{1, 2}}));
    EXPECT_TRUE(parse_ply(header + "element edge 0\nproperty int vertex1\nproperty int vertex2\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n" + triangle_vertices + "3 0 1 2\n").lines.empty());
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

TEST(MeshIo, PlyAfterAByteOrderMarkAndBlanksAfterItsName)
{
    for (const std::string begin : {"\xEF\xBB\xBFply\n", "ply \n", "ply\t \r\n", "\xEF\xBB\xBFply \r\n"})
        EXPECT_EQ(parse_mesh(begin + triangle.substr(4), "mesh").faces, triangle_faces) << begin;
    EXPECT_THROW((void)parse_mesh("ply x\n" + triangle.substr(4), "mesh"), InputError);
}

TEST(MeshIo, ContentDecidesForPly)
{
    EXPECT_EQ(parse_mesh(triangle, "mesh.obj").faces, triangle_faces);
    EXPECT_EQ(parse_mesh(triangle, "mesh").faces, triangle_faces);
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
