// SPDX-License-Identifier: Apache-2.0
// Top-down construction of the binary tree, subtrees in parallel.
#include "bvh/binary_tree.h"

#include "bvh/clip.h"
#include "bvh/reinsertion.h"
#include "bvh/spatial_split.h"
#include "bvh/tree_order.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstring>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#include <utility>

namespace clrt {
namespace {

constexpr u32 PARALLEL_SUBTREE = 1024; // items below which a subtree is not worth a task
constexpr u32 GRAIN = 4096;            // triangles prepared at a time
// Overlap of a binned split's sides, as a share of the root's surface, below which no spatial split is
// sought.
constexpr float LEAST_OVERLAP = 1e-4f;
// The same as a share of the node's surface. Reinsertion mends smaller ones: with 0.06 trees of four scenes
// took up to 2.5 times as long and were no better.
constexpr float LEAST_NODE_OVERLAP = 0.2f;

bool in_range(const vec4& p) {
    return std::abs(p.x) <= BVH_EMPTY && std::abs(p.y) <= BVH_EMPTY && std::abs(p.z) <= BVH_EMPTY;
}

bool differ(const vec4& a, const vec4& b) {
    return a.x != b.x || a.y != b.y || a.z != b.z;
}

struct Preparation {
    ItemBounds bounds;
    u32 left_out = 0;
};

// Extends a box by where a triangle's corners are when the shutter closes. True where it can be hit there. On
// the way the kernels round once, start + time * move, which stays between both ends; in double precision it
// may be half a float's step beyond.
bool extend_by_ends(const std::vector<vec4>& positions, const std::vector<vec4>& moves, const Triangle& t,
                    Box& box) {
    vec4 ends[3];
    const u32 corners[3] = {t.v0, t.v1, t.v2};
    for (int k = 0; k < 3; ++k) {
        const vec4 &p = positions[corners[k]], &move = moves[corners[k]];
        ends[k] = {p.x + move.x, p.y + move.y, p.z + move.z, 0};
        if (move.x == 0 && move.y == 0 && move.z == 0)
            continue;
        const Float4 end = box_corner(ends[k]);
        for (const float towards : {-INFINITE_FLOAT, INFINITE_FLOAT})
            box.extend(Float4{std::nextafter(end[0], towards), std::nextafter(end[1], towards),
                              std::nextafter(end[2], towards), 0});
    }
    return can_be_hit(ends[0], ends[1], ends[2]);
}

// Fills one item per triangle; a triangle that is left out gets NO_INDEX.
Preparation prepare_items(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<vec4>& moves, BuildItem* items) {
    const auto prepare = [&](const tbb::blocked_range<u32>& part, Preparation sum) {
        for (u32 i = part.begin(); i != part.end(); ++i) {
            const Triangle& t = triangles[i];
            assert(t.v0 < positions.size() && t.v1 < positions.size() && t.v2 < positions.size());
            const vec4 &a = positions[t.v0], &b = positions[t.v1], &c = positions[t.v2];
            bool usable = can_be_hit(a, b, c);
            Box box;
            for (const vec4* p : {&a, &b, &c})
                box.extend(box_corner(*p));
            if (!moves.empty())
                usable |= extend_by_ends(positions, moves, t, box);
            if (usable)
                sum.bounds.extend(box);
            else
                ++sum.left_out;
            items[i] = BuildItem(box, usable ? i : NO_INDEX);
        }
        return sum;
    };
    const auto merge = [](Preparation a, const Preparation& b) {
        a.bounds.extend(b.bounds);
        a.left_out += b.left_out;
        return a;
    };
    return tbb::parallel_reduce(tbb::blocked_range<u32>(0, u32(triangles.size()), GRAIN), Preparation(),
                                prepare, merge);
}

// Appends an item for each box behind those of the triangles.
void add_boxes(const std::vector<Box>& boxes, u32 triangle_count, BuildItem* items, ItemBounds& bounds) {
    for (size_t i = 0; i < boxes.size(); ++i) {
        bounds.extend(boxes[i]);
        items[triangle_count + i] = BuildItem(boxes[i], triangle_count + u32(i));
    }
}

// Levels that `count` triangles need when every split is at the median.
int levels_needed(u32 count, u32 max_leaf) {
    int levels = 1;
    for (u32 leaves = (count + max_leaf - 1) / max_leaf; leaves > 1; leaves = (leaves + 1) / 2)
        ++levels;
    return levels;
}

// The items of a node, and the room behind them that spatial splits may fill with more.
struct ItemRange {
    u32 begin, count, spare;
};

class Builder {
public:
    // Without a mesh there are no spatial splits; items from `first_box` on are boxes; `leaf_begins` gets
    // where each leaf's items begin.
    Builder(BuildItem* items, BinaryNode* nodes, const LeafCost& leaf_cost, const TriangleCorners* mesh,
            u32 first_box, u32* leaf_begins)
        : items_(items), nodes_(nodes), leaf_cost_(leaf_cost), mesh_(mesh), first_box_(first_box),
          leaf_begins_(leaf_begins) {}

