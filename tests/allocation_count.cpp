#include "allocation_count.hpp"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <new>

#include <tbb/cache_aligned_allocator.h>

// Sanitizers bring their own malloc; there only operator new is counted.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FASTCCD_COUNT_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define FASTCCD_COUNT_MALLOC 0
#endif
#endif
#if !defined(FASTCCD_COUNT_MALLOC)
#if defined(__GLIBC__)
#define FASTCCD_COUNT_MALLOC 1
#else
#define FASTCCD_COUNT_MALLOC 0
#endif
#endif

namespace {
std::atomic<std::size_t> count{0}, refused{0}, allowed_again{0};

/// Counts, and tells whether the allocation may be made.
bool allowed(std::size_t size)
{
    count.fetch_add(1, std::memory_order_relaxed);
    return size < refused.load(std::memory_order_relaxed) || allowed_again.load(std::memory_order_relaxed) <= size;
}
}  // namespace

namespace fastccd::testing {
std::size_t allocations() { return count.load(); }
void refuse_allocations(std::size_t least, std::size_t end)
{
    refused = least;
    allowed_again = end;
}
bool refuses_every_allocation() { return FASTCCD_COUNT_MALLOC != 0; }
}  // namespace fastccd::testing

// oneTBB's library may take its memory from an allocator of its own, past malloc. This definition is the one that programs and the library
// find first.
namespace tbb::detail::r1 {
void* cache_aligned_allocate(std::size_t size)
{
    constexpr std::size_t line = 128;  // two, as oneTBB has it
    return operator new(size, std::align_val_t{line});
}
void cache_aligned_deallocate(void* p) { operator delete(p, std::align_val_t{128}); }
}  // namespace tbb::detail::r1

#if FASTCCD_COUNT_MALLOC

// operator new calls malloc, and is counted there.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size)
{
    return allowed(size) ? __libc_malloc(size) : nullptr;
}
void* calloc(std::size_t n, std::size_t size)
{
    return allowed(n * size) ? __libc_calloc(n, size) : nullptr;
}
void* realloc(void* p, std::size_t size)
{
    return allowed(size) ? __libc_realloc(p, size) : nullptr;
}
void* memalign(std::size_t alignment, std::size_t size)
{
    return allowed(size) ? __libc_memalign(alignment, size) : nullptr;
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** p, std::size_t alignment, std::size_t size)
{
    *p = memalign(alignment, size);
    return *p != nullptr ? 0 : ENOMEM;
}
}

#else

void* operator new(std::size_t size)
{
    if (!allowed(size)) throw std::bad_alloc{};
    if (void* p = std::malloc(size != 0 ? size : 1)) return p;
    throw std::bad_alloc{};
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
    return allowed(size) ? std::malloc(size != 0 ? size : 1) : nullptr;
}
void* operator new(std::size_t size, std::align_val_t alignment)
{
    if (!allowed(size)) throw std::bad_alloc{};
    const auto a = static_cast<std::size_t>(alignment);
    if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) return p;
    throw std::bad_alloc{};
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept
{
    try {
        return operator new(size, alignment);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

#endif
