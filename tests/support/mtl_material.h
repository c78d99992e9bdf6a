// SPDX-License-Identifier: Apache-2.0
// From the keys of an MTL material to what the kernels read, in one step.
#pragma once

#include "scene/build_extension.h"
#include "scene/readers/mtl_rules.h"

#include <string>

namespace clrt {

struct RuledMaterial {
    Material material;
    std::string rule;
    BuiltExtension extension;
};

/// Describes a material and builds it; its remarks are noted.
inline RuledMaterial rule_material(const MtlMaterial& mtl, const MaterialContext& context,
                                   const LoadMap& load_map, NoticeList& notices) {
    const MaterialDescription description = describe_mtl(mtl, notices);
    for (const Remark& remark : description.surface_remarks)
        notices.add(remark.text, remark.place);
    const Material material = build_material(description, context, load_map);
    return {material, description.rule, build_extension(description, material, context, load_map)};
}

} // namespace clrt
