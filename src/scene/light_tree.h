// SPDX-License-Identifier: Apache-2.0
// The tree by which next-event estimation chooses a light for a vertex (kernels/lights/light_tree.h).
#pragma once

#include "scene/light_leaves.h"
#include "scene/scene.h"

namespace clrt {

/// Builds the tree over the lights of the kinds (KIND_*) from their parts (light_parts.h), the same whatever
/// the number of threads. Empty where there are not two leaves to choose between.
LightTree build_light_tree(const Scene& scene, unsigned kinds);

/// Nodes on the longest way from the root.
int light_tree_depth(const LightTree& tree);

} // namespace clrt
