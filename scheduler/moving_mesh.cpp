// Vertex records and the checks of the indices.
#include <fastccd/indexed.hpp>

#include <guarded.hpp>
#include <index_check.hpp>
#include <mesh_boxes.hpp>
#include <pair_source.hpp>
#include <parallel_ranges.hpp>

namespace fastccd {

namespace {

/// First row of `rows` with a vertex that is not below `vertices`, as the error given.
Status check_rows(const IndexView& rows, int columns, std::size_t vertices, Error error)
{
    if ((rows.size > 0 && rows.data == nullptr) || exceeds_memory(rows.size, rows.row_stride, sizeof *rows.data)) return {Error::wrong_size};
    if (rows.size > 0 && exceeds_memory(static_cast<std::size_t>(columns), rows.column_stride, sizeof *rows.data)) return {Error::wrong_size};
    // As in a view whose strides were forgotten: each face would be one vertex.
    if ((rows.size > 0 && rows.column_stride == 0) || (rows.size > 1 && rows.row_stride == 0)) return {Error::wrong_size};
    for (std::size_t row = 0; row < rows.size; ++row)
        for (int column = 0; column < columns; ++column) {
            const std::int32_t vertex = rows.data[static_cast<std::ptrdiff_t>(row) * rows.row_stride + column * rows.column_stride];
            if (!in_range(vertex, vertices)) return {error, row, vertex};
        }
    return {};
}

void copy_positions(const PositionView& start, const PositionView& end, double* records)
{
    constexpr std::size_t grain = 4096;  // 256 KiB of records a task
    for_each_range(start.size(), grain, [&](const Range& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            double* const record = records + vertex_record_size * i;
            for (int axis = 0; axis < 3; ++axis) {
                record[axis] = start(i, axis);
                record[3 + axis] = end(i, axis);
            }
            record[6] = record[7] = 0.0;
        }
    });
}

}  // namespace

void ReleaseBoxes::operator()(MeshBoxes* boxes) const noexcept { delete boxes; }

MovingMesh::MovingMesh(const PositionView& start, const PositionView& end, const IndexView& faces, const IndexView& edges) noexcept
    : vertex_count_{start.size()}, faces_{faces}, edges_{edges}
{
    if (start.size() != end.size() || (start.size() > 0 && !(start.has_data() && end.has_data()))) return;
    if (exceeds_memory(vertex_count_, 3 * sizeof(float))) return;
    for (const PositionView* view : {&start, &end})
        if (exceeds_memory(vertex_count_, view->stride(), view->number_size())) return;
    status_ = check_rows(faces, 3, vertex_count_, Error::bad_face_index);
    if (status_.ok()) status_ = check_rows(edges, 2, vertex_count_, Error::bad_edge_index);
    if (!status_.ok() || vertex_count_ == 0) return;

    if (!exceeds_memory(vertex_count_, vertex_record_size * sizeof(double))) records_ = allocate_aligned(vertex_count_ * vertex_record_size);
    boxes_.reset(new (std::nothrow) MeshBoxes);
    status_ = records_ == nullptr || boxes_ == nullptr ? Status{Error::out_of_memory} : guarded([&] {
        copy_positions(start, end, records_.get());
        return Status{};
    });
}

}  // namespace fastccd
