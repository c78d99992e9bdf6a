// SPDX-License-Identifier: Apache-2.0
// Splitting a range of items in two: by the surface area heuristic over bins (Wald 2007, "On fast
// construction of SAH-based bounding volume hierarchies"), or at the median where that finds nothing.
#pragma once

#include "bvh/box.h"

namespace clrt {

constexpr int MAX_BINS = 16; ///< twice as many lower the cost of the tree by under 1 %

/// What leaves cost and hold.
struct LeafCost {
    i32 block_log2;  ///< 2^block_log2 triangles are tested at the price of one
    u32 min_leaf;    ///< so many are never split
    u32 max_leaf;    ///< more are always split
    float node_cost; ///< of one binary node, in units of a block's test

    /// Blocks that `counts` triangles fill, lane by lane.
    Float4 blocks(Int4 counts) const {
        return __builtin_convertvector((counts + ((1 << block_log2) - 1)) >> block_log2, Float4);
    }
};

/// Maps an item's centre to bins on all axes. An axis on which the centres agree has the one bin 0.
struct BinMap {
    int bins;
    Float4 origin;
    Float4 scale; ///< bins per unit; 0 on an axis with one bin

    /// Chooses fewer bins for a few items, whose bins would be empty mostly.
    BinMap(const Box& centres, u32 count);
    Int4 bins_of(Float4 centre) const {
        return __builtin_convertvector(lane_min((centre - origin) * scale, splat(float(bins - 1))), Int4);
    }
};

/// A split between two bins. Costs are relative to the square of the node's longest edge.
struct BinnedSplit {
    int axis = -1; ///< -1: none found
    int bin = 0;   ///< items of the bins below it go left
    u32 left_count = 0;
    Box left, right;
    float cost = INFINITE_FLOAT; ///< node and both sides as leaves
    float leaf_cost = 0;         ///< all items as one leaf
};

/// Finds the cheapest split of items over all axes. The result depends on the set of items, not on their
/// order.
BinnedSplit find_split(const BuildItem* items, u32 count, const ItemBounds& bounds, const BinMap& map,
                       const LeafCost& leaf_cost);

/// Reorders items in place so that the left side of a split comes first.
SplitSides apply_split(BuildItem* items, u32 count, const BinMap& map, const BinnedSplit& split);

/// Splits at the median of centres along the longest axis of `centres`; equal centres are told apart by
/// triangle index. Linear time whatever the input.
SplitSides split_at_median(BuildItem* items, u32 count, const Box& centres);

} // namespace clrt
