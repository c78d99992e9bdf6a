// SPDX-License-Identifier: Apache-2.0
// Image files -> texel words and Texture records; every file is read once for each way of storing it.
#pragma once

#include "options/scene_options.h"
#include "scene/notices.h"
#include "scene/read_image.h"
#include "scene/texture_use.h"

#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// The first words hold the sRGB curve: word i is the linear value of byte i as the bits of a float.
constexpr u32 SRGB_TABLE_WORDS = 256;

/// Texture::vertex_word of a texture that waits for store_vertex_colours().
constexpr u32 VERTEX_WORD_TO_COME = NO_INDEX;

class TextureStore {
public:
    explicit TextureStore(TextureFilter filter = TextureFilter::NONE); ///< with levels for FOOTPRINT

    /// Adds a use of a map and returns its index; NO_INDEX, with one notice per file, if it cannot be read.
    /// The file is looked for relative to the file that names it (find_file.h). Throws SceneError if the
    /// texels exceed 2^32 words. The texels of a use by_vertex are added later (store_vertex_colours).
    u32 add(const TextureUse& use, TextureRole role, NoticeList& notices);

    /// Reads the pictures of these uses, several at once, and stores them in this order, so that add() finds
    /// them. What cannot be read is left to add(), and what another use may share its texels with.
    void read_ahead(const std::vector<std::pair<TextureUse, TextureRole>>& uses, NoticeList& notices);

    /// Whether a map can be read. Where not, add() says why.
    bool is_readable(const TextureUse& use, TextureRole role, NoticeList& notices);

    /// Whether the picture of a map is a normal map by its texels: in colour, nearly all of them unit vectors
    /// coded as (n + 1) / 2, and on the whole near +z. False where it cannot be read; add() says why.
    bool is_normal_map(const TextureUse& use, NoticeList& notices);

    /// Whether some texel of a picture of colours is not opaque. False where it cannot be read.
    bool has_alpha(const TextureUse& use, NoticeList& notices);

    /// Mean of the texture's values over its picture: linear, with base and gain, negative values as 0.
    glm::dvec3 mean(u32 texture) const;

    /// The largest of these values, channel by channel: no lookup between texels gives more.
    glm::dvec3 largest(u32 texture) const;

    /// Linear r, g, b, a of a texel, as a kernel decodes it; without base and gain.
    vec4 texel(const Texture& texture, u32 x, u32 y) const;

    std::vector<Texture> take_textures() { return std::move(textures_); }
    std::vector<u32> take_words() { return std::move(words_); }
    std::vector<std::string> take_names() { return std::move(names_); }
    std::vector<SourcePlace> take_places() { return std::move(places_); }
    /// Every picture that was opened, those that cannot be read included.
    const std::set<std::string>& files() const { return files_; }
    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<u32>& words() const { return words_; }

private:
    struct StoredImage {
        u32 first_word, width, height, format;
        bool has_alpha, is_grey;
        std::optional<bool> is_normal_map = std::nullopt; ///< once asked
    };

    u32 add_record(const Texture& texture, const TextureUse& use);

    /// Calls action(rgb) for the value of each texel: base and gain applied, 0 where that is negative.
    template <class Action>
    void for_each_value(u32 texture, Action&& action) const;

    StoredImage* find_or_read(const TextureUse& use, TextureRole role, NoticeList& notices);
    StoredImage* try_to_read(const TextureUse& use, TextureRole role, NoticeList& notices);
    bool has_unit_vectors(const StoredImage& image) const;
    StoredImage store(const Image& image, ImageEncoding encoding, const std::string& path,
                      NoticeList& notices);
    void store_floats(const Image& image, const std::string& path, NoticeList& notices);
    void store_bytes(const Image& image, u32 format);

    TextureFilter filter_;

    std::vector<Texture> textures_;
    std::vector<std::string> names_;
    std::vector<SourcePlace> places_;
    std::vector<u32> words_;
    std::set<std::string> files_;
    std::map<std::pair<std::string, ImageEncoding>, StoredImage> images_;
};

} // namespace clrt
