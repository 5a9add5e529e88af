// What the values in the body of a PLY file mean, whichever way they are written.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>

#include "../interrupt.hpp"
#include "../shown_text.hpp"
#include "mesh_formats.hpp"
#include "mesh_text.hpp"
#include "ply_body.hpp"
#include "ply_header.hpp"

namespace fastccd::tools::detail {
namespace {

// The header's count of an element is believed only as far as the file is long enough for it.
template <class Body>
void check_count(const PlyElement& element, const Body& body)
{
    std::size_t least = 0;
    for (const PlyProperty& property : element.properties) {
        least += Body::least_size(property.count_type.value_or(property.type));
    }
    if (least != 0 && element.count > body.most_values() / least) {
        throw MeshError(fmt::format(
            "the header claims {} elements {}, more than the rest of the file can hold; it is "
            "truncated, or the header is wrong",
            element.count, in_quotes(element.name)));
    }
}

template <class Body>
void skip_property(const PlyProperty& property, Body& body)
{
    std::int64_t count = 1;
    if (property.count_type) count = body.read_integer(*property.count_type);
    if (count < 0) body.fail(fmt::format("list {} has length {}", in_quotes(property.name), count));
    body.skip(property.type, static_cast<std::uint64_t>(count));
}

// Which of `names`, all needed once, each property of an element is; names.size() for another one. check(property, its name) throws if
// it has a type that it should not have.
template <std::size_t count, class Check>
std::vector<std::size_t> places(const PlyElement& element, const std::array<std::string_view, count>& names, Check check)
{
    std::array<int, count> found{};
    std::vector<std::size_t> places;
    for (const PlyProperty& property : element.properties) {
        const auto place = static_cast<std::size_t>(
            std::find(names.begin(), names.end(), property.name) - names.begin());
        if (place < count) check(property, names[place]);
        if (place < count) ++found[place];
        places.push_back(place);
    }
    for (std::size_t place = 0; place < count; ++place) {
        if (found[place] != 1) {
            throw MeshError(fmt::format(
                "the header declares {} property '{}' {} times; each of {} is needed once",
                element.name, names[place], found[place], fmt::join(names, ", ")));
        }
    }
    return places;
}

std::vector<std::size_t> position_axes(const PlyElement& vertex)
{
    constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
    return places(vertex, names, [](const PlyProperty& property, std::string_view name) {
        if (property.count_type) throw MeshError(fmt::format("vertex property '{}' is a list", name));
    });
}

// vertex1 and vertex2 are the format's names, v0 and v1 those of some writers. Nothing if there are none of them: then these are edges of
// another kind.
std::vector<std::size_t> edge_ends(const PlyElement& edge)
{
    for (const auto& names : {std::array<std::string_view, 2>{"vertex1", "vertex2"}, {"v0", "v1"}}) {
        const bool any = std::any_of(edge.properties.begin(), edge.properties.end(), [&](const PlyProperty& property) {
            return std::find(names.begin(), names.end(), property.name) != names.end();
        });
        if (!any) continue;
        return places(edge, names, [](const PlyProperty& property, std::string_view name) {
            if (property.count_type || is_floating(property.type))
                throw MeshError(fmt::format("edge property '{}' must be an integer", name));
        });
    }
    return {};
}

bool is_index_list(const PlyProperty& property)
{
    return property.name == "vertex_indices" || property.name == "vertex_index";
}

void check_face_properties(const PlyElement& face)
{
    const auto lists = std::count_if(face.properties.begin(), face.properties.end(), is_index_list);
    if (lists != 1) {
        throw MeshError(fmt::format(
            "the header declares {} face properties 'vertex_indices' or 'vertex_index'; one is "
            "needed",
            lists));
    }
    const auto list = std::find_if(face.properties.begin(), face.properties.end(), is_index_list);
    if (!list->count_type || is_floating(list->type)) {
        throw MeshError(fmt::format("face property '{}' must be a list of integers", list->name));
    }
}

// All items of an element: read(i, k) reads property k of item i, or returns false, and it is skipped.
template <class Body, class Read>
void read_items(const PlyElement& element, Body& body, Read read)
{
    for (std::uint64_t i = 0; i < element.count; ++i) {
        if (i % 65536 == 65535) check_interrupt();  // in binary files there are no lines
        body.begin({element.name, i});
        for (std::size_t k = 0; k < element.properties.size(); ++k)
            if (!read(i, k)) skip_property(element.properties[k], body);
        body.end();
    }
}

template <class Body>
std::vector<double> read_vertices(const PlyElement& element, Body& body)
{
    const std::vector<std::size_t> axes = position_axes(element);
    std::vector<double> positions(3 * static_cast<std::size_t>(element.count));
    read_items(element, body, [&](std::uint64_t i, std::size_t k) {
        if (axes[k] == 3) return false;
        positions[3 * i + axes[k]] = body.read_real(element.properties[k].type);
        return true;
    });
    return positions;
}

template <class Body>
std::int32_t read_vertex(PlyType type, std::uint64_t vertex_count, Body& body)
{
    const std::int64_t index = body.read_integer(type);
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count) {
        body.fail(fmt::format("it refers to vertex {}; the file has vertices 0 to {}", index,
                              vertex_count - 1));
    }
    return static_cast<std::int32_t>(index);
}

template <class Body>
void read_triangle(const PlyProperty& list, std::uint64_t vertex_count,
                   std::vector<std::int32_t>& faces, Body& body)
{
    const std::int64_t corners = body.read_integer(*list.count_type);
    if (corners != 3) {
        body.fail(fmt::format(
            "it has {} vertices; only triangles are read, triangulate the mesh first", corners));
    }
    for (int corner = 0; corner < 3; ++corner) faces.push_back(read_vertex(list.type, vertex_count, body));
}

template <class Body>
std::vector<std::int32_t> read_faces(const PlyElement& element, std::uint64_t vertex_count,
                                     Body& body)
{
    std::vector<std::int32_t> faces;
    faces.reserve(3 * static_cast<std::size_t>(element.count));
    read_items(element, body, [&](std::uint64_t, std::size_t k) {
        if (!is_index_list(element.properties[k])) return false;
        read_triangle(element.properties[k], vertex_count, faces, body);
        return true;
    });
    return faces;
}

template <class Body>
std::vector<Edge> read_edges(const PlyElement& element, std::uint64_t vertex_count, Body& body)
{
    const std::vector<std::size_t> ends = edge_ends(element);
    std::vector<Edge> edges(static_cast<std::size_t>(element.count));
    read_items(element, body, [&](std::uint64_t i, std::size_t k) {
        if (ends[k] == 2) return false;
        edges[i][ends[k]] = read_vertex(element.properties[k].type, vertex_count, body);
        return true;
    });
    return edges;
}

template <class Body>
void skip_element(const PlyElement& element, Body& body)
{
    if (element.properties.empty()) return;  // nothing in the file, however many there are
    read_items(element, body, [](std::uint64_t, std::size_t) { return false; });
}

template <class Body>
Mesh read_body(const PlyHeader& header, std::uint64_t vertex_count, Body body)
{
    Mesh mesh;
    for (const PlyElement& element : header.elements) {
        check_count(element, body);
        if (element.name == "vertex") {
            mesh.positions = read_vertices(element, body);
        } else if (element.name == "face") {
            mesh.faces = read_faces(element, vertex_count, body);
        } else if (element.name == "edge" && !edge_ends(element).empty()) {
            mesh.lines = read_edges(element, vertex_count, body);
        } else {
            skip_element(element, body);
        }
    }
    body.end_of_file();
    return mesh;
}

}  // namespace

Mesh parse_ply(std::string_view content)
{
    LineCursor lines(content);
    const PlyHeader header = parse_ply_header(lines);
    const auto count_of = [&](const char* name) {
        const PlyElement* const element = header.find(name);
        const std::uint64_t count = element == nullptr ? 0 : element->count;
        if (count > max_count) {
            throw MeshError(
                fmt::format("the header claims {} elements '{}'; at most 2^31 - 1 can be indexed",
                            count, name));
        }
        return count;
    };
    const std::uint64_t vertex_count = count_of("vertex"), face_count = count_of("face");
    const bool has_lines = count_of("edge") > 0 && !edge_ends(*header.find("edge")).empty();
    if (vertex_count == 0 || (face_count == 0 && !has_lines)) {
        throw MeshError(fmt::format("the mesh is empty: the header declares no elements '{}'",
                                    vertex_count == 0 ? "vertex" : "face' or 'edge"));
    }
    if (face_count > 0) check_face_properties(*header.find("face"));

    if (header.format == PlyFormat::ascii) return read_body(header, vertex_count, AsciiBody(lines));
    return read_body(header, vertex_count, BinaryBody(content, lines.offset(), header.format));
}

}  // namespace fastccd::tools::detail
