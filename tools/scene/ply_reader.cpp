// What the values in the body of a PLY file mean, whichever way they are written.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>

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

// Where x, y, z are among the vertex properties: axis[i] is 0, 1, 2, or 3 for another property.
std::vector<std::size_t> position_axes(const PlyElement& vertex)
{
    constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
    std::array<int, 3> found{};
    std::vector<std::size_t> axes;
    for (const PlyProperty& property : vertex.properties) {
        const auto axis = static_cast<std::size_t>(
            std::find(names.begin(), names.end(), property.name) - names.begin());
        if (axis < 3 && property.count_type)
            throw MeshError(fmt::format("vertex property '{}' is a list", names[axis]));
        if (axis < 3) ++found[axis];
        axes.push_back(axis);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (found[axis] != 1) {
            throw MeshError(fmt::format(
                "the header declares vertex property '{}' {} times; each of x, y and z is "
                "needed once",
                names[axis], found[axis]));
        }
    }
    return axes;
}

bool is_index_list(const PlyProperty& property)
{
    return property.name == "vertex_indices" || property.name == "vertex_index";
}

// Which property of an edge is one of its ends, 2 for another one: as for position_axes. vertex1 and vertex2 are the format's names,
// v0 and v1 those of some writers. Nothing if there are none: then they are edges of another kind.
std::vector<std::size_t> edge_ends(const PlyElement& edge)
{
    using Names = std::array<std::string_view, 2>;
    const auto has = [&](std::string_view name) {
        return std::any_of(edge.properties.begin(), edge.properties.end(), [&](const PlyProperty& property) { return property.name == name; });
    };
    const bool any = has("vertex1") || has("vertex2"), any_other = has("v0") || has("v1");
    if (!any && !any_other) return {};
    const Names names = any ? Names{"vertex1", "vertex2"} : Names{"v0", "v1"};
    std::array<int, 2> found{};
    std::vector<std::size_t> ends;
    for (const PlyProperty& property : edge.properties) {
        const auto end = static_cast<std::size_t>(std::find(names.begin(), names.end(), property.name) - names.begin());
        if (end < 2 && (property.count_type || is_floating(property.type)))
            throw MeshError(fmt::format("edge property '{}' must be an integer", names[end]));
        if (end < 2) ++found[end];
        ends.push_back(end);
    }
    for (std::size_t end = 0; end < 2; ++end) {
        if (found[end] != 1) {
            throw MeshError(fmt::format(
                "the header declares edge property '{}' {} times; each of {} and {} is "
                "needed once",
                names[end], found[end], names[0], names[1]));
        }
    }
    return ends;
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

template <class Body>
std::vector<double> read_vertices(const PlyElement& element, Body& body)
{
    const std::vector<std::size_t> axes = position_axes(element);
    std::vector<double> positions(3 * static_cast<std::size_t>(element.count));
    for (std::uint64_t i = 0; i < element.count; ++i) {
        body.begin({element.name, i});
        for (std::size_t k = 0; k < axes.size(); ++k) {
            if (axes[k] < 3) {
                positions[3 * i + axes[k]] = body.read_real(element.properties[k].type);
            } else {
                skip_property(element.properties[k], body);
            }
        }
        body.end();
    }
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
    for (std::uint64_t i = 0; i < element.count; ++i) {
        body.begin({element.name, i});
        for (const PlyProperty& property : element.properties) {
            if (is_index_list(property)) {
                read_triangle(property, vertex_count, faces, body);
            } else {
                skip_property(property, body);
            }
        }
        body.end();
    }
    return faces;
}

template <class Body>
std::vector<Edge> read_edges(const PlyElement& element, const std::vector<std::size_t>& ends, std::uint64_t vertex_count, Body& body)
{
    std::vector<Edge> edges(static_cast<std::size_t>(element.count));
    for (std::uint64_t i = 0; i < element.count; ++i) {
        body.begin({element.name, i});
        for (std::size_t k = 0; k < ends.size(); ++k) {
            if (ends[k] < 2) {
                edges[i][ends[k]] = read_vertex(element.properties[k].type, vertex_count, body);
            } else {
                skip_property(element.properties[k], body);
            }
        }
        body.end();
    }
    return edges;
}

template <class Body>
void skip_element(const PlyElement& element, Body& body)
{
    if (element.properties.empty()) return;  // nothing in the file, however many there are
    for (std::uint64_t i = 0; i < element.count; ++i) {
        body.begin({element.name, i});
        for (const PlyProperty& property : element.properties) skip_property(property, body);
        body.end();
    }
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
            mesh.lines = read_edges(element, edge_ends(element), vertex_count, body);
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
