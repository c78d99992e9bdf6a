// SPDX-License-Identifier: Apache-2.0
// What few materials have, for the kernels: an array beside that of the materials.
#pragma once

#include "scene/build_material.h"
#include "scene/scene.h"

namespace clrt {

/// What the description adds to the material that was built of it.
struct BuiltExtension {
    bool is_needed = false; ///< else the kernels do not look
    MaterialExtension extension{};
};

/// Makes it. Only the maps that can have an effect are loaded.
BuiltExtension build_extension(const MaterialDescription& description, const Material& material,
                               const MaterialContext& context, const LoadMap& load_map);

/// Puts it beside the scene's last material. The array begins with the first that is needed, and then has
/// an element for every material.
void append_extension(const BuiltExtension& built, Scene& scene);

} // namespace clrt
