// SPDX-License-Identifier: Apache-2.0
// The scene's arrays on the device, in the heaps that kernels take.
#pragma once

#include "bvh/bvh.h"
#include "device/program.h"
#include "kernels/shared/scene_arrays.h"
#include "paths/path_plan.h"
#include "scene/scene.h"

#include <array>

namespace clrt {

/// What SCENE_PARAMS of kernels/geometry/scene.h takes.
struct SceneBuffers {
    std::array<cl::Buffer, SCENE_HEAPS> heaps;
};

/// Uploads a scene and which of its paths are wanted. Throws DeviceError naming the arrays of the buffer that
/// does not fit.
SceneBuffers upload_scene(const Device& device, const Scene& scene, const Bvh& bvh,
                          const PathTables& paths = path_tables());

/// True for a kernel that takes a scene.
bool takes_scene(const Kernel& kernel);

/// Sets every scene argument of a kernel.
void bind_scene(const SceneBuffers& scene, Kernel& kernel);

} // namespace clrt
