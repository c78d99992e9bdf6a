// SPDX-License-Identifier: Apache-2.0
#include "scene/vertex_colours.h"

#include "colour.h"
#include "error.h"
#include "scene/texture_store.h"

#include <algorithm>
#include <cstring>

namespace clrt {

void store_vertex_colours(Scene& scene, const std::string& path) {
    const std::vector<glm::vec3> colours = std::move(scene.vertex_colours);
    scene.vertex_colours = {};
    const auto is_by_vertex = [](const Texture& texture) {
        return texture.vertex_word == VERTEX_WORD_TO_COME;
    };
    if (colours.empty() || std::none_of(scene.textures.begin(), scene.textures.end(), is_by_vertex))
        return;
    const size_t first = scene.texel_words.size(), words = 3 * colours.size();
    if (first + words > NO_INDEX)
        throw SceneError(path, 0,
                         "vertex colours and textures need more than 2^32 words: expected fewer vertices or "
                         "smaller pictures");
    scene.texel_words.resize(first + words);
    std::memcpy(&scene.texel_words[first], colours.data(), words * sizeof(u32));
    for (Texture& texture : scene.textures)
        if (is_by_vertex(texture))
            texture.vertex_word = u32(first);
}

} // namespace clrt
