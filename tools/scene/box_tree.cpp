#include "box_tree.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace fastccd::tools {
namespace {

// Two doubles side by side, which x86-64 and arm64 always have. As vector types of GCC and Clang,
// because g++ 12 does not turn a plain loop of such comparisons into SIMD.
using Pair [[gnu::vector_size(16)]] = double;
using Mask [[gnu::vector_size(16)]] = std::int64_t;  // of a comparison: -1 or 0

inline Pair load(const double* p)
{
    return Pair{p[0], p[1]};
}

struct Item {
    std::array<double, 3> centre;
    std::int32_t id;
};

std::size_t widest_axis(std::span<const Item> items)
{
    std::array<double, 3> low = items[0].centre;
    std::array<double, 3> high = low;
    for (const Item& item : items) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], item.centre[axis]);
            high[axis] = std::max(high[axis], item.centre[axis]);
        }
    }
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
        if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
    }
    return widest;
}

/// Orders the items so that all aligned blocks of `leaf` times a power of two are close in space.
void order_by_median_splits(std::span<Item> items, std::size_t leaf)
{
    if (items.size() <= leaf) return;
    // The largest such block that leaves something for the other side: left subtrees are full.
    const std::size_t split = leaf * std::bit_floor((items.size() - 1) / leaf);
    const std::size_t axis = widest_axis(items);
    const auto middle = items.begin() + static_cast<std::ptrdiff_t>(split);
    std::nth_element(items.begin(), middle, items.end(), [axis](const Item& a, const Item& b) {
        return a.centre[axis] < b.centre[axis];
    });
    const std::span<Item> left = items.first(split);
    const std::span<Item> right = items.subspan(split);
    constexpr std::size_t worth_a_task = 4096;
    if (items.size() < worth_a_task) {
        order_by_median_splits(left, leaf);
        order_by_median_splits(right, leaf);
    } else {
        tbb::parallel_invoke([=] { order_by_median_splits(left, leaf); },
                             [=] { order_by_median_splits(right, leaf); });
    }
}

std::vector<Item> ordered_items(std::span<const Box> boxes, std::size_t leaf)
{
    std::vector<Item> items;
    items.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!is_finite(boxes[i])) continue;
        Item item{{}, static_cast<std::int32_t>(i)};
        // Halved first: the sum of two finite bounds may overflow.
        for (std::size_t axis = 0; axis < 3; ++axis) {
            item.centre[axis] = 0.5 * boxes[i].low[axis] + 0.5 * boxes[i].high[axis];
        }
        items.push_back(item);
    }
    order_by_median_splits(items, leaf);
    return items;
}

}  // namespace

bool is_finite(const Box& box)
{
    const auto finite = [](double x) { return std::isfinite(x); };
    return std::all_of(box.low.begin(), box.low.end(), finite) &&
           std::all_of(box.high.begin(), box.high.end(), finite);
}

BoxTree::Scratch::Scratch(const BoxTree& tree) : sorter_(tree.box_count_)
{
    if (tree.levels_.empty()) return;
    // One more than there can be results: the compaction writes before it knows whether to keep.
    nodes_.resize(tree.levels_[0].size() + 1);
    children_.resize(tree.levels_[0].size() + 1);
    ids_.resize(width * tree.levels_[0].size() + 1);
}

BoxTree::BoxTree(std::span<const Box> boxes) : box_count_(boxes.size())
{
    const std::vector<Item> items = ordered_items(boxes, width);
    if (items.empty()) return;

    constexpr double infinity = std::numeric_limits<double>::infinity();
    Node empty{};
    for (Lanes& bounds : empty.low) bounds.fill(infinity);
    for (Lanes& bounds : empty.high) bounds.fill(-infinity);
    empty.largest_id.fill(-1);

    std::vector<Node>& leaves = levels_.emplace_back((items.size() + width - 1) / width, empty);
    for (std::size_t i = 0; i < items.size(); ++i) {
        Node& leaf = leaves[i / width];
        const Box& box = boxes[static_cast<std::size_t>(items[i].id)];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            leaf.low[axis][i % width] = box.low[axis];
            leaf.high[axis][i % width] = box.high[axis];
        }
        leaf.largest_id[i % width] = items[i].id;
    }
    while (levels_.back().size() > 1) {
        const std::vector<Node>& children = levels_.back();
        std::vector<Node> parents((children.size() + width - 1) / width, empty);
        for (std::size_t i = 0; i < children.size(); ++i) {
            Node& parent = parents[i / width];
            const Node& child = children[i];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                parent.low[axis][i % width] =
                    *std::min_element(child.low[axis].begin(), child.low[axis].end());
                parent.high[axis][i % width] =
                    *std::max_element(child.high[axis].begin(), child.high[axis].end());
            }
            parent.largest_id[i % width] =
                *std::max_element(child.largest_id.begin(), child.largest_id.end());
        }
        levels_.push_back(std::move(parents));
    }
}

// Writes the names of the lanes that overlap to `out` and returns how many there are. Without
// branches on the outcome, which no predictor guesses.
inline std::size_t BoxTree::find_children(const Node& node, const Box& query, std::int32_t after,
                                          const Names& names, std::int32_t* out)
{
    std::size_t count = 0;
    for (std::size_t k = 0; k < width; k += 2) {
        Mask overlap = load(&node.low[0][k]) <= query.high[0];
        overlap &= load(&node.high[0][k]) >= query.low[0];
        overlap &= load(&node.low[1][k]) <= query.high[1];
        overlap &= load(&node.high[1][k]) >= query.low[1];
        overlap &= load(&node.low[2][k]) <= query.high[2];
        overlap &= load(&node.high[2][k]) >= query.low[2];
        for (std::size_t lane = 0; lane < 2; ++lane) {
            const std::int64_t is_wanted = node.largest_id[k + lane] > after;
            out[count] = names[k + lane];
            count += static_cast<std::size_t>(overlap[lane] & is_wanted);
        }
    }
    return count;
}

std::span<std::int32_t> BoxTree::overlapping(const Box& query, std::int32_t after,
                                             Scratch& scratch) const
{
    if (levels_.empty()) return {};
    scratch.nodes_[0] = 0;
    std::size_t node_count = 1;
    for (std::size_t level = levels_.size() - 1; level > 0; --level) {
        std::size_t child_count = 0;
        for (std::size_t i = 0; i < node_count; ++i) {
            const std::int32_t node = scratch.nodes_[i];
            Names children;
            for (std::size_t k = 0; k < width; ++k) {
                children[k] = static_cast<std::int32_t>(width * static_cast<std::size_t>(node) + k);
            }
            child_count += find_children(levels_[level][static_cast<std::size_t>(node)], query,
                                         after, children, scratch.children_.data() + child_count);
        }
        scratch.nodes_.swap(scratch.children_);
        node_count = child_count;
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < node_count; ++i) {
        const Node& leaf = levels_[0][static_cast<std::size_t>(scratch.nodes_[i])];
        count += find_children(leaf, query, after, leaf.largest_id, scratch.ids_.data() + count);
    }
    const std::span<std::int32_t> ids = std::span(scratch.ids_).first(count);
    scratch.sorter_.sort(ids);
    return ids;
}

}  // namespace fastccd::tools
