// SPDX-License-Identifier: Apache-2.0
// Pairs of children in 64 bytes over runs of up to four triangles.
#include "bvh/layout.h"
#include "bvh/sah_cost.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

void write_child(u32* node, int child, const float* lower, const float* upper, u32 reference, u32 count) {
    for (int axis = 0; axis < 3; ++axis) {
        u32* planes = axis < 2 ? node + 4 * child + 2 * axis : node + 8 + 2 * child;
        planes[0] = float_bits(lower[axis]);
        planes[1] = float_bits(upper[axis]);
    }
    node[BVH2_CHILD_WORD + child] = reference;
    node[BVH2_COUNT_WORD + child] = count;
}

// Appends a node with two empty children and returns its index.
u32 append_bvh2_node(std::vector<u32>& nodes) {
    const u32 index = u32(nodes.size() / BVH2_NODE_WORDS);
    nodes.resize(nodes.size() + BVH2_NODE_WORDS);
    const float lower[3] = {BVH_EMPTY, BVH_EMPTY, BVH_EMPTY}, upper[3] = {-BVH_EMPTY, -BVH_EMPTY, -BVH_EMPTY};
    for (int child = 0; child < 2; ++child)
        write_child(&nodes[size_t(index) * BVH2_NODE_WORDS], child, lower, upper, BVH_LEAF_BIT, 0);
    return index;
}

// Writes all nodes depth first and returns the leaves. The leaf triangles keep the order of the tree's.
std::vector<LeafRange> write_bvh2_nodes(const BinaryTree& tree, Bvh& bvh) {
    struct Pending {
        u32 subtree, first; // binary node and where its triangles begin
        u32 parent;         // node to enter it into
        int child;
    };
    const BinaryNode* binary = tree.nodes.get();
    SahSum cost(BvhLayout::BVH2);
    std::vector<LeafRange> leaves;
    std::vector<Pending> stack;
    const auto push_children = [&](u32 subtree, u32 first, u32 node) {
        const u32 left = binary[subtree].child;
        cost.add_node(half_area(binary[subtree]));
        stack.push_back({left + 1, first + binary[left].count, node, 1});
        stack.push_back({left, first, node, 0});
    };
    const u32 root = append_bvh2_node(bvh.nodes);
    if (binary[0].child == 0) {
        cost.add_node(half_area(binary[0]));
        stack.push_back({0, 0, root, 0});
    } else {
        push_children(0, 0, root);
    }
    while (!stack.empty()) {
        const Pending p = stack.back();
        stack.pop_back();
        const BinaryNode& b = binary[p.subtree];
        const bool is_leaf = b.child == 0;
        if (is_leaf && tree.order[p.first] >= tree.first_box) {
            write_child(&bvh.nodes[size_t(p.parent) * BVH2_NODE_WORDS], p.child, b.lower, b.upper,
                        BVH_INSTANCE_BIT | instance_at(tree, p.first), 0);
            cost.add_leaf(half_area(b), 1);
            continue;
        }
        const u32 reference = is_leaf ? BVH_LEAF_BIT | p.first : append_bvh2_node(bvh.nodes);
        write_child(&bvh.nodes[size_t(p.parent) * BVH2_NODE_WORDS], p.child, b.lower, b.upper, reference,
                    is_leaf ? b.count : 0);
        if (is_leaf) {
            leaves.push_back({p.first, b.count});
            cost.add_leaf(half_area(b), b.count);
        } else {
            push_children(p.subtree, p.first, reference);
        }
    }
    bvh.sah_cost = cost.relative_to(half_area(binary[0]));
    return leaves;
}

} // namespace

void write_bvh2(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BinaryTree& tree,
                Bvh& bvh) {
    if (tree.order.empty()) {
        append_bvh2_node(bvh.nodes);
        return;
    }
    const std::vector<LeafRange> leaves = write_bvh2_nodes(tree, bvh);
    bvh.leaves.resize(tree.order.size() * LEAF_TRIANGLE_WORDS, 0u);
    tbb::parallel_for(size_t(0), leaves.size(), [&](size_t i) {
        const LeafRange& leaf = leaves[i];
        std::sort(&tree.order[leaf.first], &tree.order[leaf.first] + leaf.count);
        for (u32 k = leaf.first; k < leaf.first + leaf.count; ++k)
            write_leaf_triangle(positions, triangles[tree.order[k]], tree.order[k],
                                &bvh.leaves[size_t(k) * LEAF_TRIANGLE_WORDS]);
    });
}

} // namespace clrt
