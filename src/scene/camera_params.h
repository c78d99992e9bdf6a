// SPDX-License-Identifier: Apache-2.0
// The camera as the kernels take it.
#pragma once

#include "scene/scene.h"

#include <glm/vec2.hpp>

namespace clrt {

/// The widest vertical angle of a fisheye, degrees: its corners look straight back.
double widest_fisheye_fov(glm::ivec2 size);

/// Height of what the picture shows at this distance along the view, world units; in a panorama along the
/// arc.
double shown_height(const Camera& camera, double distance);

/// The camera in the normalised frame, its film vectors for a picture of `size` pixels.
CameraParams make_camera_params(const Camera& camera, const Normalisation& frame, glm::ivec2 size);

/// The ray through a film position, in pixels right of and below the picture's centre, from the middle of the
/// lens when the shutter opens, as kernels/camera/camera_NAME.h makes it; normalised frame, the direction of
/// any length.
struct FilmRay {
    glm::dvec3 origin, direction;
};
FilmRay film_ray(const CameraParams& camera, const glm::dvec2& film);

} // namespace clrt
