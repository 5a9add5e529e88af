// The kernels of one instruction set. Compiled once for each, with FASTCCD_KERNEL_ISA naming it and
// FASTCCD_KERNEL_NAMESPACE a namespace of its own; nothing here may include standard containers or
// define anything the linker could share with code for another instruction set.
#include <kernel_table.hpp>

#if defined(FASTCCD_KERNEL_ARCH)
#include <lane_batch.hpp>
#endif

#include <interval_certificates.hpp>
#include <run_tile.hpp>
#include <touching_pairs.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

#if defined(FASTCCD_KERNEL_ARCH)
using KernelLane = xsimd::batch<double, xsimd::FASTCCD_KERNEL_ARCH>;
#else
using KernelLane = double;
#endif

namespace {

void run_kernel_tile(const TileRequest& request, TileScratch& scratch) { run_tile<KernelLane>(request, scratch); }

template <PairKind kind, class L>
unsigned apart_on_lanes(const PairCoefficients& pair, const double* starts, const double* ends, unsigned met, bool by_area)
{
    const L a = Lane<L>::load(starts), b = Lane<L>::load(ends);
    const unsigned apart = Lane<L>::bits(apart_on<kind>(pair, a, b, met)) & ~met;
    return by_area ? apart | Lane<L>::bits(apart_by_area_on<kind>(pair, a, b)) : apart;
}

template <class L>
unsigned apart_on_intervals(const PairCoefficients& pair, const double* starts, const double* ends, unsigned met, bool by_area)
{
    return pair.kind == PairKind::vertex_face ? apart_on_lanes<PairKind::vertex_face, L>(pair, starts, ends, met, by_area)
                                              : apart_on_lanes<PairKind::edge_edge, L>(pair, starts, ends, met, by_area);
}

/// With two lanes, a search that foresees takes as long as one that asks for one interval at a time, or longer.
template <class L>
constexpr IntervalKernel interval_kernel()
{
    if constexpr (Lane<L>::width < 4)
        return {Lane<L>::width, nullptr};
    else
        return {Lane<L>::width, apart_on_intervals<L>};
}

}  // namespace

extern const KernelTable table;
const KernelTable table{Isa::FASTCCD_KERNEL_ISA, run_kernel_tile, touching_block<KernelLane, false>, touching_block<KernelLane, true>,
                        interval_kernel<KernelLane>()};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
