// SPDX-License-Identifier: Apache-2.0
// A matte plane under a scene, which catches its shadows.
#pragma once

#include "scene/normalise.h"
#include "scene/scene.h"

#include <cstddef>

namespace clrt {

/// Half the side of the ground in the normalised frame, where scenes have a radius of 1 to 2. At its edges a
/// thing of size 1 takes less than 1e-5 of the sky from it, which no eye sees. Boxes of the tree are padded
/// by a share of it (kernels/geometry/box.h), so it is no larger.
constexpr double GROUND_HALF_SIDE = 32;

/// Side of its squares: edges of this length are the longest that kernels/geometry/surface.h is made for.
constexpr double GROUND_SQUARE = 4;

/// How far the ground lies below the lowest corner, normalised frame: 512 units of roundoff, twice the sum of
/// the error bounds (surface_offset_bound) of the largest face that a scene can have and of a square, so that
/// a face that lies on it is seen whole.
constexpr double GROUND_GAP = 0x1p-15;

/// Triangles of the scene's file, prototypes' once: all but the ground's.
size_t file_triangles(const Scene& scene);

/// The lowest corner of the scene's triangles along `up` (unit), normalised frame; 0 where there are none.
double lowest_along(const Scene& scene, const glm::dvec3& up);

/// Appends the ground, perpendicular to `up` (unit) below the scene's lowest corner, with a material and an
/// object of its own. Its front is above. `albedo` is its reflectance, 0..1.
void append_ground(const glm::dvec3& up, const glm::dvec3& albedo, Scene& scene);

} // namespace clrt
