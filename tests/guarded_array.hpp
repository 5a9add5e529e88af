// Arrays between pages that may not be touched.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace fastccd::testing {

enum class Side { end, beginning };

/// An array that ends where a page begins that may not be touched, or begins where one ends.
template <class T>
class GuardedArray {
public:
    GuardedArray(std::size_t size, Side side) : size_{size}
    {
        const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
        inside_ = (size * sizeof(T) + page - 1) / page * page;
        whole_ = inside_ + 2 * page;
        memory_ = ::mmap(nullptr, whole_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (memory_ == MAP_FAILED) throw std::runtime_error("no memory");
        char* const inside = static_cast<char*>(memory_) + page;
        if (inside_ > 0 && ::mprotect(inside, inside_, PROT_READ | PROT_WRITE) != 0) throw std::runtime_error("no pages");
        first_ = reinterpret_cast<T*>(side == Side::end ? inside + inside_ - size * sizeof(T) : inside);
    }
    GuardedArray(const std::vector<T>& values, Side side) : GuardedArray(values.size(), side)
    {
        std::copy(values.begin(), values.end(), first_);
    }
    GuardedArray(const GuardedArray&) = delete;
    GuardedArray& operator=(const GuardedArray&) = delete;
    ~GuardedArray() { ::munmap(memory_, whole_); }

    [[nodiscard]] T* data() const { return first_; }
    [[nodiscard]] std::size_t size() const { return size_; }

private:
    std::size_t size_, inside_ = 0, whole_ = 0;
    void* memory_ = nullptr;
    T* first_ = nullptr;
};

}  // namespace fastccd::testing
