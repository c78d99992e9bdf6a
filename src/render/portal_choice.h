// SPDX-License-Identifier: Apache-2.0
// Whether the light sampling of path, path+light and bdpt looks for the sky through portals
// (kernels/lights/sky_portal.h).
//
// Paths that are followed out of the scene show where its windows are (scene/sky_portals.h). Pilots, as those
// that choose the sky's table (sky_choice.h), tell whether light samples through them have less noise, what
// share of the samples they are to have, and how much they count beside other lights; pilots of path,
// whatever renders. All of that depends on scene and frame alone, so parts of a picture, and films that are
// gone on with, choose alike.
#pragma once

#include "console/progress.h"
#include "render/prepared_scene.h"

#include <memory>

namespace clrt {

/// Gives the environment of a plan portals where they have less error, and says so; else, and where
/// there can be none, the plan stays as it is. `parts` are those of the plan that are there; what the pilots
/// needed is added. Throws DeviceError, KernelBuildError and SceneError.
void choose_portals(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts,
                    Progress& progress);

} // namespace clrt
