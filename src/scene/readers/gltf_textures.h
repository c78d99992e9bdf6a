// SPDX-License-Identifier: Apache-2.0
// The textures of a glTF file -> uses of pictures.
#pragma once

#include "scene/notices.h"
#include "scene/readers/gltf_buffers.h"
#include "scene/texture_use.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace clrt {

/// A texture as a material refers to it.
struct GltfTexture {
    TextureUse use;    ///< for texture coordinates from the lower left
    size_t uv_set = 0; ///< TEXCOORD_n
};

class GltfTextures {
public:
    GltfTextures(GltfBuffers& buffers, NoticeList& notices) : buffers_(buffers), notices_(notices) {}

    /// The texture of a textureInfo; nothing, with a notice, for a format that cannot be read. Throws
    /// SceneError: JSON path, expected, found.
    std::optional<GltfTexture> find(const JsonValue& info);

private:
    void set_picture(const JsonValue& image, TextureUse& use);
    std::shared_ptr<const std::string> bytes_of(const JsonValue& image);

    GltfBuffers& buffers_;
    NoticeList& notices_;
    std::map<std::string, std::shared_ptr<const std::string>> bytes_; // of images, by path
};

} // namespace clrt
