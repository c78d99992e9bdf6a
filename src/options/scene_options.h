// SPDX-License-Identifier: Apache-2.0
// The scene and how it is read.
#pragma once

#include <string>

namespace clrt {

enum class MtlReading { AUTO, PLAIN };
/// CLAY: matte grey in the place of every material (scene/material_override.h).
enum class MaterialOverride { NONE, CLAY };

struct SceneOptions {
    std::string path;                  ///< a file; "-": the standard input
    MtlReading mtl = MtlReading::AUTO; ///< auto: as the writers of libraries mean them
    MaterialOverride material_override = MaterialOverride::NONE;
};

} // namespace clrt
