// SPDX-License-Identifier: Apache-2.0
// From a planned scene to radiance: prepared once, rendered for every picture.
#pragma once

#include "console/progress.h"
#include "device/device_facts.h"
#include "render/prepared_scene.h"
#include "render/render.h"
#include "replay/causes.h"

#include <memory>
#include <optional>
#include <vector>

namespace clrt {

/// What preparing and rendering give.
struct Simulation {
    std::optional<PreparedScene> prepared; ///< none where no path of the scene is asked for
    std::vector<PreparedScene> others;     ///< on further devices that share the picture
    std::vector<const Device*> failed; ///< those of them that a render has left out: they are not asked again
    std::optional<DeviceFacts> facts;
    Render render;                  ///< the last
    std::vector<CauseCount> causes; ///< of its bad samples
};

/// Prepares a scene and renders it. What cannot be told about the device or about bad samples is only said.
/// Where no path is asked for this is the black picture, and nothing is prepared. `parts`: those of the
/// plan that are there for the first device. Several devices share the picture; facts are those of the first
/// that breaks a rule, else of the first. Throws DeviceError.
Simulation simulate(const std::vector<Device>& devices, const std::shared_ptr<const PlannedScene>& planned,
                    Progress& progress, const RenderHooks& hooks, PreparedParts parts = {});

/// Renders again what is prepared, as its plan now is (PreparedScene says what may change in it). Replaces
/// render and causes. Throws DeviceError.
void simulate_again(Progress& progress, const RenderHooks& hooks, Simulation& done);

/// What is prepared on devices that have not failed; empty where nothing is prepared.
std::vector<const PreparedScene*> working_scenes(const Simulation& done);

} // namespace clrt
