// SPDX-License-Identifier: Apache-2.0
#include "scene/texture_store.h"

#include "colour.h"
#include "error.h"
#include "float_bits.h"
#include "scene/find_file.h"
#include "scene/text_scanner.h"
#include "scene/texture_levels.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// What tells normal maps from other pictures: of 23 pictures the normal maps had a share of 0.990 or more of
/// texels whose length is within the tolerance of 1, the next, a bluish one, had 0.938.
constexpr double NORMAL_MAP_TOLERANCE = 0.1, NORMAL_MAP_SHARE = 0.97;
/// Of the mean texel: (n.z + 1) / 2 is 0.8 at 53 degrees from +z.
constexpr double NORMAL_MAP_BLUE = 0.8;

ImageEncoding encoding_of(TextureRole role) {
    return role == TextureRole::COLOUR ? ImageEncoding::COLOUR : ImageEncoding::DATA;
}

/// By what a picture is known; nothing for a file that is not there.
std::optional<std::string> path_of_picture(const TextureUse& use) {
    if (use.bytes)
        return use.place.file + ": " + use.file;
    const auto found = find_file(use.file, use.place.file);
    return found ? std::optional<std::string>(*found) : std::nullopt;
}

/// Pictures that are decoded at once: their memory is needed beside that of their texels.
constexpr size_t PICTURES_AT_ONCE = 4;

} // namespace

TextureStore::TextureStore(TextureFilter filter) : filter_(filter) {
    words_.resize(SRGB_TABLE_WORDS);
    for (u32 i = 0; i < SRGB_TABLE_WORDS; ++i)
        words_[i] = float_bits(float(srgb_to_linear(i / 255.0)));
}

u32 TextureStore::add_record(const Texture& texture, const TextureUse& use) {
    textures_.push_back(texture);
    names_.push_back(use.file);
    places_.push_back(use.place);
    return u32(textures_.size() - 1);
}

u32 TextureStore::add(const TextureUse& use, TextureRole role, NoticeList& notices) {
    if (use.by_vertex) {
        Texture texture{};
        texture.width = texture.height = 1;
        texture.format = TEXEL_VERTEX;
        texture.gain = 1;
        texture.vertex_word = VERTEX_WORD_TO_COME;
        return add_record(texture, use);
    }
    const StoredImage* image = find_or_read(use, role, notices);
    if (!image)
        return NO_INDEX;
    Texture texture{};
    texture.first_word = image->first_word;
    texture.width = image->width;
    texture.height = image->height;
    texture.format = image->format;
    texture.scale_u = float(use.scale.x);
    texture.scale_v = float(use.scale.y);
    texture.offset_u = float(use.offset.x);
    texture.offset_v = float(use.offset.y);
    texture.shear_u = float(use.shear.x);
    texture.shear_v = float(use.shear.y);
    texture.base = float(use.base);
    texture.gain = float(use.gain);
    texture.wrap_u = u32(use.wrap_u);
    texture.wrap_v = u32(use.wrap_v);
    texture.vertex_word = use.times_vertex ? VERTEX_WORD_TO_COME : 0;
    texture.channel = role == TextureRole::COVERAGE && image->has_alpha ? CHANNEL_ALPHA
                      : image->is_grey                                  ? 0
                                                                        : CHANNEL_LUMINANCE;
    if (use.channel)
        texture.channel = *use.channel;
    texture.channel |= (use.by_second_uvs ? TEXTURE_SECOND_UV : 0) |
                       (use.alpha != TextureAlpha::IGNORED ? TEXTURE_TIMES_ALPHA : 0) |
                       (use.alpha == TextureAlpha::ALONE ? TEXTURE_WHITE : 0);
    return add_record(texture, use);
}

