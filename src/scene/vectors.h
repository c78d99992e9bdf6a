// SPDX-License-Identifier: Apache-2.0
// What several stages ask of vectors in double, and pi.
#pragma once

#include "kernels/shared/types.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>
#include <string>

namespace clrt {

constexpr double PI = glm::pi<double>();

/// The first three components of a shared vector.
inline glm::dvec3 to_dvec3(const vec4& v) {
    return {v.x, v.y, v.z};
}

/// A shared vector: rounded to nearest, and w.
inline vec4 to_vec4(const glm::dvec3& v, double w = 0) {
    return {float(v.x), float(v.y), float(v.z), float(w)};
}

/// True if the first three components are 0.
inline bool is_zero(const vec4& v) {
    return v.x == 0 && v.y == 0 && v.z == 0;
}

/// True if no component is infinite or NaN.
inline bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// "x,y,z" as options take it; -0 is written as 0.
inline std::string triple(const glm::dvec3& v) {
    return fmt::format("{},{},{}", v.x + 0., v.y + 0., v.z + 0.);
}

} // namespace clrt
