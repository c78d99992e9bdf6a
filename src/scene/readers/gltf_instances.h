// SPDX-License-Identifier: Apache-2.0
// The uses of meshes in a glTF file, and which of them share one copy.
#pragma once

#include "scene/readers/gltf_nodes.h"
#include "scene/readers/gltf_primitives.h"
#include "scene/readers/reader_table.h"

#include <string>
#include <vector>

namespace clrt {

/// A use of a mesh.
struct GltfInstance {
    const std::vector<GltfPrimitive>* primitives;
    glm::dmat4 world;
    u32 object;
    bool only_emissive = false; ///< of its primitives; the others are shared
};

/// The uses of meshes on all nodes, which become objects; instances of EXT_mesh_gpu_instancing included.
/// Those whose transform leaves nothing to be seen are left out with a notice, but not of a key frame.
std::vector<GltfInstance> find_gltf_instances(const std::vector<GltfNode>& nodes, GltfBuffers& buffers,
                                              GltfMeshes& meshes, const ReadContext& context, Mesh& mesh);

/// Moves the uses of meshes that --instances shares to the prototypes and instances of `scene` and returns
/// those that are to be copied. Primitives that shine are copied always, so that each of their triangles is a
/// light of its own, and so are meshes under transforms that cannot be undone.
/// `path`: of the file, for messages.
std::vector<GltfInstance> share_gltf_meshes(std::vector<GltfInstance> instances,
                                            const GltfMaterials& materials, const ReadContext& context,
                                            const std::string& path, SceneDescription& scene);

} // namespace clrt
