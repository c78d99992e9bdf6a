// SPDX-License-Identifier: Apache-2.0
// What passes over all triangles of a scene ask.
#pragma once

#include "kernels/shared/scene_types.h"
#include "scene/vectors.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace clrt {

/// Triangles per task of parallel passes: a tenth of a millisecond or more.
constexpr size_t TRIANGLE_GRAIN = size_t(1) << 13;

/// The corners of a triangle, in the normalised frame.
struct TriangleCorners {
    glm::dvec3 p[3];
};

inline TriangleCorners corners_of(const std::vector<vec4>& positions, const Triangle& t) {
    return {{to_dvec3(positions[t.v0]), to_dvec3(positions[t.v1]), to_dvec3(positions[t.v2])}};
}

} // namespace clrt
