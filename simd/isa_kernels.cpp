// The table of one instruction set's kernels, and those that are not in files of their own.
#include <kernel_lane.hpp>

#include <interval_certificates.hpp>
#include <tile_kernels.hpp>
#include <touching_pairs.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

namespace {

void run_tile(const TileRequest& request, TileScratch& scratch)
{
    if (request.kind == PairKind::vertex_face)
        run_vertex_face_tile(request, scratch);
    else
        run_edge_edge_tile(request, scratch);
}

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
const KernelTable table{Isa::FASTCCD_KERNEL_ISA, run_tile, touching_block<KernelLane, false>, touching_block<KernelLane, true>,
                        interval_kernel<KernelLane>()};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
