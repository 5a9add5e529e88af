// Tiles of vertex-face pairs, by the lanes of one instruction set.
#include <kernel_lane.hpp>

#include <run_tile.hpp>
#include <tile_kernels.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

void run_vertex_face_tile(const TileRequest& request, TileScratch& scratch) { run_tile<PairKind::vertex_face, KernelLane>(request, scratch); }

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
