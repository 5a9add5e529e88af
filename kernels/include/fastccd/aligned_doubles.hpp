// Memory for doubles, on cache lines, and on large pages where there is much of it.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

#include <fastccd/export.h>

namespace fastccd {

/// Deleter of memory of this alignment, in bytes.
struct ReleaseAligned {
    std::align_val_t alignment{64};
    void operator()(double* p) const noexcept { ::operator delete(p, alignment); }
};
using AlignedDoubles = std::unique_ptr<double[], ReleaseAligned>;

/// `count` doubles, not initialised; null if there is not that much memory. Aligned to 64 bytes: a cache line, a register of AVX-512. From
/// 4 MiB on aligned to 2 MiB, and the system is asked for pages of that size: a buffer streamed once in pages of 4 KiB has an address to
/// translate every 21 pairs. Results on small pages may cost one thread more still (bench/LIMITS_MEMORY.md, Pages).
[[nodiscard]] FASTCCD_API AlignedDoubles allocate_aligned(std::size_t count) noexcept;

}  // namespace fastccd
