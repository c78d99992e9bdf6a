// SPDX-License-Identifier: Apache-2.0
// The surface area heuristic: what a random ray that meets the root's box is expected to test (MacDonald and
// Booth 1990, "Heuristics for ray tracing using space subdivision").
#pragma once

#include "options/bvh_options.h"

namespace clrt {

/// What a leaf costs to test, in units of a node's test.
struct LeafPrice {
    float leaf;     ///< of any leaf
    float triangle; ///< more for each triangle
};

/// bvh8: testing a node costs as much as testing a block of up to eight triangles. bvh2: as much as testing a
/// triangle. cwbvh: the costs of Ylitie et al. 2017.
constexpr LeafPrice leaf_price(BvhLayout layout) {
    switch (layout) {
    case BvhLayout::BVH2:
        return {0.0f, 1.0f};
    case BvhLayout::CWBVH:
        return {0.0f, 0.3f};
    case BvhLayout::BVH8:
        break;
    }
    return {1.0f, 0.0f};
}

/// Sums up the cost of a tree, node by node. One formula for every tree that is compared.
class SahSum {
public:
    explicit SahSum(BvhLayout layout) : price_(leaf_price(layout)) {}

    /// Half the surface of an inner node's box.
    void add_node(double half_area) { sum_ += half_area; }
    /// Half the surface of a leaf's box, and its triangles.
    void add_leaf(double half_area, size_t triangles) {
        sum_ += half_area * (double(price_.leaf) + double(price_.triangle) * double(triangles));
    }
    /// The cost, given half the surface of the root's box; 0 where all triangles are one axis-parallel line,
    /// whose box has no surface.
    double relative_to(double root_half_area) const { return root_half_area > 0 ? sum_ / root_half_area : 0; }

private:
    LeafPrice price_;
    double sum_ = 0;
};

} // namespace clrt
