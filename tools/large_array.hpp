// Long lists on large pages, as PairBuffer has its pairs.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include <fastccd/aligned_doubles.hpp>

namespace fastccd::tools {

/// Times or index pairs, of 8 bytes each. On the small pages of a std::vector, which is what Linux gives where large ones have to be asked
/// for, what is timed may take much longer (bench/LIMITS_MEMORY.md, Pages). Constructors throw std::bad_alloc.
template <class T>
class LargeArray {
    static_assert(sizeof(T) == sizeof(double) && alignof(T) <= alignof(double) && std::is_trivially_copyable_v<T>);

public:
    LargeArray() = default;
    /// All zero.
    explicit LargeArray(std::size_t size) : LargeArray{allocate_aligned(size), size} { std::uninitialized_value_construct_n(data(), size); }
    /// A copy.
    explicit LargeArray(std::span<const T> list) : LargeArray{allocate_aligned(list.size()), list.size()}
    {
        std::uninitialized_copy(list.begin(), list.end(), data());
    }

    /// As long as this array lives and is not moved from.
    [[nodiscard]] std::span<T> span() noexcept { return {data(), size_}; }

private:
    LargeArray(AlignedDoubles memory, std::size_t size) : memory_{std::move(memory)}, size_{size}
    {
        if (memory_ == nullptr) throw std::bad_alloc{};
    }
    [[nodiscard]] T* data() noexcept { return reinterpret_cast<T*>(memory_.get()); }

    AlignedDoubles memory_;
    std::size_t size_ = 0;
};

}  // namespace fastccd::tools
