// One tile by the lanes of one type, whatever is asked and however its pairs lie.
#pragma once

#include <indexed_pairs.hpp>
#include <packed_pairs.hpp>
#include <pipeline.hpp>
#include <separation_pipeline.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L, class Source>
FASTCCD_INLINE void run_tile_from(const TileRequest& request, TileScratch& scratch)
{
    if (request.parameters->separation.distance > 0.0)
        SeparationPipeline<kind, L, Source>::run_tile(request, scratch);
    else
        Pipeline<kind, L, Source>::run_tile(request, scratch);
}

template <PairKind kind, class L>
FASTCCD_INLINE void run_tile_of(const TileRequest& request, TileScratch& scratch)
{
    const PairView* const pairs = request.source->view;
    if (pairs == nullptr) return run_tile_from<kind, L, IndexedPairs<kind, L>>(request, scratch);
    const bool floats = pairs->scalar() == PairView::Scalar::float32;
    if (pairs->layout() == PairView::Layout::interleaved) {
        if (floats) return run_tile_from<kind, L, PackedPairs<L, Interleaved, float>>(request, scratch);
        return run_tile_from<kind, L, PackedPairs<L, Interleaved, double>>(request, scratch);
    }
    if (floats && pairs->layout() == PairView::Layout::blocked)
        return run_tile_from<kind, L, PackedPairs<L, InBlocks, float>>(request, scratch);
    run_tile_from<kind, L, PackedPairs<L, InBlocks, double>>(request, scratch);
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
