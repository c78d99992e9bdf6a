// SPDX-License-Identifier: Apache-2.0
// Polygons with any number of corners -> triangles.
#pragma once

#include "kernels/shared/types.h"

#include <glm/vec3.hpp>
#include <vector>

namespace clrt {

/// The largest concave polygon that is cut properly: the time of ear clipping grows with the square of the
/// number of corners, about a third of a second here.
constexpr size_t MAX_CLIPPED_CORNERS = 8192;

/// Cuts a polygon of three or more corners, all finite, into size - 2 triangles of the same winding, seen
/// along the polygon's area vector (Newell's normal). `triangles` becomes the triples of corner indices.
/// Convex polygons become a fan, quads are cut along the shorter diagonal, concave ones are cut by ear
/// clipping. False where no triangles of that winding were found that make up the polygon: it has no area,
/// crosses itself (which mostly shows), or is concave with more than MAX_CLIPPED_CORNERS corners. Then the
/// rest of it is cut as a fan, overlapping as it may.
bool triangulate(const std::vector<glm::dvec3>& polygon, std::vector<u32>& triangles);

} // namespace clrt
