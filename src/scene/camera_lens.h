// SPDX-License-Identifier: Apache-2.0
// The lens of the options.
#pragma once

#include "options/camera_options.h"
#include "scene/notices.h"
#include "scene/scene.h"

namespace clrt {

/// Sets the camera's aperture, focus and blades; eye and at are set before. The diameter is --aperture, or
/// --focal-length over --fstop; without --focus the plane in focus goes through `at`, which is announced as
/// the distance to copy. Throws UsageError for a point of focus that is not before the camera.
void set_lens(const CameraOptions& options, Camera& camera, NoticeList& notices);

} // namespace clrt
