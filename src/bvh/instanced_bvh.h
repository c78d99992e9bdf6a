// SPDX-License-Identifier: Apache-2.0
// Trees in two levels: one over the scene's own triangles and the instances, one over each prototype that
// instances share.
#pragma once

#include "bvh/bvh.h"

#include <vector>

namespace clrt {

/// Consecutive triangles that instances share, with corners in a frame of their own: centred, of a size of
/// about 1.
struct Prototype {
    u32 first_triangle, triangle_count;
};

/// Where prototypes' triangles begin: behind all of the scene's own.
size_t own_triangle_count(const std::vector<Triangle>& triangles, const std::vector<Prototype>& prototypes);

/// As build_bvh, for the scene's own triangles and `instances`, of which the first stands for the scene and
/// is no box in the tree. A triangle is in one tree, and in the arrays of the layout once, however many
/// instances show it. An instance is a leaf of its own in the scene's tree, which has no cut triangles then.
/// `depth` is the largest of any tree, `sah_cost` that of the scene's with a leaf's price for each instance.
/// Without prototypes it is build_bvh. Throws SceneError for more triangles or instances than 30-bit indices
/// reach.
Bvh build_instanced_bvh(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                        const std::vector<Prototype>& prototypes, const std::vector<Instance>& instances,
                        BvhLayout layout, BvhQuality quality = BvhQuality::FAST,
                        const std::vector<vec4>& moves = {});

} // namespace clrt
