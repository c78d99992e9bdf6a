// SPDX-License-Identifier: Apache-2.0
// The materials of a glTF file -> descriptions of the field.
#pragma once

#include "scene/material_description.h"
#include "scene/readers/gltf_textures.h"
#include "scene/readers/reader_table.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// A material as a primitive uses it.
struct GltfSurface {
    u32 material = 0; ///< into descriptions()
    /// TEXCOORD_n that its textures read: the first and, where there is one, the second; none without
    /// textures.
    std::vector<size_t> uv_sets;
};

/// Describes materials as primitives ask for them.
class GltfMaterials {
public:
    GltfMaterials(GltfBuffers& buffers, const ReadContext& context);

    /// The material of a primitive; `coloured`: its vertices have colours, which multiply the base.
    GltfSurface find(const JsonValue& primitive, bool coloured);

    /// Whether a material that was found shines.
    bool is_emissive(u32 material) const { return descriptions_[material].emission.value != glm::dvec3(0); }

    std::vector<MaterialDescription> take() { return std::move(descriptions_); }

private:
    GltfSurface describe(const std::optional<JsonValue>& json, bool coloured);

    GltfBuffers& buffers_;
    const ReadContext& context_;
    GltfTextures textures_;
    std::vector<MaterialDescription> descriptions_;
    std::map<std::pair<std::string, bool>, GltfSurface> known_; // by path and coloured
};

} // namespace clrt
