// SPDX-License-Identifier: Apache-2.0
// Numbers of glTF materials, brought into their ranges, and the channels of textures that hold them.
#pragma once

#include "kernels/shared/types.h"
#include "scene/readers/gltf_json.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace clrt {

constexpr u32 CHANNEL_RED = 0, CHANNEL_GREEN = 1, CHANNEL_BLUE = 2, CHANNEL_ALPHA = 3;

/// A member in [0,1].
inline double gltf_unit_number(const JsonValue& object, const char* key, double otherwise) {
    return std::clamp(object.number(key, otherwise), 0.0, 1.0);
}

/// A colour in [0, most].
inline glm::dvec3 gltf_colour(const JsonValue& object, const char* key, double otherwise, double most = 1) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value)
        return glm::dvec3(otherwise);
    const std::array<double, 3> c = value->numbers<3>();
    return glm::clamp(glm::dvec3(c[0], c[1], c[2]), glm::dvec3(0), glm::dvec3(most));
}

} // namespace clrt
