// SPDX-License-Identifier: Apache-2.0
#include "scene/material_override.h"

#include <fmt/format.h>

namespace clrt {

namespace {

constexpr MaterialReplacement REPLACEMENTS[] = {
    {MaterialOverride::CLAY, "clay: matte Kd 0.8, emission and coverage kept", DEFAULT_REFLECTANCE},
};

} // namespace

const MaterialReplacement* find_replacement(MaterialOverride which) {
    for (const MaterialReplacement& row : REPLACEMENTS)
        if (row.which == which)
            return &row;
    return nullptr;
}

MaterialDescription replace_material(const MaterialDescription& material,
                                     const MaterialReplacement& replacement, NoticeList& notices) {
    if (material.reflection == Reflection::DIELECTRIC)
        notices.add(fmt::format("--material {}: glass is opaque", name_of(replacement.which)),
                    material.place);
    MaterialDescription result;
    result.name = material.name;
    result.place = material.place;
    result.rule = replacement.rule;
    result.base.value = glm::dvec3(replacement.reflectance);
    result.emission = material.emission;
    result.coverage = material.coverage;
    return result;
}

} // namespace clrt
