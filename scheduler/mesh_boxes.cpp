#include <mesh_boxes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>

#include <fastccd/aligned_doubles.hpp>
#include <parallel_ranges.hpp>

namespace fastccd {

namespace {

/// Smallest and largest of each element of the records (x y z at both ends of the step, two unused).
struct Bounds {
    double low[vertex_record_size], high[vertex_record_size];
    double not_finite = 0.0;  ///< NaN as soon as one element is not finite.

    Bounds()
    {
        std::fill_n(low, vertex_record_size, std::numeric_limits<double>::infinity());
        std::fill_n(high, vertex_record_size, -std::numeric_limits<double>::infinity());
    }

    void include(const double* record)
    {
        double sum = 0.0;
        for (std::size_t k = 0; k < vertex_record_size; ++k) {
            low[k] = record[k] < low[k] ? record[k] : low[k];
            high[k] = record[k] > high[k] ? record[k] : high[k];
            sum += record[k] - record[k];
        }
        not_finite += sum;
    }

    void include(const Bounds& other)
    {
        for (std::size_t k = 0; k < vertex_record_size; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
        not_finite += other.not_finite;
    }
};

constexpr std::size_t grain = 4096;

template <class Body>
void in_parallel(std::size_t size, const Body& body)
{
    for_each_range(size, grain, [&](const Range& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
    });
}

Bounds bounds_of(const IndexedSource& source)
{
    return reduce_ranges(
        source.vertex_count, grain, Bounds{},
        [&](const Range& range, Bounds bounds) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) bounds.include(source.records + vertex_record_size * i);
            return bounds;
        },
        [](Bounds a, const Bounds& b) {
            a.include(b);
            return a;
        });
}

struct Grid {
    double centre[3], half[3], cells_per_unit[3];

    explicit Grid(const Bounds& bounds)
    {
        for (int axis = 0; axis < 3; ++axis) {
            const double low = std::min(bounds.low[axis], bounds.low[axis + 3]);
            const double high = std::max(bounds.high[axis], bounds.high[axis + 3]);
            centre[axis] = 0.5 * low + 0.5 * high;
            // The centre is rounded: the larger half.
            half[axis] = std::max(high - centre[axis], centre[axis] - low);
            // Along an axis so short that the quotient could overflow, nothing is told apart.
            cells_per_unit[axis] = half[axis] > 0x1p-900 ? grid_cells / half[axis] : 0.0;
        }
    }

    [[nodiscard]] std::int16_t separation(double minimum, int axis) const
    {
        if (minimum == 0.0) return 0;
        if (half[axis] < shortest_axis * std::max({half[0], half[1], half[2]})) return beyond_grid;
        // Rounded up; products and quotient err by less than the factor adds.
        const double cells = std::ceil(minimum * cells_per_unit[axis] * (1.0 + 0x1p-50));
        return cells < beyond_grid ? static_cast<std::int16_t>(cells) : beyond_grid;
    }

    [[nodiscard]] std::int16_t cell(double x, int axis) const
    {
        // Truncation is floor for what is positive.
        return static_cast<std::int16_t>(static_cast<std::int32_t>((x - centre[axis]) * cells_per_unit[axis] + 0x1p15) - 0x8000);
    }
};

void put_vertex(const Grid& grid, const double* record, GridBox& box)
{
    for (int axis = 0; axis < 3; ++axis) {
        const std::int16_t start = grid.cell(record[axis], axis), end = grid.cell(record[axis + 3], axis);
        box.start[axis] = start;
        box.start[axis + 4] = static_cast<std::int16_t>(-1 - start);
        box.end[axis] = end;
        box.end[axis + 4] = static_cast<std::int16_t>(-1 - end);
    }
    box.start[3] = box.start[7] = box.end[3] = box.end[7] = 0;
}

/// The lowest of the lowest, and minus the highest of the highest.
GridBox join(const GridBox& a, const GridBox& b)
{
    GridBox box;
    for (int k = 0; k < 8; ++k) {
        box.start[k] = std::min(a.start[k], b.start[k]);
        box.end[k] = std::min(a.end[k], b.end[k]);
    }
    return box;
}

}  // namespace

struct MeshBoxes::Set {
    Grid grid;
    AlignedDoubles memory;
    const GridBox* first = nullptr;  ///< Null if a coordinate is not finite.
    const GridBox* second = nullptr;
};

namespace {

AlignedDoubles allocate_boxes(std::size_t count)
{
    static_assert(sizeof(GridBox) == 4 * sizeof(double));
    return allocate_aligned(4 * count);
}

GridBox* boxes_in(const AlignedDoubles& memory) { return reinterpret_cast<GridBox*>(memory.get()); }

}  // namespace

MeshBoxes::~MeshBoxes()
{
    for (const auto& set : sets_) delete set.load();
}

MeshBoxes::Set* MeshBoxes::make(PairKind kind, const IndexedSource& source)
{
    const std::size_t vertices = source.vertex_count, primitives = source.primitive_count;
    const Bounds bounds = bounds_of(source);
    auto set = std::make_unique<Set>(Set{Grid{bounds}, {}, nullptr, nullptr});
    if (bounds.not_finite != 0.0) return set.release();

    // Faces are compared with vertices, whose boxes are kept; those of edges are made of them.
    const bool faces = kind == PairKind::vertex_face;
    const AlignedDoubles vertices_of_edges = faces ? AlignedDoubles{} : allocate_boxes(vertices);
    set->memory = allocate_boxes(primitives + (faces ? vertices : 0));
    if (set->memory == nullptr || (!faces && vertices_of_edges == nullptr)) return nullptr;
    GridBox* const of_vertex = faces ? boxes_in(set->memory) : boxes_in(vertices_of_edges);
    GridBox* const of_primitive = boxes_in(set->memory) + (faces ? vertices : 0);
    in_parallel(vertices, [&](std::size_t i) { put_vertex(set->grid, source.records + vertex_record_size * i, of_vertex[i]); });
    in_parallel(primitives, [&](std::size_t i) {
        const std::int32_t* const row = source.primitives + static_cast<std::ptrdiff_t>(i) * source.row_stride;
        const auto corner = [&](std::ptrdiff_t k) -> const GridBox& { return of_vertex[row[k * source.column_stride]]; };
        const GridBox two = join(corner(0), corner(1));
        of_primitive[i] = faces ? join(two, corner(2)) : two;
    });
    set->first = faces ? of_vertex : of_primitive;
    set->second = of_primitive;
    return set.release();
}

BoxScreen MeshBoxes::screen(PairKind kind, const IndexedSource& source, std::size_t pairs, double minimum_separation)
{
    std::atomic<Set*>& kept = sets_[kind == PairKind::vertex_face ? 0 : 1];
    Set* set = kept.load(std::memory_order_acquire);
    if (set == nullptr) {
        // A box costs as much as one or two pairs save that are kept apart, and four in five are.
        if (pairs / 2 < source.vertex_count + source.primitive_count) return {};
        try {
            set = make(kind, source);
        } catch (...) {
            // Without boxes, then: they save time, and nothing else depends on them.
        }
        if (set == nullptr) return {};
        // Another thread may have made them meanwhile: waiting for it, inside a task, could be waiting for oneself.
        if (Set* other = nullptr; !kept.compare_exchange_strong(other, set)) {
            delete set;
            set = other;
        }
    }
    BoxScreen screen{set->first, set->second, {}};
    for (int axis = 0; axis < 3; ++axis)
        screen.separation[axis] = screen.separation[axis + 4] = set->grid.separation(minimum_separation, axis);
    return screen;
}

}  // namespace fastccd
