// SPDX-License-Identifier: Apache-2.0
// The cameras and lights on the nodes of a glTF file.
#pragma once

#include "options/scene_options.h"
#include "scene/readers/gltf_nodes.h"
#include "scene/scene_description.h"

namespace clrt {

/// What candela and lux are divided by to be watts, as Blender does (the lumens of a watt at 555 nm).
constexpr double LUMENS_A_WATT = 683;

/// Adds the camera of a node, if it has one. Its scale does not count. Throws SceneError: JSON path,
/// expected, found.
void add_gltf_camera(const JsonDocument& json, const GltfNode& node, SceneDescription& scene);

/// Adds the light of a node (KHR_lights_punctual), if it has one.
void add_gltf_light(const JsonDocument& json, const GltfNode& node, GltfLights units,
                    SceneDescription& scene);

} // namespace clrt
