// Stand-in for oneTBB's header, see workers.h.
#pragma once

#include <cstddef>
#include <new>

namespace tbb {

template <class T>
struct cache_aligned_allocator {
    using value_type = T;

    cache_aligned_allocator() = default;
    template <class U>
    cache_aligned_allocator(const cache_aligned_allocator<U>&) noexcept
    {
    }
    friend bool operator==(const cache_aligned_allocator&, const cache_aligned_allocator&) { return true; }

    T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t{alignment})); }
    void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t{alignment}); }

private:
    static constexpr std::size_t alignment = 64;
};

}  // namespace tbb
