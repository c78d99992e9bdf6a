// SPDX-License-Identifier: Apache-2.0
// The camera.
#pragma once

#include "kernels/shared/camera_types.h"
#include "options/names.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

namespace clrt {

/// From where a scene is seen, in a frame whose up is the camera's and whose front is towards the eye of
/// FRONT.
enum class View { FRONT, BACK, LEFT, RIGHT, TOP, BOTTOM, ISO };

template <>
inline constexpr Named<View> NAMES<View>[] = {
    {View::FRONT, "front"}, {View::BACK, "back"},     {View::LEFT, "left"}, {View::RIGHT, "right"},
    {View::TOP, "top"},     {View::BOTTOM, "bottom"}, {View::ISO, "iso"}};

template <>
inline constexpr Named<Projection> NAMES<Projection>[] = {
#define PROJECTION_NAME(constant, name) {PROJECTION_##constant, #name},
    PROJECTION_ROWS(PROJECTION_NAME)
#undef PROJECTION_NAME
};

/// Whether film positions are angles: such a camera has neither lens nor shift.
constexpr bool is_panorama(Projection projection) {
    return projection == PROJECTION_EQUIRECTANGULAR || projection == PROJECTION_FISHEYE;
}

/// Camera parts as given; absent ones are fitted to the scene, each on its own.
struct CameraOptions {
    std::string file_camera; ///< name or number, from 1, of a camera of the file; empty: the first, if any
    std::optional<glm::dvec3> eye, at, up;          ///< scene units
    std::optional<View> view;                       ///< direction of a fitted eye; none: three quarters
    std::optional<double> fov_degrees;              ///< vertical angle of view
    std::optional<double> focal_length, film_width; ///< any common unit; fov = 2 atan(width H / (2 W focal))
    Projection projection = PROJECTION_PERSPECTIVE;
    std::optional<glm::dvec2> shift; ///< of the picture's middle from the axis: to the right over its width,
                                     ///< up over its height
    std::optional<double> aperture;  ///< diameter of the lens, scene units; 0: a pinhole
    std::optional<double> fstop;     ///< focal length over diameter
    std::optional<double> focus;     ///< depth of the plane in focus, scene units; may be infinite
    std::optional<glm::dvec3> focus_point;             ///< a point of it instead
    int blades = 0;                                    ///< corners of the lens; 0: round
    std::optional<glm::dvec3> end_eye, end_at, end_up; ///< at time 1; absent: as at time 0
    std::optional<glm::dvec2> shutter;                 ///< times between which it is open, 0 <= x <= y <= 1
    std::optional<double> ortho_height; ///< orthographic: of what the picture shows, scene units
    std::optional<int> frames;          ///< pictures of a turn around what the camera looks at
    int frame = 0;                      ///< which of them this is, from 1; 0: none of them
};

} // namespace clrt
