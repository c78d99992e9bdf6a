// SPDX-License-Identifier: Apache-2.0
// Meshes that follow the joints of a skeleton: vertices are where the joints have them.
#pragma once

#include "scene/readers/gltf_nodes.h"
#include "scene/readers/gltf_primitives.h"

#include <vector>

namespace clrt {

/// The primitives of a node with a skin, in the world's frame: each vertex under the weighted mean of its
/// joints' transforms (glTF 2.0, section 3.7.3.3, linear blend skinning). The node's own transform counts for
/// primitives without joints alone, which a notice names. `nodes`: all that are shown. Throws SceneError for
/// joints that are not among them or not in the skin.
std::vector<GltfPrimitive> bend_by_skin(const std::vector<GltfPrimitive>& primitives, const GltfNode& node,
                                        const std::vector<GltfNode>& nodes, GltfBuffers& buffers,
                                        NoticeList& notices);

} // namespace clrt
