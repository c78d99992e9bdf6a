// SPDX-License-Identifier: Apache-2.0
// Eight-wide nodes over blocks of up to eight triangles.
#include "bvh/collapse.h"
#include "bvh/layout.h"
#include "bvh/sah_cost.h"

#include <algorithm>
#include <tbb/parallel_for.h>
#include <tuple>

namespace clrt {
namespace {

void write_box(u32* node, int slot, const float* lower, const float* upper) {
    for (int axis = 0; axis < 3; ++axis) {
        node[(2 * axis) * BVH8_WIDTH + slot] = float_bits(lower[axis]);
        node[(2 * axis + 1) * BVH8_WIDTH + slot] = float_bits(upper[axis]);
    }
}

// Appends a node without children and returns its index.
u32 append_bvh8_node(std::vector<u32>& nodes) {
    const u32 index = u32(nodes.size() / BVH8_NODE_WORDS);
    nodes.resize(nodes.size() + BVH8_NODE_WORDS, 0u);
    u32* node = &nodes[size_t(index) * BVH8_NODE_WORDS];
    const float lower[3] = {BVH_EMPTY, BVH_EMPTY, BVH_EMPTY}, upper[3] = {-BVH_EMPTY, -BVH_EMPTY, -BVH_EMPTY};
    for (int slot = 0; slot < BVH8_WIDTH; ++slot) {
        write_box(node, slot, lower, upper);
        node[BVH8_CHILD_WORD + slot] = BVH_LEAF_BIT;
    }
    return index;
}

// The children of a wide node in the order of their lanes, which is that of bvh8_any_hit: what ends a shadow
// ray's search soonest comes first. Leaves, the largest first, since it is hit most likely; then subtrees,
// the one of fewest triangles first. (Closest hits are searched front to back and do not care.)
void sort_by_lane(const WideCollapse& collapse, const BinaryNode* binary, WideChildList& children) {
    const auto key = [&](const WideChild& child) {
        const bool leaf = collapse.is_leaf(child.node);
        return std::tuple(!leaf, leaf ? -half_area(binary[child.node]) : double(binary[child.node].count),
                          child.first);
    };
    std::sort(children.begin(), children.end(),
              [&](const WideChild& a, const WideChild& b) { return key(a) < key(b); });
}

// Writes all nodes, siblings side by side and otherwise depth first, and returns the leaves in the same
// order.
std::vector<LeafRange> write_bvh8_nodes(const BinaryTree& tree, Bvh& bvh) {
    struct Pending {
        WideChild subtree;
        u32 node;
    };
    const WideCollapse collapse(tree, BVH8_RULES);
    const BinaryNode* binary = tree.nodes.get();
    SahSum cost(BvhLayout::BVH8);
    std::vector<LeafRange> leaves;
    std::vector<Pending> stack{{{0, 0}, append_bvh8_node(bvh.nodes)}};
    while (!stack.empty()) {
        const Pending parent = stack.back();
        stack.pop_back();
        cost.add_node(half_area(binary[parent.subtree.node]));
        WideChildList children = collapse.children(parent.subtree, BVH8_RULES.max_levels);
        sort_by_lane(collapse, binary, children);
        const size_t first_pending = stack.size();
        for (int lane = 0; lane < children.size; ++lane) {
            const WideChild child = children.items[size_t(lane)];
            const BinaryNode& b = binary[child.node];
            u32 reference;
            if (tree.order[child.first] >= tree.first_box && b.count == 1) {
                reference = BVH_LEAF_BIT | BVH_INSTANCE_BIT | instance_at(tree, child.first);
                cost.add_leaf(half_area(b), 1);
            } else if (collapse.is_leaf(child.node)) {
                reference = BVH_LEAF_BIT | u32(leaves.size());
                leaves.push_back({child.first, b.count});
                cost.add_leaf(half_area(b), b.count);
            } else {
                reference = append_bvh8_node(bvh.nodes);
                stack.push_back({child, reference});
            }
            u32* node = &bvh.nodes[size_t(parent.node) * BVH8_NODE_WORDS];
            write_box(node, lane, b.lower, b.upper);
            node[BVH8_CHILD_WORD + lane] = reference;
        }
        std::reverse(stack.begin() + std::ptrdiff_t(first_pending), stack.end());
    }
    bvh.sah_cost = cost.relative_to(half_area(binary[0]));
    return leaves;
}

} // namespace

void write_block(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                 const u32* indices, u32 count, u32* block) {
    for (u32 lane = 0; lane < count; ++lane) {
        const Triangle& t = triangles[indices[lane]];
        const u32 corners[3] = {t.v0, t.v1, t.v2};
        for (int corner = 0; corner < 3; ++corner) {
            const vec4& p = positions[corners[corner]];
            block[(0 + corner) * BVH8_WIDTH + lane] = float_bits(p.x);
            block[(3 + corner) * BVH8_WIDTH + lane] = float_bits(p.y);
            block[(6 + corner) * BVH8_WIDTH + lane] = float_bits(p.z);
        }
        block[BVH8_BLOCK_ID_WORD + lane] = indices[lane];
    }
    for (u32 lane = count; lane < BVH8_WIDTH; ++lane)
        block[BVH8_BLOCK_ID_WORD + lane] = NO_INDEX;
}

void write_bvh8(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BinaryTree& tree,
                Bvh& bvh) {
    if (tree.order.empty()) {
        append_bvh8_node(bvh.nodes);
        return;
    }
    const std::vector<LeafRange> leaves = write_bvh8_nodes(tree, bvh);
    bvh.leaves.resize(leaves.size() * BVH8_BLOCK_WORDS, 0u);
    tbb::parallel_for(size_t(0), leaves.size(), [&](size_t i) {
        const u32 count = sort_leaf(tree, leaves[i]);
        write_block(positions, triangles, &tree.order[leaves[i].first], count,
                    &bvh.leaves[i * BVH8_BLOCK_WORDS]);
    });
}

} // namespace clrt
