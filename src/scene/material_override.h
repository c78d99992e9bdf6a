// SPDX-License-Identifier: Apache-2.0
// One material in the place of all, to show shape and light alone: --material.
#pragma once

#include "options/options.h"
#include "scene/notices.h"
#include "scene/readers/mtl_reader.h"

namespace clrt {

/// What takes the place of every material.
struct MaterialReplacement {
    MaterialOverride which;
    const char* name; ///< as in --material NAME
    const char* rule; ///< what every material becomes, for the plan
    double kd;        ///< matte reflectance in 0..1
};

/// The row of the table of replacements, null for NONE.
const MaterialReplacement* find_replacement(MaterialOverride which);

/// The replacement in the words of MTL. It keeps what is light and shape: the radiance that the material
/// emits and its coverage (Ke, d, Tr and their maps). Colour, gloss, glass, and normal and bump maps, which
/// are shape that the geometry does not have, are gone. Notes glass, which is opaque now.
MtlMaterial replace_material(const MtlMaterial& mtl, const MaterialReplacement& replacement,
                             NoticeList& notices);

} // namespace clrt
