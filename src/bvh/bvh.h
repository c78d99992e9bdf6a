// SPDX-License-Identifier: Apache-2.0
// Bounding volume hierarchies over a scene's triangles; independent of OpenCL.
#pragma once

#include "kernels/shared/bvh_types.h"
#include "kernels/shared/scene_types.h"
#include "options/bvh_options.h"

#include <cstddef>
#include <vector>

namespace clrt {

constexpr BvhLayout ALL_LAYOUTS[] = {BvhLayout::BVH8, BvhLayout::BVH2, BvhLayout::CWBVH};

/// A tree in a device layout (kernels/shared/bvh_types.h) with the figures of its construction.
struct Bvh {
    BvhLayout layout = BvhLayout::BVH8;
    BvhQuality quality = BvhQuality::FAST;
    std::vector<u32> nodes;      ///< node 0 is the root; floats are stored by their bits
    std::vector<u32> leaves;     ///< triangle blocks or leaf triangles; floats are stored by their bits
    std::vector<u32> leaf_moves; ///< of the corners in the leaves; empty where no triangle moves
    std::vector<u32> roots;      ///< of the trees over prototypes (bvh/instanced_bvh.h); empty without them
    int depth = 0;               ///< levels of the binary tree, at most BVH_MAX_DEPTH
    size_t triangle_count = 0;   ///< in the tree; those with equal or non-finite corners are left out
    size_t reference_count = 0;  ///< entries in leaves: more than triangles where spatial splits cut some
    double sah_cost = 0; ///< expected node and triangle tests of a random ray (MacDonald and Booth 1990)
    double seconds = 0;  ///< that the construction took
};

/// Builds a tree over all triangles that have three different finite corners. Coordinates beyond BVH_EMPTY
/// count as not finite: a traversal's products with them would overflow. Three corners in line are kept: they
/// close seams. Corner indices must be valid.
///
/// Deterministic: the same input gives the same bits for any number of threads. Never deeper than
/// BVH_MAX_DEPTH and never quadratic, whatever the input (coincident triangles included). With FAST boxes are
/// the exact bounds of their triangles (corners are floats). With HIGH a triangle may be in several leaves,
/// at most MOST_REFERENCES times the triangles in total, and the boxes of its leaves together cover it
/// (clip.h), where that lowers the cost of the tree by a twentieth: in even meshes it does not, and the cut
/// triangles would take memory and time for nothing; hits are the same to the last bit. In cwbvh boxes are
/// the least of the node's lattice that enclose those. The slack for the traversal's arithmetic is the
/// traversal's own. `moves`, where it is not empty, has each position's straight way while the shutter is
/// open: boxes enclose all of it, no triangle is cut, and left out are those that cannot be hit at either
/// end. An empty scene gives a root with empty children and no leaves. Throws SceneError for more triangles
/// than 31-bit indices reach.
Bvh build_bvh(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BvhLayout layout,
              BvhQuality quality = BvhQuality::FAST, const std::vector<vec4>& moves = {});

} // namespace clrt
