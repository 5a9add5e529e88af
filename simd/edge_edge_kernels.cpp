// Tiles of edge-edge pairs, by the lanes of one instruction set.
#include <kernel_lane.hpp>

#include <run_tile.hpp>
#include <tile_kernels.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

void run_edge_edge_tile(const TileRequest& request, TileScratch& scratch) { run_tile<PairKind::edge_edge, KernelLane>(request, scratch); }

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
