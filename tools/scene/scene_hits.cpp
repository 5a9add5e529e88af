#include "scene_hits.hpp"

#include <iterator>

#include <fmt/compile.h>

namespace fastccd::tools {

SceneHits::SceneHits(const std::filesystem::path& path, bool proof) : file_{path}, proof_{proof}
{
    fmt::format_to(std::back_inserter(text_), "step,kind,v0,v1,v2,v3,toi{}\n", proof ? ",proven" : "");
}

void SceneHits::append(std::size_t step, PairKind kind, const PairVertices& vertices, const Contact& contact)
{
    constexpr std::size_t flush_size = std::size_t{1} << 20;
    fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{},{},{},{},{},{},{:.17g}{}\n"), step,
                   kind == PairKind::vertex_face ? "vf" : "ee", vertices[0], vertices[1], vertices[2], vertices[3],
                   contact.toi, !proof_ ? "" : contact.proven ? ",1" : ",0");
    if (text_.size() >= flush_size) flush();
}

void SceneHits::commit()
{
    flush();
    file_.commit();
}

void SceneHits::flush()
{
    file_.write({text_.data(), text_.size()});
    text_.clear();
}

}  // namespace fastccd::tools
