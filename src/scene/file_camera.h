// SPDX-License-Identifier: Apache-2.0
// A camera of the scene's file in the place of a fitted one.
#pragma once

#include "scene/normalise.h"
#include "scene/notices.h"
#include "scene/scene_description.h"
#include "scene/scene_request.h"

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace clrt {

/// Fills in what the options leave open of the camera with the one that --camera names, else with the first;
/// not where --eye, --at or --view ask for another place. `end_cameras`: the same cameras at time 1, or none;
/// the way there is taken where no option gives one. Returns the picture's size where no option gives
/// it and the camera has an aspect: the largest of this aspect within the default size. Throws UsageError
/// where the file has no such camera.
std::optional<glm::ivec2> take_file_camera(const std::vector<FileCamera>& cameras,
                                           const std::vector<FileCamera>& end_cameras, const Bounds& bounds,
                                           SceneRequest& request, NoticeList& notices);

} // namespace clrt
