// SPDX-License-Identifier: Apache-2.0
// The camera's motion while the shutter is open.
#pragma once

#include "options/camera_options.h"
#include "scene/scene.h"

namespace clrt {

/// The times between which the shutter is open: all from 0 to 1 unless the options say less.
glm::dvec2 shutter_times(const CameraOptions& options);

/// Moves the camera, which is that of time 0, to where it is when the shutter opens, and sets `end` to where
/// it is when it closes, if that is another place. Parts without an --end-... stand still. Throws UsageError
/// for values that are not finite, and where the camera would meet what it looks at or look along its up
/// vector on the way.
void set_motion(const CameraOptions& options, Camera& camera);

} // namespace clrt
