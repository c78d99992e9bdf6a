// SPDX-License-Identifier: Apache-2.0
// One material in the place of all, to show shape and light alone: --material.
#pragma once

#include "options/scene_options.h"
#include "scene/material_description.h"
#include "scene/notices.h"

namespace clrt {

/// What takes the place of every material.
struct MaterialReplacement {
    MaterialOverride which;
    const char* rule;   ///< what every material becomes, for the plan
    double reflectance; ///< matte, in 0..1
};

/// The row of the table of replacements, null for NONE.
const MaterialReplacement* find_replacement(MaterialOverride which);

/// The replacement of a material. It keeps what is light and shape: the radiance that the material emits and
/// its coverage. Colour, gloss, glass, and normal and bump maps, which are shape that the geometry does not
/// have, are gone. Notes glass, which is opaque now.
MaterialDescription replace_material(const MaterialDescription& material,
                                     const MaterialReplacement& replacement, NoticeList& notices);

} // namespace clrt
