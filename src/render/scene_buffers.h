// SPDX-License-Identifier: Apache-2.0
// The scene's arrays on the device, bound to kernel arguments by name.
#pragma once

#include "bvh/bvh.h"
#include "device/program.h"
#include "scene/scene.h"

#include <utility>
#include <vector>

namespace clrt {

/// Buffers by argument name (SCENE_PARAMS in kernels/geometry/scene.h).
struct SceneBuffers {
    std::vector<std::pair<std::string, cl::Buffer>> buffers;
};

/// Uploads a scene. Throws DeviceError naming the buffer that does not fit.
SceneBuffers upload_scene(const Device& device, const Scene& scene, const Bvh& bvh);

/// Sets every scene argument of a kernel.
void bind_scene(const SceneBuffers& scene, Kernel& kernel);

} // namespace clrt
