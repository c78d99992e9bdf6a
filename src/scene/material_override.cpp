// SPDX-License-Identifier: Apache-2.0
#include "scene/material_override.h"

#include "scene/material_rules.h"

#include <fmt/format.h>

namespace clrt {

namespace {

constexpr MaterialReplacement REPLACEMENTS[] = {
    {MaterialOverride::CLAY, "clay: matte Kd 0.8, emission and coverage kept", DEFAULT_KD},
};

} // namespace

const MaterialReplacement* find_replacement(MaterialOverride which) {
    for (const MaterialReplacement& row : REPLACEMENTS)
        if (row.which == which)
            return &row;
    return nullptr;
}

MtlMaterial replace_material(const MtlMaterial& mtl, const MaterialReplacement& replacement,
                             NoticeList& notices) {
    if (is_dielectric(mtl))
        notices.add(fmt::format("--material {}: glass is opaque", name_of(replacement.which)), mtl.place);
    MtlMaterial result;
    result.name = mtl.name;
    result.place = mtl.place;
    result.key_lines = mtl.key_lines;
    result.kd = glm::dvec3(replacement.kd);
    result.ke = mtl.ke;
    result.map_ke = mtl.map_ke;
    result.d = mtl.d;
    result.tr = mtl.tr;
    result.map_d = mtl.map_d;
    return result;
}

} // namespace clrt
