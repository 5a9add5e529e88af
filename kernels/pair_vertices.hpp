// From a pair of indices to the vertices of a mesh.
#pragma once

#include <lane.hpp>
#include <pair_source.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

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

/// Whether rows of vertex indices follow one another without gaps.
template <PairKind kind>
FASTCCD_INLINE bool rows_are_contiguous(const IndexedSource& source)
{
    return source.column_stride == 1 && source.row_stride == (kind == PairKind::vertex_face ? 3 : 2);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
