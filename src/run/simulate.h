// SPDX-License-Identifier: Apache-2.0
// From a scene to radiance: the tree and the program, side by side, then the passes.
#pragma once

#include "bvh/bvh.h"
#include "console/progress.h"
#include "device/device_facts.h"
#include "effects/effects.h"
#include "render/kernels.h"
#include "render/render.h"
#include "render/scene_buffers.h"
#include "replay/causes.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// What tree, program and passes give.
struct Simulation {
    std::optional<DeviceFacts> facts;
    Bvh bvh;
    std::string bvh_reason; ///< why the tree has its quality
    Render render;
    double compile_seconds = 0;
    std::vector<CauseCount> causes; ///< of bad samples
    /// On the device, for further renders; empty where nothing was simulated.
    std::optional<RenderPrograms> programs;
    std::optional<SceneBuffers> buffers;
};

/// Renders. What cannot be told about the device or about bad samples is only said. Throws DeviceError.
Simulation simulate(const Device& device, const Scene& scene, const Effects& effects, const Options& options,
                    Progress& progress, const RenderHooks& hooks);

/// Renders again with the tree and the program of an earlier render of the scene, from which only the camera
/// may differ. Replaces render and causes. Throws DeviceError.
void simulate_again(const Device& device, const Scene& scene, const Effects& effects, const Options& options,
                    Progress& progress, const RenderHooks& hooks, Simulation& done);

/// The black picture, when no path of the scene is asked for.
Simulation simulate_nothing(const Scene& scene, const Effects& effects, const Options& options);

} // namespace clrt
