// SPDX-License-Identifier: Apache-2.0
// Top-down construction of the binary tree, subtrees in parallel.
#include "bvh/binary_tree.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

constexpr u32 PARALLEL_SUBTREE = 1024; // items below which a subtree is not worth a task
constexpr u32 GRAIN = 4096;            // triangles prepared at a time

bool in_range(const vec4& p) {
    return std::abs(p.x) <= BVH_EMPTY && std::abs(p.y) <= BVH_EMPTY && std::abs(p.z) <= BVH_EMPTY;
}

bool has_area(const vec4& a, const vec4& b, const vec4& c) {
    const double ux = double(b.x) - a.x, uy = double(b.y) - a.y, uz = double(b.z) - a.z;
    const double vx = double(c.x) - a.x, vy = double(c.y) - a.y, vz = double(c.z) - a.z;
    return uy * vz != uz * vy || uz * vx != ux * vz || ux * vy != uy * vx;
}

// Adding +0 turns -0 into +0, so that the bits of a box do not depend on the order of its corners.
Float4 corner(const vec4& p) {
    return Float4{p.x, p.y, p.z, 0} + splat(0);
}

struct Preparation {
    ItemBounds bounds;
    u32 left_out = 0;
};

// Fills one item per triangle; a triangle that is left out gets NO_INDEX.
Preparation prepare_items(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                          BuildItem* items) {
    const auto prepare = [&](const tbb::blocked_range<u32>& part, Preparation sum) {
        for (u32 i = part.begin(); i != part.end(); ++i) {
            const Triangle& t = triangles[i];
            assert(t.v0 < positions.size() && t.v1 < positions.size() && t.v2 < positions.size());
            const vec4 &a = positions[t.v0], &b = positions[t.v1], &c = positions[t.v2];
            const bool usable = in_range(a) && in_range(b) && in_range(c) && has_area(a, b, c);
            Box box;
            for (const vec4* p : {&a, &b, &c})
                box.extend(corner(*p));
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

// Levels that `count` triangles need when every split is at the median.
int levels_needed(u32 count, u32 max_leaf) {
    int levels = 1;
    for (u32 leaves = (count + max_leaf - 1) / max_leaf; leaves > 1; leaves = (leaves + 1) / 2)
        ++levels;
    return levels;
}

class Builder {
public:
    Builder(BuildItem* items, BinaryNode* nodes, const LeafCost& leaf_cost)
        : items_(items), nodes_(nodes), leaf_cost_(leaf_cost) {}

    // Builds the subtree over `count` items from `begin` on and returns the number of its deepest level.
    int build(u32 node_index, u32 begin, u32 count, const ItemBounds& bounds, int level) {
        BinaryNode& node = nodes_[node_index];
        for (int axis = 0; axis < 3; ++axis) {
            node.lower[axis] = bounds.box.lower[axis];
            node.upper[axis] = bounds.box.upper[axis];
        }
        node.count = count;
        node.child = 0;
        SplitSides sides;
        if (!split(items_ + begin, count, bounds, level, sides))
            return level;

        const u32 child = node_count_.fetch_add(2, std::memory_order_relaxed);
        node.child = child;
        int left_depth = 0, right_depth = 0;
        const auto build_left = [&] {
            left_depth = build(child, begin, sides.left_count, sides.left, level + 1);
        };
        const auto build_right = [&] {
            right_depth =
                build(child + 1, begin + sides.left_count, count - sides.left_count, sides.right, level + 1);
        };
        if (count < PARALLEL_SUBTREE) {
            build_left();
            build_right();
        } else {
            tbb::parallel_invoke(build_left, build_right);
        }
        return std::max(left_depth, right_depth);
    }

    u32 node_count() const { return node_count_; }

private:
    // Splits the items, or returns false where a leaf is cheaper.
    bool split(BuildItem* items, u32 count, const ItemBounds& bounds, int level, SplitSides& sides) {
        if (count <= leaf_cost_.min_leaf)
            return false;
        const BinMap map(bounds.centres, count);
        const BinnedSplit best = find_split(items, count, bounds, map, leaf_cost_);
        // Both sides must be able to finish within the levels that are left.
        const u32 larger = std::max(best.left_count, count - best.left_count);
        const bool allowed =
            best.axis >= 0 && levels_needed(larger, leaf_cost_.max_leaf) <= BVH_MAX_DEPTH - level;
        if (count <= leaf_cost_.max_leaf && (!allowed || best.leaf_cost <= best.cost))
            return false;
        sides =
            allowed ? apply_split(items, count, map, best) : split_at_median(items, count, bounds.centres);
        return true;
    }

    BuildItem* items_;
    BinaryNode* nodes_;
    LeafCost leaf_cost_;
    std::atomic<u32> node_count_{1};
};

} // namespace

double half_area(const BinaryNode& node) {
    const double x = double(node.upper[0]) - node.lower[0];
    const double y = double(node.upper[1]) - node.lower[1];
    const double z = double(node.upper[2]) - node.lower[2];
    return x * y + y * z + z * x;
}

BinaryTree build_binary_tree(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                             const LeafCost& leaf_cost) {
    // Uninitialised: each page is first touched by the thread that fills it.
    std::unique_ptr<BuildItem[]> items(new BuildItem[triangles.size()]);
    const Preparation prepared = prepare_items(positions, triangles, items.get());
    BuildItem* items_end = items.get() + triangles.size();
    if (prepared.left_out > 0)
        items_end = std::remove_if(items.get(), items_end,
                                   [](const BuildItem& i) { return i.triangle() == NO_INDEX; });
    const u32 count = u32(items_end - items.get());

    BinaryTree tree;
    if (count == 0)
        return tree;
    // At most two nodes a triangle; the part that is not used is never touched and takes no memory.
    tree.nodes.reset(new BinaryNode[2 * size_t(count)]);
    Builder builder(items.get(), tree.nodes.get(), leaf_cost);
    tree.depth = builder.build(0, 0, count, prepared.bounds, 1);
    tree.node_count = builder.node_count();

    tree.order.resize(count);
    tbb::parallel_for(tbb::blocked_range<u32>(0, count, GRAIN), [&](const tbb::blocked_range<u32>& part) {
        for (u32 i = part.begin(); i != part.end(); ++i)
            tree.order[i] = items[i].triangle();
    });
    return tree;
}

} // namespace clrt
