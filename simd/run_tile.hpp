// One tile by the lanes of one type, whatever is asked.
#pragma once

#include <pipeline.hpp>
#include <separation_pipeline.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L>
FASTCCD_INLINE void run_tile_of(const TileRequest& request, TileScratch& scratch)
{
    if (request.parameters->separation.distance > 0.0)
        SeparationPipeline<kind, L>::run_tile(request, scratch);
    else
        Pipeline<kind, L>::run_tile(request, scratch);
}

/// See KernelTable::run_tile.
template <class L>
FASTCCD_INLINE void run_tile(const TileRequest& request, TileScratch& scratch)
{
    if (request.kind == PairKind::vertex_face)
        run_tile_of<PairKind::vertex_face, L>(request, scratch);
    else
        run_tile_of<PairKind::edge_edge, L>(request, scratch);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
