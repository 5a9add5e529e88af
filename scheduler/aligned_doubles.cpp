#include <fastccd/aligned_doubles.hpp>

#include <limits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace fastccd {

AlignedDoubles allocate_aligned(std::size_t count) noexcept
{
    constexpr std::size_t cache_line = 64, large_page = std::size_t{2} << 20;
    // No object is larger; and operator new of g++ 12 rounds up to the alignment without a look at what is left of size_t.
    if (count > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / sizeof(double)) return {};
    const std::size_t bytes = count * sizeof(double);
    const std::align_val_t alignment{bytes >= 2 * large_page ? large_page : cache_line};
    AlignedDoubles data{static_cast<double*>(::operator new(bytes, alignment, std::nothrow)), ReleaseAligned{alignment}};
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    // Advice: without large pages everything works as before. The last, partial page keeps to small ones.
    if (data != nullptr && bytes >= 2 * large_page) (void)madvise(data.get(), bytes / large_page * large_page, MADV_HUGEPAGE);
#endif
    return data;
}

}  // namespace fastccd
