// SPDX-License-Identifier: Apache-2.0
// A scene's file, its textures and options -> Scene.
#pragma once

#include "console/progress.h"
#include "scene/scene.h"
#include "scene/scene_request.h"

namespace clrt {

/// Loads everything a render needs: geometry, materials, textures, lights, environment, camera; normalises it
/// (normalise.h). Every fallback is a line in `notices`. Throws SceneError (file:line) for what cannot be
/// understood.
Scene load_scene(const SceneRequest& request, Progress& progress);

} // namespace clrt
