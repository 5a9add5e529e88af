// Vertex records and the checks of the indices.
#include <fastccd/indexed.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <index_check.hpp>

namespace fastccd {

namespace {

/// First row of `rows` with a vertex that is not below `vertices`.
Status check_rows(const IndexView& rows, int columns, std::size_t vertices)
{
    if (rows.size > 0 && rows.data == nullptr) return {Error::wrong_size};
    for (std::size_t row = 0; row < rows.size; ++row)
        for (int column = 0; column < columns; ++column) {
            const std::int32_t vertex = rows.data[static_cast<std::ptrdiff_t>(row) * rows.row_stride + column * rows.column_stride];
            if (!in_range(vertex, vertices)) return {Error::index_out_of_range, row, vertex};
        }
    return {};
}

}  // namespace

MovingMesh::MovingMesh(const PositionView& start, const PositionView& end, const IndexView& faces, const IndexView& edges)
    : vertex_count_{start.size()}, faces_{faces}, edges_{edges}
{
    if (start.size() != end.size() || (start.size() > 0 && !(start.has_data() && end.has_data()))) return;
    status_ = check_rows(faces, 3, vertex_count_);
    if (status_.ok()) status_ = check_rows(edges, 2, vertex_count_);
    if (!status_.ok() || vertex_count_ == 0) return;

    constexpr std::size_t record = 8;
    records_ = allocate_aligned(vertex_count_ * record);
    double* const records = records_.get();
    constexpr std::size_t grain = 4096;  // 256 KiB of records a task
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertex_count_, grain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                records[record * i + static_cast<std::size_t>(axis)] = start(i, axis);
                records[record * i + 3 + static_cast<std::size_t>(axis)] = end(i, axis);
            }
            records[record * i + 6] = records[record * i + 7] = 0.0;
        }
    });
}

}  // namespace fastccd
