// SPDX-License-Identifier: Apache-2.0
// The camera of the options; parts that are not given are fitted to the scene. +Y is up.
#pragma once

#include "app/options.h"
#include "scene/normalise.h"
#include "scene/notices.h"
#include "scene/scene.h"

#include <array>
#include <vector>

namespace clrt {

/// Up where --up does not say.
inline const glm::dvec3 DEFAULT_UP{0, 1, 0};

/// How much of each face of the scene's box is covered by triangles that lie near it and face inwards, 0..1,
/// in the order +Z, -Z, +X, -X, +Y, -Y. A room covers four to six of them, a solid thing none.
using BoxCover = std::array<double, 6>;

/// Whether such a scene is a room: four faces or more are walls.
bool is_room(const BoxCover& cover);

/// Measures the cover on a grid of points per face. `positions` and `triangles` are in the normalised frame.
BoxCover measure_box_cover(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles);

/// The vertical angle of view in degrees: --fov, or 2 atan(film width * H / (2 W * focal length)), or 40.
/// Throws UsageError for angles that are not between 0 and 180, lengths that are not positive, or half a
/// pair.
double field_of_view(const CameraOptions& options, glm::ivec2 size);

/// Completes the camera: each missing part is fitted on its own. `at` becomes the box's centre. `eye` lies
/// along (0.5, 0.35, 1) where the bounding sphere fits the narrower angle of view with a margin of 5 %; in
/// front of the open side of a room; inside a closed one. The result is announced as flags to copy if eye or
/// at was fitted. Throws UsageError where eye equals at, for values that are not finite, and for an up vector
/// of length 0.
Camera fit_camera(const CameraOptions& options, glm::ivec2 size, const Bounds& bounds, const BoxCover& cover,
                  NoticeList& notices);

} // namespace clrt
