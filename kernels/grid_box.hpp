// Boxes of moving primitives on a grid of integers: the linear certificate for indexed pairs, from 32 bytes a primitive that
// many pairs share, before any vertex is fetched.
//
// Along each axis the mesh, over both ends of the step, spans [centre - H, centre + H], and a coordinate x lies in the cell
//     q = floor((x - centre) * cells / H),    cells = 16000.
// The floor is taken by truncation after 2^15 is added (mesh_boxes.cpp). Difference, factor, product and that sum are rounded: in
// units of a cell the computed argument errs by less than 2 u 2^16 < 2^-35, so x lies between q - 2^-35 and q + 1 + 2^-35. The box of a
// primitive at one end of the step reaches from the least q to the largest q + 1 of its vertices. If, along one axis and in the same
// order at both ends, the first box ends below where the second begins,
//     high_a + k < low_b,    k = ceil(d * cells / H),
// then, all being integers, the primitives are farther apart than k + 1 - 2^-34 cells: farther than d by nearly a cell at both
// ends, and so throughout, because coordinates are linear in time. A cell is 2^-14 H, the pair's extent at most 2 H: the gap
// beyond d is above 2^-16 of the extent. The search for contact calls such a pair apart at first sight, because its bound for a
// gap along an axis is below 2^-48 of the extent. The search with a minimum separation asks for a gap beyond d by less than
// 2^-44 of the sum of the extents along all axes: its bound, what it adds to d, which is less than the gap and so than the
// extent, and its resolution (separation_bound.hpp). So with d > 0 an axis counts only if its H is at least shortest_axis of the
// largest: then the gap beyond d is above 2^-36 of the extent along any other.
#pragma once

#include <cstdint>

namespace fastccd {

/// What a primitive occupies at both ends of the step: lowest x y z, 0, minus the highest x y z, 0.
struct alignas(32) GridBox {
    std::int16_t start[8], end[8];
};

inline constexpr double grid_cells = 16000.0;
inline constexpr double shortest_axis = 0x1p-20;
/// More cells than there are: a separation that no gap exceeds.
inline constexpr std::int16_t beyond_grid = 32767;

/// What one call compares.
struct BoxScreen {
    const GridBox* first = nullptr;   ///< Of vertices or edges; null: no boxes.
    const GridBox* second = nullptr;  ///< Of faces or edges.
    /// The minimum separation k along x y z, 0, twice.
    alignas(16) std::int16_t separation[8] = {};
};

}  // namespace fastccd
