// SPDX-License-Identifier: Apache-2.0
// The materials of a scene in words.
#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <string>

namespace clrt {

/// A material as a witness: its name and, where it has one, its place: `material "glass" (room.mtl:12)`.
std::string describe_material(const Scene& scene, size_t index);

/// What a material of a scene became, such as "matte 0.5 0.5 0.5, Kd map "wood.png"".
std::string material_summary(const Scene& scene, size_t index);

/// The materials of a scene as a table for --explain: name, rule, what each became.
std::string material_table(const Scene& scene);

} // namespace clrt
