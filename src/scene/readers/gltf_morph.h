// SPDX-License-Identifier: Apache-2.0
// Meshes between their basic shape and others.
#pragma once

#include "scene/readers/gltf_nodes.h"
#include "scene/readers/gltf_primitives.h"

#include <vector>

namespace clrt {

/// How much of each target of a mesh is added to it on a node: by the animation, else by the node, else by
/// the mesh, else nothing. Throws SceneError where they are not as many as targets.
std::vector<double> morph_weights(const std::vector<GltfPrimitive>& primitives, const GltfNode& node,
                                  const JsonValue& mesh);

/// The primitives with what these weights add of each target: positions and normals, in the mesh's frame.
std::vector<GltfPrimitive> morph(const std::vector<GltfPrimitive>& primitives,
                                 const std::vector<double>& weights);

} // namespace clrt