    void build_root(const ItemRange& range, const ItemBounds& bounds) {
        const Float4 edge = bounds.box.upper - bounds.box.lower;
        root_scale_ =
            std::min(1.0f / std::max({edge[0], edge[1], edge[2]}), std::numeric_limits<float>::max());
        least_overlap_ = LEAST_OVERLAP * half_area(bounds.box, root_scale_);
        build(0, range, bounds, 1);
    }

    u32 node_count() const { return node_count_; }

private:
    void build(u32 node_index, ItemRange range, const ItemBounds& bounds, int level) {
        BinaryNode& node = nodes_[node_index];
        for (int axis = 0; axis < 3; ++axis) {
            node.lower[axis] = bounds.box.lower[axis];
            node.upper[axis] = bounds.box.upper[axis];
        }
        node.child = 0;
        SplitSides sides;
        const bool is_leaf = !split(range, bounds, level, sides);
        node.count = range.count;
        if (is_leaf) {
            leaf_begins_[node_index] = range.begin;
            return;
        }
        const u32 child = node_count_.fetch_add(2, std::memory_order_relaxed);
        node.child = child;
        const auto [left, right] = divide(range, sides.left_count);
        const auto build_left = [&, left = left] { build(child, left, sides.left, level + 1); };
        const auto build_right = [&, right = right] { build(child + 1, right, sides.right, level + 1); };
        if (range.count < PARALLEL_SUBTREE) {
            build_left();
            build_right();
        } else {
            tbb::parallel_invoke(build_left, build_right);
        }
    }

    // Splits the items, or returns false where a leaf is cheaper. A spatial split makes them more.
    bool split(ItemRange& range, const ItemBounds& bounds, int level, SplitSides& sides) {
        BuildItem* const items = items_ + range.begin;
        const u32 count = range.count;
        const bool may_be_leaf = count <= leaf_cost_.max_leaf && (count == 1 || !holds_box(items, count));
        if (may_be_leaf && count <= leaf_cost_.min_leaf)
            return false;
        const BinMap map(bounds.centres, count);
        const BinnedSplit best = find_split(items, count, bounds, map, leaf_cost_);
        if (try_spatial_split(range, bounds.box, best, level, sides))
            return true;
        // Both sides must be able to finish within the levels that are left.
        const bool allowed =
            best.axis >= 0 && fits(std::max(best.left_count, count - best.left_count), level);
        if (may_be_leaf && (!allowed || best.leaf_cost <= best.cost))
            return false;
        sides =
            allowed ? apply_split(items, count, map, best) : split_at_median(items, count, bounds.centres);
        return true;
    }

    // A spatial split where the sides of the best binned split overlap so much that one may pay (section 4.5
    // of Stich et al. 2009), and only as long as there is room for the parts.
    bool try_spatial_split(ItemRange& range, const Box& box, const BinnedSplit& best, int level,
                           SplitSides& sides) {
        if (!mesh_ || range.spare == 0 || (best.axis >= 0 && !overlap(best, box)))
            return false;
        BuildItem* const items = items_ + range.begin;
        const SpatialSplit spatial =
            find_spatial_split(*mesh_, items, range.count, range.spare, box, leaf_cost_);
        const float least =
            range.count <= leaf_cost_.max_leaf ? std::min(best.cost, best.leaf_cost) : best.cost;
        if (spatial.axis < 0 || !(spatial.cost < least) ||
            !fits(std::max(spatial.left_count, spatial.right_count), level))
            return false;
        const SpatialSides applied =
            apply_spatial_split(*mesh_, items, range.count, box, spatial, leaf_cost_);
        // No item was cut where one side holds all.
        if (applied.sides.left_count == 0 || applied.right_count == 0)
            return false;
        const u32 count = applied.sides.left_count + applied.right_count;
        range.spare -= count - range.count;
        range.count = count;
        sides = applied.sides;
        return true;
    }

    bool holds_box(const BuildItem* items, u32 count) const {
        return first_box_ != NO_INDEX && std::any_of(items, items + count, [&](const BuildItem& item) {
                   return item.triangle() >= first_box_;
               });
    }

