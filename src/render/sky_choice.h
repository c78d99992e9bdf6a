// SPDX-License-Identifier: Apache-2.0
// By which table path's light sampling chooses texels of an environment map (scene/sky_table.h).
//
// What exceeds the mean is right where BSDF sampling finds the rest. Where the rest comes through windows,
// directions sampled by the BSDF seldom meet it: if no sun comes with it, the whole radiance is the better
// table. Under a clear sky BSDF sampling finds all but the sun, which the table can be left to. What a scene
// is, a pilot by each tells: small pictures of the whole frame by the program of the picture and the same
// samples, so that few are enough. Their size depends on the frame alone: parts of a picture, and films that
// are gone on with, choose alike.
#pragma once

#include "console/progress.h"
#include "render/prepared_scene.h"

#include <memory>

namespace clrt {

/// Gives the environment map of a plan another table than its integrator's if that has clearly less error,
/// says so and returns true; else, and where no pilot is worth its time, the plan stays as it is. `parts` are
/// those of the plan that are there; what the pilots needed is added. Throws DeviceError, KernelBuildError
/// and SceneError.
bool choose_sky_table(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                      PreparedParts& parts, Progress& progress);

} // namespace clrt
