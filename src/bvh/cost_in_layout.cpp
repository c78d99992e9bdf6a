// SPDX-License-Identifier: Apache-2.0
// What a binary tree will cost, before anything is written.
#include "bvh/collapse.h"
#include "bvh/layout.h"

namespace clrt {
namespace {

double cost_of_binary_nodes(const BinaryTree& tree) {
    SahSum cost(BvhLayout::BVH2);
    if (tree.nodes[0].child == 0) // a leaf of a root made for it
        cost.add_node(half_area(tree.nodes[0]));
    for (u32 i = 0; i < tree.node_count; ++i) {
        const BinaryNode& node = tree.nodes[i];
        if (node.child == 0)
            cost.add_leaf(half_area(node), node.count);
        else
            cost.add_node(half_area(node));
    }
    return cost.relative_to(half_area(tree.nodes[0]));
}

} // namespace

double cost_in_layout(const BinaryTree& tree, BvhLayout layout) {
    if (tree.order.empty())
        return 0;
    switch (layout) {
    case BvhLayout::BVH2:
        return cost_of_binary_nodes(tree);
    case BvhLayout::CWBVH:
        return WideCollapse(tree, CWBVH_RULES).cost();
    case BvhLayout::BVH8:
        break;
    }
    return WideCollapse(tree, BVH8_RULES).cost();
}

} // namespace clrt
