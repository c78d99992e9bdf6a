// SPDX-License-Identifier: Apache-2.0
// The camera.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace clrt {

/// From where a scene is seen, in a frame whose up is the camera's and whose front is towards the eye of
/// FRONT.
enum class View { FRONT, BACK, LEFT, RIGHT, TOP, BOTTOM, ISO };

/// Camera parts as given; absent ones are fitted to the scene, each on its own.
struct CameraOptions {
    std::optional<glm::dvec3> eye, at, up;          ///< scene units
    std::optional<View> view;                       ///< direction of a fitted eye; none: three quarters
    std::optional<double> fov_degrees;              ///< vertical angle of view
    std::optional<double> focal_length, film_width; ///< any common unit; fov = 2 atan(width H / (2 W focal))
    std::optional<int> frames;                      ///< pictures of a turn around what the camera looks at
    int frame = 0;                                  ///< which of them this is, from 1; 0: none of them
};

} // namespace clrt
