// SPDX-License-Identifier: Apache-2.0
// Turning the binary tree into an eight-wide one at the least SAH cost (Ylitie, Karras and Laine 2017,
// "Efficient incoherent ray traversal on GPUs through compressed wide BVHs", section 3).
#pragma once

#include "bvh/binary_tree.h"

#include <array>
#include <vector>

namespace clrt {

/// A binary node that becomes a child of a wide node, with the place in BinaryTree::order where it begins.
struct WideChild {
    u32 node;
    u32 first;
};

/// The children of one wide node by slot.
struct WideChildren {
    std::array<WideChild, BVH8_WIDTH> slots;
    std::array<bool, BVH8_WIDTH> used{};
};

/// The cheapest way to represent every binary subtree in a wide tree, where testing a wide node costs as much
/// as testing a block of up to BVH8_WIDTH triangles.
class WideCollapse {
public:
    /// The tree must not be empty and must outlive this object.
    explicit WideCollapse(const BinaryTree& tree);

    /// Whether the subtree becomes one block of triangles.
    bool is_leaf(u32 node) const;

    /// The children of the wide node made from `parent`: one if that is a leaf, which only the root can be.
    /// Slots are given so that visiting them by ascending slot XOR octant is roughly front to back for a ray
    /// whose octant has bit a set where its direction is negative along axis a (section 4.1 of the paper).
    WideChildren children(WideChild parent) const;

private:
    // cost[i]: of a subtree represented by at most i + 1 children of one wide node.
    using Costs = std::array<float, BVH8_WIDTH - 1>;
    struct Distribution {
        float cost;
        int left; // children given to the left subtree
    };
    struct ChildList {
        std::array<WideChild, BVH8_WIDTH> items;
        int size = 0;
    };

    void find_costs(u32 node);
    Distribution distribute(const BinaryNode& node, int children) const;
    void expand(WideChild subtree, int children, ChildList& list) const;
    WideChildren assign_slots(const ChildList& list, u32 parent) const;

    const BinaryNode* nodes_;
    double root_area_; // costs are relative to it
    std::vector<Costs> costs_;
};

} // namespace clrt
