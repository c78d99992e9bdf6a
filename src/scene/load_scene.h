// SPDX-License-Identifier: Apache-2.0
// OBJ, MTL, textures and options -> Scene.
#pragma once

#include "console/progress.h"
#include "options/options.h"
#include "scene/scene.h"

namespace clrt {

/// Loads everything a render needs: geometry, materials, textures, lights, environment, camera; normalises it
/// (normalise.h). Every fallback is a line in `notices`. Throws SceneError (file:line) for what cannot be
/// understood.
Scene load_scene(const Options& options, Progress& progress);

} // namespace clrt
