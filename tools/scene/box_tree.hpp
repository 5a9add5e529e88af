// A static tree over axis-aligned boxes that answers: which boxes overlap this one?
//
// Eight children a node, stored lane by lane, so that SIMD comparisons test them side by side. The
// tree is implicit, as in packed R-trees (Roussopoulos and Leifker 1985): boxes are put into an
// order in which neighbours are close, then every eight boxes make a leaf, every eight nodes a
// parent, and child k of node i is node 8 i + k one level down. The order comes from median splits
// along the widest axis of the box centres, which unlike space-filling curves on a grid does not
// degrade when one box lies far away from all others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "id_sorter.hpp"

namespace fastccd::tools {

/// A closed axis-aligned box. Boxes with a bound that is not finite overlap nothing.
struct Box {
    std::array<double, 3> low;
    std::array<double, 3> high;
};

/// True if every bound is a finite number.
[[nodiscard]] bool is_finite(const Box& box);

class BoxTree {
public:
    /// Buffers of one thread, reused from query to query: about 6 bytes for each box in the tree.
    class Scratch {
    public:
        explicit Scratch(const BoxTree& tree);

    private:
        friend class BoxTree;
        std::vector<std::int32_t> nodes_;
        std::vector<std::int32_t> children_;
        std::vector<std::int32_t> ids_;
        IdSorter sorter_;
    };

    /// Builds the tree, in parallel in the caller's TBB arena. A box's id is its position in
    /// `boxes`, of which there are at most 2^31 - 1.
    explicit BoxTree(std::span<const Box> boxes);

    /// The ids greater than `after` of the boxes that overlap `query`, compared as closed boxes in
    /// double precision, in ascending order. `query` is finite. The result lives in `scratch`,
    /// may be changed in place, and is valid until the next call with it.
    std::span<std::int32_t> overlapping(const Box& query, std::int32_t after,
                                        Scratch& scratch) const;

private:
    static constexpr std::size_t width = 8;
    using Lanes = std::array<double, width>;
    using Names = std::array<std::int32_t, width>;

    // The boxes of eight children (in level 0: eight boxes proper) as structure of arrays.
    struct alignas(64) Node {
        std::array<Lanes, 3> low;
        std::array<Lanes, 3> high;
        Names largest_id;  // in the child, -1 in lanes without one
    };

    static std::size_t find_children(const Node& node, const Box& query, std::int32_t after,
                                     const Names& names, std::int32_t* out);

    // Leaves first, then up to a single root; empty without boxes.
    std::vector<std::vector<Node>> levels_;
    std::size_t box_count_;
};

}  // namespace fastccd::tools
