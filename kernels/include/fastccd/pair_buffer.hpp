// An owning buffer of pairs in the native blocked layout.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <span>
#include <utility>

#include <fastccd/aligned_doubles.hpp>
#include <fastccd/pair_view.hpp>

namespace fastccd {

/// `size` pairs in 64-byte aligned blocks [24 coordinates][8 lanes] of double, 192 bytes a
/// pair. Starts as all zeros; the lanes that pad the last block stay zero and are ignored.
/// Like that of std::vector, its constructor throws std::bad_alloc, in the caller's own code; where that is compiled
/// without exceptions, it aborts.
class PairBuffer {
public:
    PairBuffer() = default;
    /// What is moved from is empty.
    PairBuffer(PairBuffer&& other) noexcept : data_{std::move(other.data_)}, size_{std::exchange(other.size_, 0)} {}
    PairBuffer& operator=(PairBuffer&& other) noexcept
    {
        data_ = std::move(other.data_);
        size_ = std::exchange(other.size_, 0);
        return *this;
    }

    explicit PairBuffer(std::size_t size) : size_{size}
    {
        if (size > std::numeric_limits<std::size_t>::max() / (2 * pair_coordinates * sizeof(double))) out_of_memory();
        const std::size_t count = block_count() * block_coordinates;
        if (count == 0) return;
        data_ = allocate_aligned(count);
        if (data_ == nullptr) out_of_memory();
        std::memset(data_.get(), 0, count * sizeof(double));
    }

    /// Pairs; the last block may have fewer than 8.
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] std::size_t block_count() const noexcept { return (size_ + block_pairs - 1) / block_pairs; }
    /// block_count() x 24 x 8; null without pairs.
    [[nodiscard]] double* data() noexcept { return data_.get(); }
    [[nodiscard]] const double* data() const noexcept { return data_.get(); }

    /// Coordinate c (see pair_coordinates) of pair i. Neither is checked.
    [[nodiscard]] double& at(std::size_t i, std::size_t c) noexcept { return data_[blocked_index(i, c)]; }
    [[nodiscard]] double at(std::size_t i, std::size_t c) const noexcept { return data_[blocked_index(i, c)]; }

    /// Sets all 24 coordinates of pair i.
    void set(std::size_t i, std::span<const double, pair_coordinates> coordinates) noexcept
    {
        for (std::size_t c = 0; c < pair_coordinates; ++c) at(i, c) = coordinates[c];
    }

    /// Of all pairs, as long as this buffer lives and is not moved from.
    [[nodiscard]] PairView view() const noexcept { return PairView::blocked(data_.get(), size_); }

private:
    [[noreturn]] static void out_of_memory()
    {
#if defined(__cpp_exceptions)
        throw std::bad_alloc{};
#else
        std::abort();
#endif
    }

    AlignedDoubles data_;
    std::size_t size_ = 0;
};

}  // namespace fastccd
