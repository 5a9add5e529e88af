// The kernels of one instruction set. Compiled once for each, with FASTCCD_KERNEL_ISA naming it and
// FASTCCD_KERNEL_NAMESPACE a namespace of its own; nothing here may include standard containers or
// define anything the linker could share with code for another instruction set.
#include <kernel_table.hpp>

#if defined(FASTCCD_KERNEL_ARCH)
#include <lane_batch.hpp>
#endif

#include <interval_certificates.hpp>
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

template <PairKind kind>
unsigned apart_on_lanes(const PairCoefficients& pair, const double* starts, const double* ends, bool by_area)
{
    const KernelLane a = Lane<KernelLane>::load(starts), b = Lane<KernelLane>::load(ends);
    const LaneMask<KernelLane> apart = apart_on<kind>(pair, a, b);
    return Lane<KernelLane>::bits(by_area ? apart | apart_by_area_on<kind>(pair, a, b) : apart);
}

unsigned apart_on_intervals(const PairCoefficients& pair, const double* starts, const double* ends, bool by_area)
{
    return pair.kind == PairKind::vertex_face ? apart_on_lanes<PairKind::vertex_face>(pair, starts, ends, by_area)
                                              : apart_on_lanes<PairKind::edge_edge>(pair, starts, ends, by_area);
}

}  // namespace

extern const KernelTable table;
const KernelTable table{Isa::FASTCCD_KERNEL_ISA, Lane<KernelLane>::width, run_kernel_tile,
                        {Lane<KernelLane>::width, apart_on_intervals}};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