    bool overlap(const BinnedSplit& split, const Box& box) const {
        Box common;
        common.lower = lane_max(split.left.lower, split.right.lower);
        common.upper = lane_min(split.left.upper, split.right.upper);
        if (is_empty(common))
            return false;
        const float area = half_area(common, root_scale_);
        return area > least_overlap_ && area > LEAST_NODE_OVERLAP * half_area(box, root_scale_);
    }

    // Whether a side of so many items can be finished by medians within the levels below this one.
    bool fits(u32 count, int level) const {
        if (first_box_ != NO_INDEX)
            return levels_needed(count, 1) < BVH_MAX_DEPTH - level; // BinaryTree::most_levels
        return levels_needed(count, leaf_cost_.max_leaf) <= BVH_MAX_DEPTH - level;
    }

    // Shares the room behind the items by their number and moves the right ones behind the left ones' share.
    std::pair<ItemRange, ItemRange> divide(const ItemRange& range, u32 left_count) {
        const u32 right_count = range.count - left_count;
        const u32 left_spare = u32(size_t(range.spare) * left_count / range.count);
        BuildItem* const right = items_ + range.begin + left_count;
        if (left_spare > 0)
            std::memmove(static_cast<void*>(right + left_spare), right, right_count * sizeof *right);
        return {{range.begin, left_count, left_spare},
                {range.begin + left_count + left_spare, right_count, range.spare - left_spare}};
    }

    BuildItem* items_;
    BinaryNode* nodes_;
    LeafCost leaf_cost_;
    const TriangleCorners* mesh_;
    u32 first_box_;
    u32* leaf_begins_;
    float root_scale_ = 1, least_overlap_ = 0;
    std::atomic<u32> node_count_{1};
};

} // namespace

// Where two corners agree no ray hits: two edges are one and the same, which the neighbours share. Corners in
// line may close a seam: for a ray, which rounds each corner on its own, they are no longer in line, and only
// this triangle fills the gap between an edge on one side and its two parts on the other.
bool can_be_hit(const vec4& a, const vec4& b, const vec4& c) {
    return in_range(a) && in_range(b) && in_range(c) && differ(a, b) && differ(b, c) && differ(c, a);
}

double half_area(const float* lower, const float* upper) {
    const double x = double(upper[0]) - lower[0];
    const double y = double(upper[1]) - lower[1];
    const double z = double(upper[2]) - lower[2];
    return x * y + y * z + z * x;
}

BinaryTree build_binary_tree(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                             const LeafCost& leaf_cost, const TreeEffort& effort,
                             const std::vector<vec4>& moves, const std::vector<Box>& boxes) {
    assert((moves.empty() && boxes.empty()) || !effort.spatial_splits);
    const size_t capacity = effort.spatial_splits
                                ? std::min(size_t(double(triangles.size()) * MOST_REFERENCES), MOST_TRIANGLES)
                                : triangles.size() + boxes.size();
    // Uninitialised: each page is first touched by the thread that fills it.
    std::unique_ptr<BuildItem[]> items(new BuildItem[capacity]);
    Preparation prepared = prepare_items(positions, triangles, moves, items.get());
    add_boxes(boxes, u32(triangles.size()), items.get(), prepared.bounds);
    BuildItem* items_end = items.get() + triangles.size() + boxes.size();
    if (prepared.left_out > 0)
        items_end = std::remove_if(items.get(), items_end,
                                   [](const BuildItem& i) { return i.triangle() == NO_INDEX; });
    const u32 count = u32(items_end - items.get());

    BinaryTree tree;
    tree.triangle_count = count - u32(boxes.size());
    tree.first_box = boxes.empty() ? NO_INDEX : u32(triangles.size());
    if (count == 0)
        return tree;
    // At most two nodes an item; the part that is not used is never touched and takes no memory.
    tree.nodes.reset(new BinaryNode[2 * capacity]);
    std::unique_ptr<u32[]> leaf_begins(new u32[2 * capacity]);
    const TriangleCorners mesh{positions, triangles};
    Builder builder(items.get(), tree.nodes.get(), leaf_cost, effort.spatial_splits ? &mesh : nullptr,
                    tree.first_box, leaf_begins.get());
    builder.build_root({0, count, u32(effort.spatial_splits ? capacity : count) - count}, prepared.bounds);
    tree.node_count = builder.node_count();
    const auto triangle_at = [&](u32 item) { return items[item].triangle(); };
    put_in_order(tree, leaf_begins.get(), triangle_at);
    items.reset();
    leaf_begins.reset();
    reinsert_subtrees(tree, effort.reinsertion_rounds);
    return tree;
}

} // namespace clrt
