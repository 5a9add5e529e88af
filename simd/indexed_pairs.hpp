// Indexed pairs as screening reads them: those alone that their boxes do not keep apart, their vertices transposed in registers.
#pragma once

#include <cstddef>
#include <cstdint>

#include <kernel_table.hpp>
#include <lane.hpp>
#include <pair_source.hpp>
#include <pair_vertices.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Finds the vertex record of each point of a pair {first, second}, for lane `lane`, and asks for them.
template <PairKind kind, bool contiguous>
FASTCCD_INLINE void find_records(const IndexedSource& source, const std::int32_t* pair, std::size_t lane, const double* (&records)[4][block_pairs])
{
    std::size_t vertex[4];
    pair_vertices<kind, contiguous>(source, pair, vertex);
    for (int point = 0; point < 4; ++point) {
        const double* const record = source.records + vertex[point] * vertex_record_size;
        __builtin_prefetch(record);
        records[point][lane] = record;
    }
}

/// Lists the pairs of the tile that their boxes do not keep apart: all, if there are no boxes. Returns how many.
template <class Batch>
FASTCCD_INLINE std::size_t list_pairs(const TileRequest& tile, std::uint16_t* listed)
{
    const BoxScreen boxes = tile.source->indexed.boxes;
    const std::int32_t* const pairs = tile.source->indexed.pairs + 2 * tile.first;
    const std::size_t count = tile.count;
    std::size_t size = 0;
    if (boxes.first == nullptr) {
        for (; size < count; ++size) listed[size] = static_cast<std::uint16_t>(size);
    } else {
        const auto list = [&](std::size_t i) FASTCCD_INLINE_LAMBDA {
            const auto first = Lane<Batch>::first_box(boxes.first[pairs[2 * i]], boxes.separation);
            // Without a branch, which could not be foreseen.
            listed[size] = static_cast<std::uint16_t>(i);
            size += Lane<Batch>::apart(first, boxes.second[pairs[2 * i + 1]]) ? 0 : 1;
        };
        std::size_t i = 0;
#pragma GCC unroll 4
        for (; i + boxes_ahead < count; ++i) {
            __builtin_prefetch(&boxes.second[pairs[2 * (i + boxes_ahead) + 1]]);
            list(i);
        }
        for (; i < count; ++i) list(i);
    }
    if (size > 0)
        for (std::size_t k = 0; k < (indexed_ahead + 1) * block_pairs; ++k) listed[size + k] = listed[size - 1];
    return size;
}

/// Coordinates of pairs of which records[point * block_pairs + lane] is the vertex record of a point, each to be asked for once, in order.
template <class L>
class TransposedVertices {
public:
    FASTCCD_INLINE explicit TransposedVertices(const double* const* records) : records_{records} {}
    FASTCCD_INLINE L operator()(int c)
    {
        const int end = c / 12, point = c / 3 % 4, axis = c % 3;
        if (axis % columns == 0) Lane<L>::transpose(records_ + point * static_cast<int>(block_pairs), 3 * end + axis, columns_);
        return columns_[axis % columns];
    }

private:
    static constexpr int columns = Lane<L>::transposed_columns;
    static_assert(3 + 2 / columns * columns + columns <= static_cast<int>(vertex_record_size));

    const double* const* records_;
    L columns_[columns] = {};
};

/// What the stages read of a tile of indexed pairs. See PackedPairs for what its functions are for.
template <PairKind kind, class L>
class IndexedPairs {
public:
    static constexpr bool holds_floats = false, asks_ahead = false;
    /// Where the vertex record of x0 stands in a block of records, [4][8].
    using Place = const double* const*;

    FASTCCD_INLINE IndexedPairs(const TileRequest& tile, TileScratch& scratch)
        : source_{tile.source->indexed}, pairs_{source_.pairs + 2 * tile.first}, scratch_{scratch}, size_{list_pairs<L>(tile, scratch.listed)}
    {
        if (size_ == 0) return;
        for (std::size_t i = 0; i < indexed_ahead * block_pairs; i += block_pairs) resolve(i);
    }

    [[nodiscard]] FASTCCD_INLINE std::size_t size() const { return size_; }
    [[nodiscard]] FASTCCD_INLINE std::size_t number(std::size_t i) const { return scratch_.listed[i]; }
    [[nodiscard]] FASTCCD_INLINE L numbers(std::size_t i) const { return Lane<L>::load(&scratch_.numbers[i % group_pairs]); }

    FASTCCD_INLINE void begin_group(std::size_t /*i*/) {}
    FASTCCD_INLINE void begin_block(std::size_t i)
    {
        resolve(i + indexed_ahead * block_pairs);
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            scratch_.numbers[i % group_pairs + lane] = static_cast<double>(scratch_.listed[i + lane]);
    }
    [[nodiscard]] FASTCCD_INLINE Place place(std::size_t i) const { return &block_of(i)[0][i % block_pairs]; }
    static FASTCCD_INLINE TransposedVertices<L> coordinates(Place place) { return TransposedVertices<L>{place}; }

    FASTCCD_INLINE void meanwhile() {}

    FASTCCD_INLINE void keep_place(ScreenedQueue&, unsigned /*k*/, std::size_t /*i*/) {}
    /// Their vertices are looked up once more.
    FASTCCD_INLINE TransposedVertices<L> collected(ScreenedQueue& screened, unsigned count)
    {
        for (unsigned lane = 0; lane < Lane<L>::width; ++lane) {
            const auto number = static_cast<std::size_t>(screened.numbers[screened.size + (lane < count ? lane : count - 1)]);
            find_records<kind, false>(source_, pairs_ + 2 * number, lane, scratch_.collected_records);
        }
        return TransposedVertices<L>{scratch_.collected_records[0]};
    }
    FASTCCD_INLINE void end_group(ScreenedQueue&) {}

private:
    using Records = const double*[4][block_pairs];

    FASTCCD_INLINE Records& block_of(std::size_t i) const { return scratch_.records[i / block_pairs % record_blocks]; }

    FASTCCD_INLINE void resolve(std::size_t i)
    {
        if (rows_are_contiguous<kind>(source_))
            resolve<true>(i);
        else
            resolve<false>(i);
    }
    template <bool contiguous>
    FASTCCD_INLINE void resolve(std::size_t i)
    {
        Records& block = block_of(i);
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            find_records<kind, contiguous>(source_, pairs_ + 2 * std::size_t{scratch_.listed[i + lane]}, lane, block);
    }

    const IndexedSource source_;  ///< A copy: the compiler cannot know that nothing stored in `scratch` changes the original.
    const std::int32_t* const pairs_;
    TileScratch& scratch_;
    const std::size_t size_;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
