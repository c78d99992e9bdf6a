// SPDX-License-Identifier: Apache-2.0
// Splitting a node's space instead of its items: a triangle that reaches over the plane goes to both sides,
// each with the box of its part there (Stich, Friedrich and Dietrich 2009, "Spatial splits in bounding volume
// hierarchies").
#pragma once

#include "bvh/binned_split.h"
#include "kernels/shared/scene_types.h"

#include <vector>

namespace clrt {

/// The triangles that items stand for.
struct TriangleCorners {
    const std::vector<vec4>& positions;
    const std::vector<Triangle>& triangles;

    /// Fills three corners; fourth lanes 0.
    void load(u32 triangle, Float4* corners) const {
        const Triangle& t = triangles[triangle];
        const u32 indices[3] = {t.v0, t.v1, t.v2};
        for (int i = 0; i < 3; ++i) {
            const vec4& p = positions[indices[i]];
            corners[i] = Float4{p.x, p.y, p.z, 0} + splat(0);
        }
    }
};

/// A plane and what it would give. The cost is in the unit of BinnedSplit::cost.
struct SpatialSplit {
    int axis = -1; ///< -1: none found
    int slab = 0;  ///< the first behind the plane
    float position = 0;
    u32 left_count = 0, right_count = 0; ///< items that reach over the plane count on both sides
    Box left, right;
    float cost = INFINITE_FLOAT;
};

/// Both sides after a spatial split, the left items in front.
struct SpatialSides {
    SplitSides sides;
    u32 right_count = 0;
};

/// Finds the cheapest of the planes that cut the node's box into MAX_BINS equal slabs along any axis, that
/// leave fewer than all items on either side and need at most `spare` more items. The result depends on the
/// set of items, not on their order.
SpatialSplit find_spatial_split(const TriangleCorners& mesh, const BuildItem* items, u32 count, u32 spare,
                                const Box& box, const LeafCost& leaf_cost);

/// Cuts the items that reach over the plane, unless one side alone holds the whole item at less cost, and
/// reorders so that the left side comes first. The right parts of cut items are appended behind the `count`
/// items: there must be room for split.left_count + split.right_count items, and no more come out. A side may
/// turn out empty. The new order is the same for any number of threads.
SpatialSides apply_spatial_split(const TriangleCorners& mesh, BuildItem* items, u32 count, const Box& box,
                                 const SpatialSplit& split, const LeafCost& leaf_cost);

} // namespace clrt
