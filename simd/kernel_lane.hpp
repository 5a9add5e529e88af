// The lanes of one instruction set's kernels. Files that include this are compiled once for each, with FASTCCD_KERNEL_ISA naming it,
// FASTCCD_KERNEL_ARCH its batches in xsimd if there are any, and FASTCCD_KERNEL_NAMESPACE a namespace of its own. They may not include
// standard containers or define anything the linker could share with code for another instruction set.
#pragma once

#if defined(FASTCCD_KERNEL_ARCH)
#include <lane_batch.hpp>
#else
#include <lane.hpp>
#endif

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

#if defined(FASTCCD_KERNEL_ARCH)
using KernelLane = xsimd::batch<double, xsimd::FASTCCD_KERNEL_ARCH>;
#else
using KernelLane = double;
#endif

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
