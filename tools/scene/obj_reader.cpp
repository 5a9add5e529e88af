// Wavefront OBJ: the statements `v`, `f` and `l` (Wavefront Advanced Visualizer manual, appendix B1).
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>

#include "../shown_text.hpp"
#include "mesh_formats.hpp"
#include "mesh_text.hpp"

namespace fastccd::tools::detail {
namespace {

class ObjParser {
public:
    explicit ObjParser(std::string_view content) : lines_(content) {}

    Mesh parse()
    {
        while (lines_.next()) {
            first_line_ = lines_.number();
            std::string_view line = whole_statement(lines_.line());
            const std::string_view statement = take_word(line);
            if (statement == "v") {
                add_vertex(line);
            } else if (statement == "f") {
                add_face(line);
            } else if (statement == "l") {
                add_line(line);
            }
        }
        check_forward_reference();
        if (mesh_.positions.empty() || (mesh_.faces.empty() && mesh_.lines.empty())) {
            throw MeshError(
                fmt::format("the mesh is empty ({} vertices, {} faces); it needs `v` lines, and `f` or `l` lines",
                            vertex_count(), mesh_.faces.size() / 3));
        }
        return std::move(mesh_);
    }

private:
    // Not of a comment: what comes after it may be a face.
    static bool goes_on(std::string_view line)
    {
        if (!line.ends_with('\\')) return false;
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line))
            if (word[0] == '#') return false;
        return true;
    }

    // A backslash at its end continues a line on the next one, of statements that are skipped, too: what comes after one is no face.
    std::string_view whole_statement(std::string_view line)
    {
        if (!goes_on(line)) return line;
        statement_.clear();
        do {
            line.remove_suffix(1);
            statement_ += line;
            statement_ += ' ';
            if (!lines_.next()) return statement_;
            line = lines_.line();
        } while (goes_on(line));
        return statement_ += line;
    }

    [[nodiscard]] std::uint64_t vertex_count() const { return mesh_.positions.size() / 3; }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw MeshError(fmt::format("line {}: {}", first_line_, what));
    }

    // v x y z [w] or v x y z r g b: what follows the position is skipped.
    void add_vertex(std::string_view line)
    {
        if (vertex_count() == max_count) fail("too many vertices; at most 2^31 - 1 can be indexed");
        for (const char axis : {'x', 'y', 'z'}) {
            const std::string_view word = take_word(line);
            double value = 0;
            if (word.empty())
                fail(fmt::format("vertex {} has no {} coordinate", vertex_count() + 1, axis));
            if (!parse_number(word, value)) {
                fail(fmt::format("vertex {}: {} is not a number that double can hold",
                                 vertex_count() + 1, in_quotes(word)));
            }
            mesh_.positions.push_back(value);
        }
    }

    // f a b c, each corner v, v/vt, v//vn or v/vt/vn.
    void add_face(std::string_view line)
    {
        if (mesh_.faces.size() / 3 == max_count)
            fail("too many faces; at most 2^31 - 1 can be indexed");
        std::size_t corners = 0;
        for (std::string_view word = take_word(line); !word.empty() && word[0] != '#';
             word = take_word(line)) {
            if (corners < 3) mesh_.faces.push_back(vertex_reference(word, "face"));
            ++corners;
        }
        if (corners != 3) {
            fail(fmt::format(
                "the face has {} vertices; only triangles are read, triangulate the mesh first",
                corners));
        }
    }

    // l a b c ..., each end v or v/vt: edges a b, b c, ...
    void add_line(std::string_view line)
    {
        Edge edge{};
        std::size_t ends = 0;
        for (std::string_view word = take_word(line); !word.empty() && word[0] != '#';
             word = take_word(line)) {
            edge = {edge[1], vertex_reference(word, "line")};
            if (++ends < 2) continue;
            if (mesh_.lines.size() == max_count) fail("too many lines; at most 2^31 - 1 can be indexed");
            mesh_.lines.push_back(edge);
        }
        if (ends < 2) fail(fmt::format("the line has {} vertices; it needs two at least", ends));
    }

    // Index from 0 of the vertex that a corner of a face, or an end of a line, refers to: from 1 in the file, or counted
    // backwards from the vertices so far when negative.
    std::int32_t vertex_reference(std::string_view word, std::string_view of)
    {
        const std::string_view texture_and_normal =
            word.substr(std::min(word.find('/'), word.size()));
        std::int64_t reference = 0;
        if (!parse_number(word.substr(0, word.size() - texture_and_normal.size()), reference) ||
            texture_and_normal.find_first_not_of("/-0123456789") != std::string_view::npos) {
            fail(fmt::format("{} is not a vertex of a {}; write v, v/vt, v//vn or v/vt/vn",
                             in_quotes(word), of));
        }
        const auto count = static_cast<std::int64_t>(vertex_count());
        const auto limit = static_cast<std::int64_t>(max_count);
        if (reference == 0) fail(fmt::format("the {} refers to vertex 0, but OBJ counts from 1", of));
        if (reference < -count || reference > limit) {
            fail(fmt::format("the {} refers to vertex {}, but {} vertices come before it", of,
                             reference, count));
        }
        // A face or line may stand before its vertices, so what is too large yet is judged at the end.
        if (reference > count && reference > forward_reference_) {
            forward_reference_ = reference;
            forward_of_ = of;
            forward_line_ = first_line_;
        }
        return static_cast<std::int32_t>(reference > 0 ? reference - 1 : count + reference);
    }

    void check_forward_reference() const
    {
        if (forward_reference_ > static_cast<std::int64_t>(vertex_count())) {
            throw MeshError(
                fmt::format("line {}: the {} refers to vertex {}, but the file has {}",
                            forward_line_, forward_of_, forward_reference_, vertex_count()));
        }
    }

    LineCursor lines_;
    std::size_t first_line_ = 0;  // of the statement
    Mesh mesh_;
    std::int64_t forward_reference_ = 0;  // the largest to a vertex that had not come yet
    std::size_t forward_line_ = 0;
    std::string_view forward_of_;
    std::string statement_;  // put together from several lines
};

}  // namespace

Mesh parse_obj(std::string_view content)
{
    return ObjParser(content).parse();
}

}  // namespace fastccd::tools::detail
