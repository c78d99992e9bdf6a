// SPDX-License-Identifier: Apache-2.0
// The camera of the options; parts that are not given are fitted to the scene.
#pragma once

#include "options/camera_options.h"
#include "scene/normalise.h"
#include "scene/notices.h"
#include "scene/scene.h"

#include <glm/vec2.hpp>

namespace clrt {

/// The vertical angle of view in degrees: --fov, or 2 atan(film width * H / (2 W * focal length)), or 40 (a
/// camera that is fitted into a room has 60); of a fisheye 180, or as much as its
/// corners allow. Throws UsageError for angles that are not between 0 and 180,
/// lengths that are not positive, or half a pair.
double field_of_view(const CameraOptions& options, glm::ivec2 size);

/// Completes the camera: each missing part is fitted on its own. The eye lies where --view says, or to the
/// right, above and in front, as near as the scene's points fit the picture with 4 % free at the edges
/// (framing.h); `at` lies before it, amid the scene. A room is seen through its open side, or from within
/// (room_view.h). With
/// --at, the eye's direction counts from there; with --eye, `at` is the box's centre. All directions turn
/// with `up`, +Y if it is not given. Reads positions, triangles and normalisation of the scene, whose box
/// `bounds` is (world units). The result is announced as flags to copy if eye or at was fitted. Throws
/// UsageError where eye equals at, for values that are not finite, and for an up vector of length 0.
Camera fit_camera(const CameraOptions& options, glm::ivec2 size, const Scene& scene, const Bounds& bounds,
                  NoticeList& notices);

} // namespace clrt
