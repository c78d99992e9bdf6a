// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_materials.h"

#include "scene/readers/gltf_material_reader.h"

namespace clrt {

namespace {

/// The colours of vertices multiply the base.
void colour_by_vertex(MaterialDescription& material) {
    if (material.base.map) {
        material.base.map->times_vertex = true;
        return;
    }
    TextureUse vertices;
    vertices.file = "vertex colours";
    vertices.place = material.place;
    vertices.by_vertex = true;
    material.base.map = vertices;
}

/// The standard's material where a primitive names none.
MaterialDescription default_material(const std::string& file) {
    MaterialDescription material;
    material.place = {file, 0};
    material.rule = "glTF: no material, a rough white metal";
    material.reflection = Reflection::METALLIC;
    material.base.value = glm::dvec3(1);
    material.metallic.value = material.roughness.value = 1;
    return material;
}

} // namespace

GltfMaterials::GltfMaterials(GltfBuffers& buffers, const ReadContext& context)
    : buffers_(buffers), context_(context), textures_(buffers, context.notices) {}

GltfSurface GltfMaterials::find(const JsonValue& primitive, bool coloured) {
    const std::optional<JsonValue> index = primitive.find("material");
    std::optional<JsonValue> json;
    if (index)
        json = buffers_.file().json().element("materials", *index);
    const auto [known, is_new] = known_.try_emplace({json ? json->path() : "", coloured});
    if (is_new)
        known->second = describe(json, coloured);
    return known->second;
}

GltfSurface GltfMaterials::describe(const std::optional<JsonValue>& json, bool coloured) {
    GltfSurface surface{u32(descriptions_.size()), {}};
    MaterialDescription material = default_material(buffers_.file().name());
    if (json) {
        GltfMaterialReader reader(*json, textures_, context_);
        material = reader.read();
        surface.uv_sets = reader.uv_sets();
    }
    if (coloured)
        colour_by_vertex(material);
    descriptions_.push_back(material);
    return surface;
}

} // namespace clrt
