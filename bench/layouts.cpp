#include "layouts.hpp"

#include <array>
#include <cstring>
#include <new>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace fastccd::bench {

namespace {

constexpr std::size_t line = 64;

std::size_t whole_lines(std::size_t bytes) { return (bytes + line - 1) / line * line; }

}  // namespace

template <class T>
void LayoutCopy::fill(const PairBuffer& packed, PairView::Layout layout)
{
    const std::size_t size = packed.size();
    const bool strided = layout == PairView::Layout::strided;
    const std::size_t blocked_elements = packed.block_count() * block_coordinates;
    streams_.count = strided ? pair_coordinates : 1;
    streams_.bytes = whole_lines((strided ? size : blocked_elements) * sizeof(T));
    const std::size_t bytes = streams_.count * streams_.bytes;
    storage_ = allocate_aligned(bytes / sizeof(double));
    if (storage_ == nullptr) throw std::bad_alloc{};
    std::memset(storage_.get(), 0, bytes);
    streams_.data = reinterpret_cast<const std::byte*>(storage_.get());

    T* const out = reinterpret_cast<T*>(storage_.get());
    const std::size_t column = streams_.bytes / sizeof(T);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
            for (std::size_t c = 0; c < pair_coordinates; ++c) {
                const std::size_t at = strided ? c * column + i
                                       : layout == PairView::Layout::interleaved ? i * pair_coordinates + c
                                                                                 : blocked_index(i, c);
                out[at] = static_cast<T>(packed.at(i, c));
            }
    });

    switch (layout) {
        case PairView::Layout::blocked: view_ = PairView::blocked(out, size); break;
        case PairView::Layout::interleaved: view_ = PairView::interleaved(out, size); break;
        case PairView::Layout::strided: {
            std::array<const T*, pair_coordinates> columns{};
            for (std::size_t c = 0; c < pair_coordinates; ++c) columns[c] = out + c * column;
            view_ = PairView::strided(columns, 1, size);
            break;
        }
    }
}

LayoutCopy::LayoutCopy(const PairBuffer& packed, PairView::Layout layout, PairView::Scalar scalar)
{
    if (scalar == PairView::Scalar::float32) {
        fill<float>(packed, layout);
    } else if (layout == PairView::Layout::blocked) {
        view_ = packed.view();
        streams_ = {reinterpret_cast<const std::byte*>(packed.data()), 1,
                    packed.block_count() * block_coordinates * sizeof(double)};
    } else {
        fill<double>(packed, layout);
    }
}

}  // namespace fastccd::bench
