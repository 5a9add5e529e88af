// Blocks of 8 pairs in the native layout, from any layout a PairView can have.
#pragma once

#include <cstddef>

#include <fastccd/options.hpp>
#include <fastccd/pair_view.hpp>
#include <kernel_table.hpp>
#include <lane.hpp>
#include <pair_source.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Transposes up to 8 records of 24 doubles into [24][8]; lanes past `count` repeat the last record.
template <class Batch>
FASTCCD_INLINE void pack_interleaved(const double* records, std::size_t count, double* block)
{
    constexpr std::size_t part = 6;  // what Lane::transpose_records takes
    for (std::size_t lane = 0; lane < block_pairs; lane += Lane<Batch>::transposed_records)
        for (std::size_t c = 0; c < pair_coordinates; c += part) {
            const double* parts[Lane<Batch>::transposed_records];
            for (std::size_t k = 0; k < Lane<Batch>::transposed_records; ++k)
                parts[k] = records + (lane + k < count ? lane + k : count - 1) * pair_coordinates + c;
            Lane<Batch>::transpose_records(parts, block + c * block_pairs + lane, block + (c + 3) * block_pairs + lane, block_pairs);
        }
}

/// The same for records of 24 floats; `wide` has room for 8 records.
template <class Batch>
FASTCCD_INLINE void pack_interleaved(const float* records, std::size_t count, double* wide, double* block)
{
    for (std::size_t k = 0; k < count * pair_coordinates; ++k) wide[k] = static_cast<double>(records[k]);
    pack_interleaved<Batch>(wide, count, block);
}

template <class T>
FASTCCD_INLINE void pack_strided(const PairView& pairs, std::size_t first, std::size_t count, double* block)
{
    const std::ptrdiff_t stride = pairs.stride();
    for (std::size_t c = 0; c < pair_coordinates; ++c) {
        const T* const data = static_cast<const T*>(pairs.data(c)) + static_cast<std::ptrdiff_t>(first) * stride;
        double* const row = block + c * block_pairs;
        if (stride == 1 && count == block_pairs)  // all at once
            for (std::size_t lane = 0; lane < block_pairs; ++lane) row[lane] = static_cast<double>(data[lane]);
        else
            for (std::size_t lane = 0; lane < block_pairs; ++lane)
                row[lane] = static_cast<double>(data[static_cast<std::ptrdiff_t>(lane < count ? lane : count - 1) * stride]);
    }
}

FASTCCD_INLINE void widen_block(const float* data, double* block)
{
    for (std::size_t k = 0; k < block_coordinates; ++k) block[k] = static_cast<double>(data[k]);
}

/// Vertex indices x0..x3 of one pair {first, second}. `contiguous`: rows follow one another without gaps.
template <PairKind kind, bool contiguous>
FASTCCD_INLINE void pair_vertices(const IndexedSource& source, const std::int32_t* pair, std::size_t (&vertex)[4])
{
    constexpr std::ptrdiff_t columns = kind == PairKind::vertex_face ? 3 : 2;
    const auto of = [&](std::int32_t primitive, int corner) FASTCCD_INLINE_LAMBDA {
        const std::ptrdiff_t at = contiguous ? primitive * columns + corner
                                             : primitive * source.row_stride + corner * source.column_stride;
        return static_cast<std::size_t>(source.primitives[at]);
    };
    if constexpr (kind == PairKind::vertex_face) {
        vertex[0] = static_cast<std::size_t>(pair[0]);
        vertex[1] = of(pair[1], 0);
        vertex[2] = of(pair[1], 1);
        vertex[3] = of(pair[1], 2);
    } else {
        vertex[0] = of(pair[0], 0);
        vertex[1] = of(pair[0], 1);
        vertex[2] = of(pair[1], 0);
        vertex[3] = of(pair[1], 1);
    }
}

template <PairKind kind>
FASTCCD_INLINE bool rows_are_contiguous(const IndexedSource& source)
{
    return source.column_stride == 1 && source.row_stride == (kind == PairKind::vertex_face ? 3 : 2);
}

inline constexpr std::size_t vertex_record_size = 8;

