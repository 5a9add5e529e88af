// The kernels of one instruction set. Compiled once for each, with FASTCCD_KERNEL_ISA naming it and
// FASTCCD_KERNEL_NAMESPACE a namespace of its own; nothing here may include standard containers or
// define anything the linker could share with code for another instruction set.
#include <kernel_table.hpp>

#if defined(FASTCCD_KERNEL_ARCH)
#include <lane_batch.hpp>
#endif

#include <pipeline.hpp>
#include <separation_pipeline.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

#if defined(FASTCCD_KERNEL_ARCH)
using KernelLane = xsimd::batch<double, xsimd::FASTCCD_KERNEL_ARCH>;
#else
using KernelLane = double;
#endif

namespace {

void run_kernel_tile(const TileRequest& request, TileScratch& scratch)
{
    if (request.parameters->separation.distance > 0.0)
        run_separation_tile<KernelLane>(request, scratch);
    else
        run_tile<KernelLane>(request, scratch);
}

}  // namespace

extern const KernelTable table;
const KernelTable table{Isa::FASTCCD_KERNEL_ISA, Lane<KernelLane>::width, run_kernel_tile};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
