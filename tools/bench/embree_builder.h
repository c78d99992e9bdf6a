// SPDX-License-Identifier: Apache-2.0
// Trees by Embree's builder (rtcBuildBVH) of the shape of clrt's layouts, so that one cost formula judges
// both. The trees inside Embree's scenes cannot be looked at; its builder, which makes those too, can.
#pragma once

#include "bench/measure.h"
#include "bvh/bvh.h"
#include "scene/scene.h"

#include <embree3/rtcore.h>

namespace clrt {

/// What Embree's builder made of a scene, and at what price.
struct EmbreeTree {
    double sah_cost = 0;   ///< as Bvh::sah_cost of the same layout
    size_t references = 0; ///< entries in leaves
    Cost cost;             ///< of boxes and tree: leaves get no triangles' corners
};

/// Builds a tree with as many children a node, as large leaves and the same costs of nodes and leaves as
/// clrt's layout has, by Morton codes (LOW), binned SAH (MEDIUM) or with spatial splits (HIGH), of which it
/// may make as many as clrt. Triangles are those that clrt's tree holds. `threads` of 0: all. Throws
/// std::runtime_error where Embree fails.
EmbreeTree build_embree_tree(const Scene& scene, BvhLayout layout, RTCBuildQuality quality, int threads);

/// The quality that does what clrt's does: binned SAH, or spatial splits too.
RTCBuildQuality matching_quality(BvhQuality quality);

/// "low", "medium" or "high".
const char* quality_name(RTCBuildQuality quality);

} // namespace clrt
