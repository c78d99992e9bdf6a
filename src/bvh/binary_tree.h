// SPDX-License-Identifier: Apache-2.0
// The binary tree from which every layout is made.
#pragma once

#include "bvh/binned_split.h"
#include "bvh/box.h"
#include "bvh/bvh.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace clrt {

/// A node over `count` consecutive triangles of BinaryTree::order. Children are stored in pairs; where a
/// node's range begins follows from its parent's: the left child's begins there, the right child's after the
/// left's.
struct BinaryNode {
    float lower[3];
    u32 child; ///< index of the left child, the right one follows it; 0: a leaf (the root is nobody's child)
    float upper[3];
    u32 count; ///< triangles below
};

/// A tree over the usable triangles, the same for any number of threads. Node 0 is the root.
struct BinaryTree {
    std::unique_ptr<BinaryNode[]> nodes; ///< no root when `order` is empty
    u32 node_count = 0;
    std::vector<u32> order;   ///< triangle indices, leaf by leaf; with spatial splits some more than once
    u32 triangle_count = 0;   ///< different triangles in `order`
    u32 first_box = NO_INDEX; ///< in `order`, what is no triangle but a box: alone in its leaf
    int depth = 0;            ///< levels: 0 for an empty tree, 1 for a root that is a leaf

    /// How deep it may be: boxes, in leaves of their own, are a level more to bvh2, which has a bit for each.
    int most_levels() const { return first_box == NO_INDEX ? BVH_MAX_DEPTH : BVH_MAX_DEPTH - 1; }
    /// Whether the entries of `order` from `first` on hold a box.
    bool holds_box(u32 first, u32 count) const {
        return std::any_of(&order[first], &order[first] + count, [&](u32 i) { return i >= first_box; });
    }
};

/// Whether a tree holds the triangle of these corners (build_bvh says which it does).
bool can_be_hit(const vec4& a, const vec4& b, const vec4& c);

constexpr float MOST_REFERENCES = 1.5f; ///< entries in leaves per triangle; spatial splits stop there

/// So many triangles or parts of them can be told apart: indices of nodes and leaves have 31 bits, each
/// layout has at most one of either an entry, and counts are rounded up to whole blocks in 32 signed bits.
constexpr size_t MOST_TRIANGLES = BVH_LEAF_BIT - BVH8_WIDTH;

/// What goes into a binary tree besides binned SAH.
struct TreeEffort {
    bool spatial_splits = false; ///< where the sides of a binned split overlap much
    int reinsertion_rounds = 0;  ///< of reinsert_subtrees
};

/// Builds the tree by binned SAH, and by object medians where centres coincide or the depth that is left
/// demands it; then as much more as `effort` says. Leaves hold at most `leaf_cost.max_leaf` triangles. Time
/// is at most BVH_MAX_DEPTH passes.
/// Boxes enclose the ways of `moves` (bvh.h), which excludes spatial splits, as `boxes` do: each of them is
/// an entry behind the triangles in a leaf of its own.
BinaryTree build_binary_tree(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                             const LeafCost& leaf_cost, const TreeEffort& effort,
                             const std::vector<vec4>& moves = {}, const std::vector<Box>& boxes = {});

/// As build_bvh, with instances by their boxes (build_instanced_bvh).
Bvh build_bvh_with_boxes(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                         const std::vector<Box>& boxes, BvhLayout layout, BvhQuality quality,
                         const std::vector<vec4>& moves);

/// Half the surface of a box, of three coordinates each.
double half_area(const float* lower, const float* upper);
/// That of a node's box.
inline double half_area(const BinaryNode& node) {
    return half_area(node.lower, node.upper);
}

} // namespace clrt
