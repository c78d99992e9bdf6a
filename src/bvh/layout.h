// SPDX-License-Identifier: Apache-2.0
// Writing the binary tree in a device layout (kernels/shared/bvh_types.h).
#pragma once

#include "bvh/binary_tree.h"
#include "bvh/bvh.h"
#include "float_bits.h"

#include <algorithm>
#include <vector>

namespace clrt {

/// A leaf's triangles: a range of BinaryTree::order.
struct LeafRange {
    u32 first, count;
};

/// Sorts a leaf's triangles and returns how many are different: where a leaf is made from several of the
/// tree, parts of one triangle can meet in it. The different ones come first.
inline u32 sort_leaf(BinaryTree& tree, const LeafRange& leaf) {
    u32* const indices = &tree.order[leaf.first];
    std::sort(indices, indices + leaf.count);
    return u32(std::unique(indices, indices + leaf.count) - indices);
}

/// Leaf costs that suit the layouts. bvh8: one block of triangles costs as much as an eight-wide node, and
/// the collapse decides about small subtrees; bvh2: triangles are tested one by one; cwbvh: the collapse
/// decides again.
constexpr LeafCost leaf_cost(BvhLayout layout) {
    switch (layout) {
    case BvhLayout::BVH2:
        return {0, 1, BVH2_LEAF_TRIANGLES, 1.0f};
    case BvhLayout::CWBVH:
        return {0, 1, CWBVH_LEAF_TRIANGLES, 0.0f};
    case BvhLayout::BVH8:
        break;
    }
    return {3, BVH8_WIDTH / 4, BVH8_WIDTH, 0.0f};
}

/// The instance that a box of the tree is: from 1, in the order of the boxes (Instance).
inline u32 instance_at(const BinaryTree& tree, u32 place) {
    return tree.order[place] - tree.first_box + 1;
}

/// The cost that the tree will have in a layout (Bvh::sah_cost but for rounding); 0 where it is empty.
double cost_in_layout(const BinaryTree& tree, BvhLayout layout);

/// Writes the LEAF_TRIANGLE_WORDS words of a leaf triangle but for those that stay 0.
void write_leaf_triangle(const std::vector<vec4>& positions, const Triangle& triangle, u32 index, u32* words);

/// Writes the corners of some triangles into a block of bvh8, and which they are.
void write_block(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                 const u32* indices, u32 count, u32* block);

/// Fills Bvh::leaf_moves for the leaves that are written.
void write_leaf_moves(const std::vector<vec4>& moves, const std::vector<Triangle>& triangles, Bvh& bvh);

/// Fills nodes, leaves and sah_cost. Sorts the ranges of `tree.order` that become leaves.
void write_bvh8(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BinaryTree& tree,
                Bvh& bvh);
void write_bvh2(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BinaryTree& tree,
                Bvh& bvh);
void write_cwbvh(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BinaryTree& tree,
                 Bvh& bvh);

} // namespace clrt
