// SPDX-License-Identifier: Apache-2.0
// Metals by their complex index of refraction.
#pragma once

#include "scene/material_description.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// The index of a metal by its name in lower case, for the channels of linear sRGB; nothing if there is none.
std::optional<ConductorIndex> find_conductor(const std::string& name);

/// The names that it knows, sorted.
std::vector<std::string> conductor_names();

/// Reflectance head-on beside air, ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
glm::dvec3 conductor_head_on(const ConductorIndex& index);

} // namespace clrt
