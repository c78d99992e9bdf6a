// SPDX-License-Identifier: Apache-2.0
// The node hierarchy of a glTF file -> its nodes with their transforms to the world.
#pragma once

#include "scene/readers/gltf_json.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

struct GltfNode {
    JsonValue json;
    glm::dmat4 world; ///< from the node's frame
    std::string name;
    size_t number;               ///< into the file's nodes
    std::vector<double> weights; ///< of its mesh's morph targets; empty: the mesh's own
};

/// What an animation puts in the place of a node's own transform, in part or in whole.
struct GltfPose {
    std::optional<glm::dvec3> translation;
    std::optional<glm::dvec4> rotation; ///< a quaternion x, y, z, w
    std::optional<glm::dvec3> scale;
    std::vector<double> weights; ///< of its mesh's morph targets; empty: not animated
};

/// Poses by the nodes' indices.
using GltfPoses = std::map<size_t, GltfPose>;

/// The nodes of the scene that is shown: that of `scene`, else the first, else all. Parents come before
/// children, in the order of the file. Throws SceneError for a node that is reached twice: the graph is a
/// forest.
std::vector<GltfNode> read_gltf_nodes(const JsonDocument& json, const GltfPoses& poses = {});

/// Translation times rotation (a quaternion x, y, z, w of any length but 0) times scale.
glm::dmat4 gltf_transform(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

/// What turns normals with a transform: the transposed inverse up to a positive factor, for singular
/// transforms too.
glm::dmat3 normal_transform(const glm::dmat4& transform);

/// Whether a transform mirrors, so that the winding of triangles is reversed.
bool is_mirrored(const glm::dmat4& transform);

} // namespace clrt
