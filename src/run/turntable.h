// SPDX-License-Identifier: Apache-2.0
// --frames: pictures of a turn.
#pragma once

#include "run/report.h"
#include "scene/scene.h"

#include <string>

namespace clrt {

/// The camera of a turn's picture `frame`, from 1 to `frames`: the eye has gone (frame - 1) / frames of a
/// turn about `up` through `at`, counterclockwise as seen from above. The first is the camera itself.
Camera turned_camera(const Camera& camera, int frame, int frames);

/// "frame 3 of 12: 64 spp, error 2.1 %, 4.20 s" and a line end.
std::string format_frame(const Report& report);

/// The graver of the exit codes of two pictures.
int graver_exit(int a, int b);

} // namespace clrt
