// SPDX-License-Identifier: Apache-2.0
// Directions of view: they are named in a frame whose up is +Y and whose front is +Z, and turned along with
// the scene's own up.
#pragma once

#include "options/camera_options.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace clrt {

/// Up where nothing says otherwise.
constexpr glm::dvec3 DEFAULT_UP(0, 1, 0);

/// The rotation by the smallest angle that turns +Y to `up` (any length but 0): +Z up has its front at -Y, as
/// in programs whose up is +Z. For -Y the half turn about +Z, which leaves the front where it is.
glm::dmat3 up_frame(const glm::dvec3& up);

/// Where the eye is, seen from what it looks at: a unit vector in the frame of +Y up. Without a view, a three
/// quarter view.
glm::dvec3 direction_to_eye(const std::optional<View>& view);

/// The axes of a picture, of unit length and orthogonal: to its right, to its top, and into it.
struct PictureAxes {
    glm::dvec3 right, up, look;
};

/// Whether they are so near to parallel that `up` says nothing about the picture.
bool is_along(const glm::dvec3& look, const glm::dvec3& up);

/// An up vector where the wanted one points along the view: the picture's right stays +X of the frame.
glm::dvec3 up_beside(const glm::dvec3& look, const glm::dmat3& frame);

/// The axes of a picture that looks along `look` with `up` upwards; they are not parallel and not 0.
PictureAxes picture_axes(const glm::dvec3& look, const glm::dvec3& up);

} // namespace clrt
