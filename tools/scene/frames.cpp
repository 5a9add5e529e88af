#include "frames.hpp"

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "mesh_io.hpp"

namespace fastccd::tools {
namespace {

/// Hours of work shall not end at a name misspelled. Without opening: a frame may come through a pipe.
void check_readable(const std::string& path)
{
    struct stat found {};
    if (::stat(path.c_str(), &found) != 0 || ::access(path.c_str(), R_OK) != 0) {
        throw InputError(path, fmt::format("cannot be opened: {}", std::generic_category().message(errno)));
    }
    if (S_ISDIR(found.st_mode)) throw InputError(path, "is a directory; name its frames, in their order");
}

void check_same_mesh(const std::string& path, const Mesh& mesh, const std::string& first_path,
                     std::size_t vertex_count, const std::vector<std::int32_t>& faces, const std::vector<Edge>& lines)
{
    constexpr std::string_view rule = "all frames of a scene have the same vertices, faces and lines";
    if (mesh.positions.size() / 3 != vertex_count) {
        throw InputError(path, fmt::format("has {} vertices, the first frame, {}, has {}; {}",
                                           mesh.positions.size() / 3, first_path, vertex_count, rule));
    }
    if (mesh.faces.size() != faces.size()) {
        throw InputError(path, fmt::format("has {} faces, the first frame, {}, has {}; {}", mesh.faces.size() / 3,
                                           first_path, faces.size() / 3, rule));
    }
    if (mesh.lines.size() != lines.size()) {
        throw InputError(path, fmt::format("has {} lines, the first frame, {}, has {}; {}", mesh.lines.size(),
                                           first_path, lines.size(), rule));
    }
    if (const auto other = std::mismatch(lines.begin(), lines.end(), mesh.lines.begin()); other.first != lines.end()) {
        const auto text = [](const Edge& line) { return fmt::format("{} {}", line[0], line[1]); };
        throw InputError(path, fmt::format("has the vertices {} in line {}, the first frame, {}, has {}; {}", text(*other.second),
                                           other.first - lines.begin(), first_path, text(*other.first), rule));
    }
    const auto difference = std::mismatch(faces.begin(), faces.end(), mesh.faces.begin()).first;
    if (difference == faces.end()) return;
    const auto face = static_cast<std::size_t>(difference - faces.begin()) / 3;
    const auto text = [face](const std::vector<std::int32_t>& list) {
        return fmt::format("{} {} {}", list[3 * face], list[3 * face + 1], list[3 * face + 2]);
    };
    throw InputError(path, fmt::format("has the vertices {} in face {}, the first frame, {}, has {}; {}",
                                       text(mesh.faces), face, first_path, text(faces), rule));
}

}  // namespace

Frames::Frames(std::vector<std::string> paths) : paths_{std::move(paths)}
{
    for (const std::string& path : paths_) check_readable(path);
    Mesh mesh = read_mesh(paths_.front());
    end_ = std::move(mesh.positions);
    faces_ = std::move(mesh.faces);
    lines_ = std::move(mesh.lines);
    edges_ = unique_edges(faces_, lines_);
    frames_read_ = 1;
}

Step Frames::next_step()
{
    const std::string& path = paths_.at(frames_read_);
    Mesh mesh = read_mesh(path);
    check_same_mesh(path, mesh, paths_.front(), vertex_count(), faces_, lines_);
    start_ = std::move(end_);
    end_ = std::move(mesh.positions);
    ++frames_read_;
    return {.positions0 = start_, .positions1 = end_, .faces = faces_, .edges = edges_};
}

}  // namespace fastccd::tools