TextureStore::StoredImage* TextureStore::find_or_read(const TextureUse& use, TextureRole role,
                                                      NoticeList& notices) {
    const auto path = path_of_picture(use);
    if (!path) {
        notices.add(fmt::format("no file {} found, the map is ignored", clrt::quoted(use.file)), use.place);
        return nullptr;
    }
    // Alpha is linear in both encodings: a mask shares the texels of the colours beside it.
    const auto as_colour = images_.find({*path, ImageEncoding::COLOUR});
    if (role == TextureRole::COVERAGE && as_colour != images_.end() && as_colour->second.has_alpha &&
        use.channel.value_or(CHANNEL_ALPHA) == CHANNEL_ALPHA)
        return &as_colour->second;

    const ImageEncoding encoding = encoding_of(role);
    const auto known = images_.find({*path, encoding});
    if (known != images_.end())
        return &known->second;
    if (!use.bytes)
        files_.insert(*path);
    Image image;
    try {
        image = read_image(use.bytes ? use.file : *path, encoding, use.bytes.get());
    } catch (const SceneError& error) {
        notices.add(fmt::format("{}; the map is ignored", error.what()), use.place);
        return nullptr;
    }
    return &images_.emplace(std::make_pair(*path, encoding), store(image, encoding, *path, notices))
                .first->second;
}

TextureStore::StoredImage* TextureStore::try_to_read(const TextureUse& use, TextureRole role,
                                                     NoticeList& notices) {
    NoticeList found;
    StoredImage* image = find_or_read(use, role, found);
    for (const std::string& line : image ? found.lines() : std::vector<std::string>())
        notices.add_line(line);
    return image;
}

bool TextureStore::is_readable(const TextureUse& use, TextureRole role, NoticeList& notices) {
    return try_to_read(use, role, notices) != nullptr;
}

bool TextureStore::is_normal_map(const TextureUse& use, NoticeList& notices) {
    StoredImage* image = try_to_read(use, TextureRole::NORMAL, notices);
    if (!image || image->is_grey)
        return false;
    if (!image->is_normal_map)
        image->is_normal_map = has_unit_vectors(*image);
    return *image->is_normal_map;
}

bool TextureStore::has_alpha(const TextureUse& use, NoticeList& notices) {
    const StoredImage* image = try_to_read(use, TextureRole::COLOUR, notices);
    if (!image || !image->has_alpha)
        return false;
    Texture texture{};
    texture.first_word = image->first_word;
    texture.width = image->width;
    texture.format = image->format;
    for (u32 y = 0; y < image->height; ++y)
        for (u32 x = 0; x < image->width; ++x)
            if (texel(texture, x, y).w < 1)
                return true;
    return false;
}

bool TextureStore::has_unit_vectors(const StoredImage& image) const {
    Texture texture{};
    texture.first_word = image.first_word;
    texture.width = image.width;
    texture.format = image.format;
    size_t unit = 0;
    double blue = 0;
    for (u32 y = 0; y < image.height; ++y)
        for (u32 x = 0; x < image.width; ++x) {
            const vec4 c = texel(texture, x, y);
            const double length = std::hypot(2 * c.x - 1, 2 * c.y - 1, 2 * c.z - 1);
            unit += std::fabs(length - 1) < NORMAL_MAP_TOLERANCE;
            blue += double(c.z);
        }
    const double texels = double(image.width) * double(image.height);
    return double(unit) >= NORMAL_MAP_SHARE * texels && blue > NORMAL_MAP_BLUE * texels;
}

TextureStore::StoredImage TextureStore::store(const Image& image, ImageEncoding encoding,
                                              const std::string& path, NoticeList& notices) {
    const bool is_float = image.bytes.empty(), is_colour = encoding == ImageEncoding::COLOUR;
    const bool is_grey = image.is_grey && !image.has_alpha;
    const u32 format = is_float  ? TEXEL_FLOAT
                       : is_grey ? (is_colour ? TEXEL_GREY_SRGB8 : TEXEL_GREY_LINEAR8)
                                 : (is_colour ? TEXEL_SRGB8 : TEXEL_LINEAR8);
    const size_t own = texel_words(format, size_t(image.width) * size_t(image.height));
    // Levels take less than all of it again: each is at most half the one before.
    const size_t needed = filter_ == TextureFilter::FOOTPRINT ? 2 * own : own;
    if (words_.size() + needed > NO_INDEX)
        throw SceneError(path, 0,
                         "the textures need more than 2^32 words of texels: expected smaller or fewer "
                         "pictures");
    const StoredImage stored{u32(words_.size()), u32(image.width), u32(image.height), format,
                             image.has_alpha,    image.is_grey};
    if (is_float)
        store_floats(image, path, notices);
    else
        store_bytes(image, format);
    if (filter_ == TextureFilter::FOOTPRINT)
        append_levels(format, stored.width, stored.height, words_);
    return stored;
}

