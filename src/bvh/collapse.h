// SPDX-License-Identifier: Apache-2.0
// Turning the binary tree into an eight-wide one at the least SAH cost (Ylitie, Karras and Laine 2017,
// "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", section 3).
#pragma once

#include "bvh/binary_tree.h"
#include "bvh/sah_cost.h"

#include <array>
#include <cstdint>
#include <vector>

namespace clrt {

/// A binary node that becomes a child of a wide node, with the place in BinaryTree::order where it begins.
struct WideChild {
    u32 node;
    u32 first;
};

/// The children of one wide node, left to right in the binary tree.
struct WideChildList {
    std::array<WideChild, BVH8_WIDTH> items;
    int size = 0;

    void add(const WideChild& child) { items[size_t(size++)] = child; }
    WideChild* begin() { return items.data(); }
    WideChild* end() { return items.data() + size; }
    const WideChild* begin() const { return items.data(); }
    const WideChild* end() const { return items.data() + size; }
};

/// The children of one wide node by slot.
struct WideChildren {
    std::array<WideChild, BVH8_WIDTH> slots;
    std::array<bool, BVH8_WIDTH> used{};
};

/// What a wide tree's leaves hold and cost, and how deep it may be.
struct WideRules {
    u32 max_leaf; ///< triangles
    LeafPrice price;
    int max_levels; ///< of wide nodes; three levels of the binary tree always fit into one
};

constexpr WideRules BVH8_RULES{BVH8_WIDTH, leaf_price(BvhLayout::BVH8), BVH_MAX_DEPTH};
constexpr WideRules CWBVH_RULES{CWBVH_LEAF_TRIANGLES, leaf_price(BvhLayout::CWBVH), CWBVH_MAX_LEVELS};

/// The cheapest way to represent every binary subtree in a wide tree.
class WideCollapse {
public:
    /// The tree must not be empty and must outlive this object.
    WideCollapse(const BinaryTree& tree, const WideRules& rules);

    /// The SAH cost of the whole tree. A root that is a leaf gets a node above it.
    double cost() const;

    /// Whether the subtree becomes one leaf.
    bool is_leaf(u32 node) const;

    /// The children of the wide node made from `parent`: one if that is a leaf, which only the root can be.
    /// `levels` of wide nodes are left for `parent` and what is below: the rules' max_levels at the root, one
    /// less at each child. Where the cheapest children would not do with that, three binary levels are taken
    /// at once.
    WideChildList children(WideChild parent, int levels) const;

    /// Gives slots to a node's children so that visiting them by ascending slot XOR octant is roughly front
    /// to back for a ray whose octant has bit a set where its direction is negative along axis a (section 4.1
    /// of the paper).
    WideChildren assign_slots(const WideChildList& list, u32 parent) const;

private:
    // cost[i]: of a subtree represented by at most i + 1 children of one wide node.
    using Costs = std::array<float, BVH8_WIDTH - 1>;
    struct Distribution {
        float cost;
        int left; // children given to the left subtree
    };

    void find_costs(u32 node, u32 first);
    float leaf_cost(u32 node) const;
    bool may_be_leaf(u32 node) const;
    bool fits(const WideChildList& list, int levels) const;
    void expand_levels(WideChild subtree, int levels, WideChildList& list) const;
    Distribution distribute(const BinaryNode& node, int children) const;
    void expand(WideChild subtree, int children, WideChildList& list) const;

    const BinaryTree& tree_;
    const BinaryNode* nodes_;
    WideRules rules_;
    double root_area_; // costs are relative to it
    std::vector<Costs> costs_;
    std::vector<std::uint8_t> heights_; // binary levels below each node down to what becomes a leaf
    std::vector<std::uint8_t> parted_;  // whether a box among others is below each node; empty: no boxes
};

} // namespace clrt
