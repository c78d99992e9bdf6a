// SPDX-License-Identifier: Apache-2.0
// The meshes on the nodes of a glTF file -> one mesh in the world's frame, a copy for each use that shares
// none.
#pragma once

#include "scene/readers/gltf_nodes.h"
#include "scene/readers/gltf_primitives.h"
#include "scene/readers/reader_table.h"

#include <cstddef>
#include <vector>

namespace clrt {

/// The most that flattened instances may take, as positions, normals, coordinates and triangles of a Mesh:
/// what renders in a machine of 64 GiB with its tree.
constexpr size_t MOST_FLATTENED_BYTES = size_t(16) << 30;

/// Puts the meshes of all nodes into `scene.mesh`, instances of EXT_mesh_gpu_instancing included, but for
/// those that instances share (gltf_instances.h). Triangles with a vertex that is not finite are counted in
/// `scene.dropped_faces`. Throws SceneError where they exceed MOST_FLATTENED_BYTES or 2^32 vertices; says how
/// many instances there are and what they take.
void flatten_gltf(const std::vector<GltfNode>& nodes, GltfBuffers& buffers, GltfMeshes& meshes,
                  const GltfMaterials& materials, const ReadContext& context, SceneDescription& scene);

} // namespace clrt