/// Finds the vertex records of 8 of the pairs at `pairs`, and asks for them.
template <PairKind kind, bool contiguous>
FASTCCD_INLINE void resolve_pairs(const IndexedSource& source, const std::int32_t* pairs, const std::uint16_t* listed,
                                  const double* (&records)[4][block_pairs])
{
    // A copy, because the compiler cannot know that nothing stored below changes the original.
    const IndexedSource local = source;
    for (std::size_t lane = 0; lane < block_pairs; ++lane) {
        std::size_t vertex[4];
        pair_vertices<kind, contiguous>(local, pairs + 2 * std::size_t{listed[lane]}, vertex);
        for (int point = 0; point < 4; ++point) {
            const double* const record = local.records + vertex[point] * vertex_record_size;
            __builtin_prefetch(record);
            records[point][lane] = record;
        }
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

/// Whole vertex records of `lanes` pairs, transposed in registers to [24][lanes].
template <class Batch, std::size_t lanes>
FASTCCD_INLINE void transpose_block(const double* const (&records)[4][lanes], double* block)
{
    for (std::size_t lane = 0; lane < lanes; lane += Lane<Batch>::transposed_records)
        for (std::size_t point = 0; point < 4; ++point)
            Lane<Batch>::transpose_records(&records[point][lane], block + 3 * point * lanes + lane,
                                           block + (12 + 3 * point) * lanes + lane, lanes);
}

/// Asks for packed pairs ahead of the block being read, and nowhere else: in the later stages it only takes time. The loop is
/// not unrolled, because lines are to be asked for slowly: in bursts they keep the core from going on (bench/README.md).
class Prefetcher {
public:
    FASTCCD_INLINE Prefetcher(const PairSource& source, std::size_t first)
    {
        if (source.view == nullptr) return;
        const PairView& pairs = *source.view;
        const std::size_t number = pairs.scalar() == PairView::Scalar::float64 ? sizeof(double) : sizeof(float);
        if (pairs.layout() == PairView::Layout::strided) {
            strided_ = &pairs;
            element_ = static_cast<std::ptrdiff_t>(number) * pairs.stride();
            last_ = static_cast<std::ptrdiff_t>(source.size) - 1;
            return;
        }
        const std::size_t pair = pair_coordinates * number;
        const auto* const data = static_cast<const std::byte*>(pairs.data());
        next_ = data + first * pair;
        end_ = data + source.size * pair;
    }

    /// Before the block that starts at pair `i` of the source, at `address` unless the layout is strided, is read.
    FASTCCD_INLINE void at_block(std::size_t i, const void* address)
    {
        if (strided_ != nullptr) {
            // Of three lanes for the x, y and z of a point, so that triples, of stride 3, get all of their three lines.
            constexpr auto ahead = static_cast<std::ptrdiff_t>(bytes_ahead / (block_coordinates * sizeof(double)) * block_pairs);
            for (std::size_t c = 0; c < pair_coordinates; ++c) {
                const std::ptrdiff_t pair = static_cast<std::ptrdiff_t>(i) + ahead + 3 * static_cast<std::ptrdiff_t>(c % 3);
                __builtin_prefetch(static_cast<const std::byte*>(strided_->data(c)) + element_ * (pair < last_ ? pair : last_));
            }
        } else if (end_ != nullptr) {
            const auto* const at = static_cast<const std::byte*>(address);
            const std::byte* const until = static_cast<std::size_t>(end_ - at) > bytes_ahead ? at + bytes_ahead : end_;
            const std::byte* next = next_;
#pragma GCC unroll 1
            for (; next < until; next += line) __builtin_prefetch(next);
            next_ = next;
        }
    }

private:
    static constexpr std::size_t line = 64;
    static constexpr std::size_t bytes_ahead = 8 * block_coordinates * sizeof(double);  ///< 8 blocks of doubles.

    const std::byte* next_ = nullptr;
    const std::byte* end_ = nullptr;
    const PairView* strided_ = nullptr;
    std::ptrdiff_t element_ = 0, last_ = 0;  ///< Bytes from a pair's coordinate to the next one's; the last pair.
};

/// What the stages read of a tile: its pairs in blocks of the native layout; of indexed pairs those alone that their boxes do
/// not keep apart.
template <PairKind kind, class Batch>
class BlockSource {
public:
    FASTCCD_INLINE BlockSource(const TileRequest& tile, TileScratch& scratch)
        : tile_{tile}, scratch_{scratch}, indexed_{tile.source->view == nullptr},
          size_{indexed_ ? list_pairs<Batch>(tile, scratch.listed) : tile.count},
          prefetcher_{*tile.source, tile.first}
    {
        if (!indexed_ || size_ == 0) return;
        for (std::size_t i = 0; i < indexed_ahead * block_pairs; i += block_pairs) resolve(i);
    }

    [[nodiscard]] FASTCCD_INLINE std::size_t size() const { return size_; }

    /// Number in the tile of pair `i` of this source, and of the pairs from `i` on, in the block read last.
    [[nodiscard]] FASTCCD_INLINE std::size_t number(std::size_t i) const { return indexed_ ? scratch_.listed[i] : i; }
    [[nodiscard]] FASTCCD_INLINE Batch numbers(std::size_t i) const
    {
        return indexed_ ? Lane<Batch>::load(&scratch_.numbers[i % group_pairs])
                        : broadcast<Batch>(static_cast<double>(i)) + Lane<Batch>::lane_number();
    }

    /// The block that starts at pair `i`, a multiple of 8; the last pair stands for those past the end. Zero-copy for blocked
    /// double; otherwise one of scratch.blocks is filled and returned. Blocks are to be read in order.
    FASTCCD_INLINE const double* block(std::size_t i)
    {
        return indexed_ ? transposed(i) : native(i);
    }

private:
    FASTCCD_INLINE double* filled(std::size_t i) { return scratch_.blocks[i / block_pairs % (group_pairs / block_pairs)]; }
    FASTCCD_INLINE auto& records(std::size_t i) { return scratch_.records[i / block_pairs % (indexed_ahead + 1)]; }

    FASTCCD_INLINE void resolve(std::size_t i)
    {
        const IndexedSource& source = tile_.source->indexed;
        const std::int32_t* const pairs = source.pairs + 2 * tile_.first;
        if (rows_are_contiguous<kind>(source))
            resolve_pairs<kind, true>(source, pairs, scratch_.listed + i, records(i));
        else
            resolve_pairs<kind, false>(source, pairs, scratch_.listed + i, records(i));
    }

    FASTCCD_INLINE const double* transposed(std::size_t i)
    {
        resolve(i + indexed_ahead * block_pairs);
        transpose_block<Batch>(records(i), filled(i));
        for (std::size_t lane = 0; lane < block_pairs; ++lane)
            scratch_.numbers[i % group_pairs + lane] = static_cast<double>(scratch_.listed[i + lane]);
        return filled(i);
    }

    FASTCCD_INLINE const double* native(std::size_t i)
    {
        const PairView& pairs = *tile_.source->view;
        const std::size_t first = tile_.first + i, offset = first * pair_coordinates;
        const std::size_t count = size_ - i < block_pairs ? size_ - i : block_pairs;
        const bool wide = pairs.scalar() == PairView::Scalar::float64;
        double* const block = filled(i);
        const auto* const doubles = static_cast<const double*>(pairs.data()) + offset;
        const auto* const floats = static_cast<const float*>(pairs.data()) + offset;
        prefetcher_.at_block(first, wide ? static_cast<const void*>(doubles) : floats);
        switch (pairs.layout()) {
            case PairView::Layout::blocked:
                if (wide) return doubles;
                widen_block(floats, block);
                break;
            case PairView::Layout::interleaved:
                if (wide)
                    pack_interleaved<Batch>(doubles, count, block);
                else
                    pack_interleaved<Batch>(floats, count, scratch_.wide, block);
                break;
            case PairView::Layout::strided:
                if (wide)
                    pack_strided<double>(pairs, first, count, block);
                else
                    pack_strided<float>(pairs, first, count, block);
                break;
        }
        return block;
    }

    const TileRequest& tile_;
    TileScratch& scratch_;
    const bool indexed_;
    const std::size_t size_;
    Prefetcher prefetcher_;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
