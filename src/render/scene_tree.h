// SPDX-License-Identifier: Apache-2.0
// The tree that a render of a scene deserves.
#pragma once

#include "bvh/bvh.h"
#include "options/options.h"
#include "scene/scene.h"

#include <string>

namespace clrt {

/// A tree and why it has its quality.
struct SceneTree {
    Bvh bvh;
    std::string reason; ///< as choose_bvh_quality gives it
};

/// Builds the tree of a scene in the quality that choose_bvh_quality gives. Throws SceneError for too many
/// triangles.
SceneTree build_scene_tree(const Scene& scene, const Options& options, BvhLayout layout);

} // namespace clrt
