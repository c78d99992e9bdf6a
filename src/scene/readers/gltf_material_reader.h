// SPDX-License-Identifier: Apache-2.0
// One material of a glTF file -> its description.
#pragma once

#include "scene/material_description.h"
#include "scene/readers/gltf_textures.h"
#include "scene/readers/reader_table.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Describes one material by the standard's metallic-roughness model and the extensions that
/// gltf_extensions.h lists as read.
class GltfMaterialReader {
public:
    GltfMaterialReader(const JsonValue& json, GltfTextures& textures, const ReadContext& context)
        : json_(json), textures_(textures), context_(context) {}

    /// Throws SceneError: JSON path, expected, found.
    MaterialDescription read();

    /// TEXCOORD_n of the textures that were read, at most two, those of the normal map first: its directions
    /// are those of the first.
    const std::vector<size_t>& uv_sets() const { return uv_sets_; }

private:
    std::optional<JsonValue> extension(const char* name) const;
    std::optional<TextureUse> texture(const JsonValue& owner, const char* key);
    std::optional<TextureUse> channel(const JsonValue& owner, const char* key, u32 channel);
    bool has_alpha(const TextureUse& use) const; ///< some texel is not opaque
    void notice(const std::string& text) const;  ///< about this material

    void read_base(const JsonValue& model);
    void read_metallic_roughness(const JsonValue& model);
    void read_specular_glossiness(const JsonValue& model);
    void read_dielectric();
    void read_specular_textures(const JsonValue& specular);
    void read_transmission();
    void read_volume();
    void read_coat();
    void read_sheen();
    void read_anisotropy();
    void read_normal_map();
    void read_emission();
    void read_alpha();
    void make_unlit();

    JsonValue json_;
    GltfTextures& textures_;
    const ReadContext& context_;
    MaterialDescription m_;
    double base_alpha_ = 1;
    std::vector<size_t> uv_sets_;
};

} // namespace clrt
