// KernelTable::run_tile of either kind. Each is in a file of its own, as all that they come to, for every layout, with a minimum separation and
// without, keeps a compiler busy for a minute and takes 0.8 GB: both in one file would double what a build waits for.
#pragma once

#include <kernel_table.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

void run_vertex_face_tile(const TileRequest& request, TileScratch& scratch);
void run_edge_edge_tile(const TileRequest& request, TileScratch& scratch);

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
