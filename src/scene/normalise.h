// SPDX-License-Identifier: Apache-2.0
// World to normalised frame: the scene's box is centred and scaled by a power of two, so that every scene has
// the same size to the kernels and scaling a scene by a power of two changes no bit of its picture.
#pragma once

#include "scene/scene.h"

#include <glm/vec3.hpp>

namespace clrt {

/// A box around points, in world units.
struct Bounds {
    glm::dvec3 low{0}, high{0};

    glm::dvec3 centre() const { return (low + high) * 0.5; }
    /// Half the diagonal: the radius of the sphere through the corners.
    double radius() const;
};

/// The normalisation of a scene with this box; a box that is a single point gets scale 1.
Normalisation fit_normalisation(const Bounds& bounds);

/// (p - centre) * scale in double.
inline glm::dvec3 to_normalised(const Normalisation& frame, const glm::dvec3& p) {
    return (p - frame.centre) * frame.scale;
}

/// Where the world positions of a picture's layer count from: 0, but for scenes further than this many units
/// of the normalised frame from the origin near the centre (an exact multiple of that unit). Floats that
/// count from the origin would differ by 2^-14 of the scene's radius there; readers add it in double.
constexpr double FAR_SCENE = 1024;
glm::dvec3 position_origin(const Normalisation& frame);

} // namespace clrt
