#include "scene_hits.hpp"

#include "../common_options.hpp"

namespace fastccd::tools {

SceneHits::SceneHits(const std::filesystem::path& path, bool proof) : rows_{path}, proof_{proof}
{
    rows_.append(FMT_COMPILE("step,kind,v0,v1,v2,v3,toi{}\n"), proof ? ",proven" : "");
}

void SceneHits::append(std::size_t step, PairKind kind, const PairVertices& vertices, const Contact& contact)
{
    rows_.append(FMT_COMPILE("{},{},{},{},{},{},{:.17g}{}\n"), step, short_name(kind), vertices[0],
                 vertices[1], vertices[2], vertices[3], contact.toi, !proof_ ? "" : contact.proven ? ",1" : ",0");
}

}  // namespace fastccd::tools