void TextureStore::store_floats(const Image& image, const std::string& path, NoticeList& notices) {
    const size_t first = words_.size();
    words_.resize(first + 4 * image.floats.size());
    u32* word = &words_[first];
    size_t non_finite = 0;
    for (const vec4& texel : image.floats)
        for (float value : {texel.x, texel.y, texel.z, texel.w}) {
            non_finite += !std::isfinite(value);
            *word++ = float_bits(std::isfinite(value) ? value : 0.f);
        }
    if (non_finite)
        notices.add(fmt::format("{} values are NaN or infinite and became 0", non_finite), {path, 0});
}

void TextureStore::store_bytes(const Image& image, u32 format) {
    const size_t first = words_.size(), pixels = image.bytes.size() / 4;
    words_.resize(first + texel_words(format, pixels), 0);
    const bool is_grey = format == TEXEL_GREY_SRGB8 || format == TEXEL_GREY_LINEAR8;
    for (size_t i = 0; i < pixels; ++i) {
        const std::uint8_t* byte = &image.bytes[4 * i];
        if (is_grey)
            words_[first + i / 4] |= u32(byte[0]) << (i % 4 * 8);
        else
            words_[first + i] = u32(byte[0]) | u32(byte[1]) << 8 | u32(byte[2]) << 16 | u32(byte[3]) << 24;
    }
}

void TextureStore::read_ahead(const std::vector<std::pair<TextureUse, TextureRole>>& uses,
                              NoticeList& notices) {
    struct Picture {
        const TextureUse* use;
        std::pair<std::string, ImageEncoding> key;
        std::optional<Image> image = std::nullopt;
    };
    std::vector<Picture> pictures;
    std::set<std::pair<std::string, ImageEncoding>> known;
    for (const auto& [use, role] : uses) {
        if (use.by_vertex || role == TextureRole::COVERAGE)
            continue;
        const auto path = path_of_picture(use);
        if (path && !images_.count({*path, encoding_of(role)}) &&
            known.insert({*path, encoding_of(role)}).second)
            pictures.push_back({&use, {*path, encoding_of(role)}});
    }
    for (size_t begin = 0; begin < pictures.size(); begin += PICTURES_AT_ONCE) {
        const size_t end = std::min(begin + PICTURES_AT_ONCE, pictures.size());
        tbb::parallel_for(begin, end, [&](size_t i) {
            Picture& picture = pictures[i];
            try {
                picture.image = read_image(picture.use->bytes ? picture.use->file : picture.key.first,
                                           picture.key.second, picture.use->bytes.get());
            } catch (const SceneError&) {
                picture.image.reset(); // add() says why
            }
        });
        for (size_t i = begin; i < end; ++i) {
            Picture& picture = pictures[i];
            if (!picture.image)
                continue;
            if (!picture.use->bytes)
                files_.insert(picture.key.first);
            images_.emplace(picture.key,
                            store(*picture.image, picture.key.second, picture.key.first, notices));
            picture.image.reset();
        }
    }
}

vec4 TextureStore::texel(const Texture& texture, u32 x, u32 y) const {
    return decode_texel(texture.format, &words_[texture.first_word], size_t(y) * texture.width + x,
                        words_.data());
}

template <class Action>
void TextureStore::for_each_value(u32 index, Action&& action) const {
    const Texture& texture = textures_[index];
    for (u32 y = 0; y < texture.height; ++y)
        for (u32 x = 0; x < texture.width; ++x) {
            const vec4 value = texel(texture, x, y);
            glm::dvec3 mapped = glm::dvec3(value.x, value.y, value.z) * double(texture.gain) +
                                glm::dvec3(double(texture.base));
            for (int c = 0; c < 3; ++c)
                if (!(std::isfinite(mapped[c]) && mapped[c] > 0))
                    mapped[c] = 0;
            action(mapped);
        }
}

glm::dvec3 TextureStore::mean(u32 index) const {
    glm::dvec3 sum(0);
    for_each_value(index, [&](const glm::dvec3& value) { sum += value; });
    return sum / (double(textures_[index].width) * double(textures_[index].height));
}

glm::dvec3 TextureStore::largest(u32 index) const {
    glm::dvec3 largest(0);
    for_each_value(index, [&](const glm::dvec3& value) { largest = glm::max(largest, value); });
    return largest;
}

} // namespace clrt
