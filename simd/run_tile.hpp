// One tile of pairs of one kind by the lanes of one type, whatever is asked and however its pairs lie.
#pragma once

#include <indexed_pairs.hpp>
#include <packed_pairs.hpp>
#include <pipeline.hpp>
#include <separation_pipeline.hpp>
#include <strided_pairs.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <PairKind kind, class L, class Source>
FASTCCD_INLINE void run_tile_from(const TileRequest& request, TileScratch& scratch)
{
    if (request.parameters->separation.distance > 0.0)
        SeparationPipeline<kind, L, Source>::run_tile(request, scratch);
    else
        Pipeline<kind, L, Source>::run_tile(request, scratch);
}

template <PairKind kind, class L, class Number>
FASTCCD_INLINE void run_packed_tile(const TileRequest& request, TileScratch& scratch)
{
    switch (request.source->view->layout()) {
        case PairView::Layout::blocked: return run_tile_from<kind, L, PackedPairs<L, InBlocks, Number>>(request, scratch);
        case PairView::Layout::interleaved: return run_tile_from<kind, L, PackedPairs<L, Interleaved, Number>>(request, scratch);
        case PairView::Layout::strided: return run_tile_from<kind, L, StridedPairs<L, Number>>(request, scratch);
    }
}

/// See KernelTable::run_tile.
template <PairKind kind, class L>
FASTCCD_INLINE void run_tile(const TileRequest& request, TileScratch& scratch)
{
    const PairView* const pairs = request.source->view;
    if (pairs == nullptr) return run_tile_from<kind, L, IndexedPairs<kind, L>>(request, scratch);
    if (pairs->scalar() == PairView::Scalar::float64)
        run_packed_tile<kind, L, double>(request, scratch);
    else
        run_packed_tile<kind, L, float>(request, scratch);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
