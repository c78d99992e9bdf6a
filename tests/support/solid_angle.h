// SPDX-License-Identifier: Apache-2.0
// Solid angles of triangles, in double precision.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace clrt {

/// That of a triangle as seen from the origin, in steradians (van Oosterom and Strackee 1983).
inline double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return 2 *
           std::abs(std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                  glm::dot(b, c) * la + glm::dot(c, a) * lb));
}

} // namespace clrt
