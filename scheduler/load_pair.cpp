#include <load_pair.hpp>

#include <pair_vertices.hpp>

namespace fastccd {

namespace {

template <class T>
void load_from_view(const PairView& pairs, std::size_t i, double* coordinates, std::size_t stride)
{
    for (std::size_t c = 0; c < pair_coordinates; ++c) {
        switch (pairs.layout()) {
            case PairView::Layout::blocked:
                coordinates[c * stride] = static_cast<const T*>(pairs.data())[blocked_index(i, c)];
                break;
            case PairView::Layout::interleaved:
                coordinates[c * stride] = static_cast<const T*>(pairs.data())[i * pair_coordinates + c];
                break;
            case PairView::Layout::strided:
                coordinates[c * stride] = static_cast<const T*>(pairs.data(c))[static_cast<std::ptrdiff_t>(i) * pairs.stride()];
                break;
        }
    }
}

void load_from_mesh(PairKind kind, const IndexedSource& source, std::size_t i, double* coordinates, std::size_t stride)
{
    std::size_t vertex[4];
    if (kind == PairKind::vertex_face)
        FASTCCD_KERNEL_NAMESPACE::pair_vertices<PairKind::vertex_face, false>(source, source.pairs + 2 * i, vertex);
    else
        FASTCCD_KERNEL_NAMESPACE::pair_vertices<PairKind::edge_edge, false>(source, source.pairs + 2 * i, vertex);
    for (std::size_t point = 0; point < 4; ++point) {
        const double* const record = source.records + vertex_record_size * vertex[point];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            coordinates[(3 * point + axis) * stride] = record[axis];
            coordinates[(12 + 3 * point + axis) * stride] = record[3 + axis];
        }
    }
}

}  // namespace

void load_pair(PairKind kind, const PairSource& source, std::size_t i, double* coordinates, std::size_t stride)
{
    if (source.view == nullptr)
        load_from_mesh(kind, source.indexed, i, coordinates, stride);
    else if (source.view->scalar() == PairView::Scalar::float64)
        load_from_view<double>(*source.view, i, coordinates, stride);
    else
        load_from_view<float>(*source.view, i, coordinates, stride);
}

}  // namespace fastccd
