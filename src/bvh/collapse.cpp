// SPDX-License-Identifier: Apache-2.0
// Dynamic programming over the binary tree, and the order of children.
#include "bvh/collapse.h"

#include <algorithm>
#include <tbb/parallel_invoke.h>

namespace clrt {
namespace {

constexpr u32 PARALLEL_COLLAPSE = 1u << 14; // triangles below which a subtree is not worth a task

float relative_area(const BinaryNode& node, double root_area) {
    // A root without surface: all triangles are one axis-parallel line, and every tree costs nothing.
    return root_area > 0 ? float(half_area(node) / root_area) : 0.0f;
}

} // namespace

WideCollapse::WideCollapse(const BinaryTree& tree, const WideRules& rules)
    : tree_(tree), nodes_(tree.nodes.get()), rules_(rules), root_area_(half_area(nodes_[0])),
      costs_(tree.node_count), heights_(tree.node_count),
      parted_(tree.first_box == NO_INDEX ? 0 : tree.node_count) {
    find_costs(0, 0);
}

double WideCollapse::cost() const {
    const float node_above = is_leaf(0) ? relative_area(nodes_[0], root_area_) : 0.0f;
    return double(costs_[0][0]) + double(node_above);
}

float WideCollapse::leaf_cost(u32 node) const {
    const BinaryNode& n = nodes_[node];
    return relative_area(n, root_area_) * (rules_.price.leaf + rules_.price.triangle * float(n.count));
}

bool WideCollapse::may_be_leaf(u32 node) const {
    return nodes_[node].count <= rules_.max_leaf && (parted_.empty() || !parted_[node]);
}

void WideCollapse::find_costs(u32 node, u32 first) {
    const BinaryNode& n = nodes_[node];
    Costs& costs = costs_[node];
    if (!parted_.empty() && n.count <= rules_.max_leaf)
        parted_[node] = n.count > 1 && tree_.holds_box(first, n.count);
    if (n.child == 0) {
        costs.fill(leaf_cost(node));
        return;
    }
    const u32 right = first + nodes_[n.child].count;
    if (n.count < PARALLEL_COLLAPSE) {
        find_costs(n.child, first);
        find_costs(n.child + 1, right);
    } else {
        tbb::parallel_invoke([&] { find_costs(n.child, first); }, [&] { find_costs(n.child + 1, right); });
    }
    // One child: a leaf, or a wide node of its own.
    costs[0] = relative_area(n, root_area_) + distribute(n, BVH8_WIDTH).cost;
    if (may_be_leaf(node))
        costs[0] = std::min(costs[0], leaf_cost(node));
    // More children: shared by both sides, unless fewer are cheaper.
    for (int children = 2; children < BVH8_WIDTH; ++children)
        costs[children - 1] = std::min(costs[children - 2], distribute(n, children).cost);
    if (!is_leaf(node))
        heights_[node] = std::uint8_t(1 + std::max(heights_[n.child], heights_[n.child + 1]));
}

WideCollapse::Distribution WideCollapse::distribute(const BinaryNode& node, int children) const {
    const Costs& left = costs_[node.child];
    const Costs& right = costs_[node.child + 1];
    Distribution best{left[0] + right[children - 2], 1};
    for (int i = 2; i < children; ++i) {
        const float cost = left[i - 1] + right[children - i - 1];
        if (cost < best.cost)
            best = {cost, i};
    }
    return best;
}

bool WideCollapse::is_leaf(u32 node) const {
    const BinaryNode& n = nodes_[node];
    return n.child == 0 || (may_be_leaf(node) && costs_[node][0] == leaf_cost(node));
}

void WideCollapse::expand(WideChild subtree, int children, WideChildList& list) const {
    const Costs& costs = costs_[subtree.node];
    while (children > 1 && costs[children - 2] == costs[children - 1])
        --children;
    if (children == 1) {
        list.add(subtree);
        return;
    }
    const BinaryNode& n = nodes_[subtree.node];
    const int left = distribute(n, children).left;
    expand({n.child, subtree.first}, left, list);
    expand({n.child + 1, subtree.first + nodes_[n.child].count}, children - left, list);
}

bool WideCollapse::fits(const WideChildList& list, int levels) const {
    return std::all_of(list.begin(), list.end(),
                       [&](const WideChild& child) { return heights_[child.node] <= 3 * levels; });
}

void WideCollapse::expand_levels(WideChild subtree, int levels, WideChildList& list) const {
    if (levels == 0 || is_leaf(subtree.node)) {
        list.add(subtree);
        return;
    }
    const BinaryNode& n = nodes_[subtree.node];
    expand_levels({n.child, subtree.first}, levels - 1, list);
    expand_levels({n.child + 1, subtree.first + nodes_[n.child].count}, levels - 1, list);
}

WideChildList WideCollapse::children(WideChild parent, int levels) const {
    WideChildList list;
    if (is_leaf(parent.node)) {
        list.add(parent);
        return list;
    }
    const BinaryNode& n = nodes_[parent.node];
    const int left = distribute(n, BVH8_WIDTH).left;
    expand({n.child, parent.first}, left, list);
    expand({n.child + 1, parent.first + nodes_[n.child].count}, BVH8_WIDTH - left, list);
    if (!fits(list, levels - 1)) {
        list.size = 0;
        expand_levels(parent, 3, list);
    }
    return list;
}

WideChildren WideCollapse::assign_slots(const WideChildList& list, u32 parent) const {
    // How far each child lies from the parent's centre in the direction of each slot's octant.
    float distance[BVH8_WIDTH][BVH8_WIDTH];
    const BinaryNode& p = nodes_[parent];
    for (int child = 0; child < list.size; ++child) {
        const BinaryNode& c = nodes_[list.items[child].node];
        float offset[3];
        for (int axis = 0; axis < 3; ++axis)
            offset[axis] = (c.lower[axis] - p.lower[axis]) + (c.upper[axis] - p.upper[axis]);
        for (int slot = 0; slot < BVH8_WIDTH; ++slot) {
            distance[child][slot] = 0;
            for (int axis = 0; axis < 3; ++axis)
                distance[child][slot] += (slot >> axis & 1) ? offset[axis] : -offset[axis];
        }
    }
    // Greedily seat the child that gains most.
    WideChildren result;
    std::array<bool, BVH8_WIDTH> seated{};
    for (int round = 0; round < list.size; ++round) {
        int best_child = -1, best_slot = -1;
        for (int child = 0; child < list.size; ++child)
            for (int slot = 0; slot < BVH8_WIDTH; ++slot) {
                if (seated[child] || result.used[slot])
                    continue;
                if (best_child < 0 || distance[child][slot] > distance[best_child][best_slot]) {
                    best_child = child;
                    best_slot = slot;
                }
            }
        seated[best_child] = true;
        result.used[best_slot] = true;
        result.slots[best_slot] = list.items[best_child];
    }
    return result;
}

} // namespace clrt
