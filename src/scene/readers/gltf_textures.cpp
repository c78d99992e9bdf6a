// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_textures.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

TextureWrap wrap_of(const JsonValue& sampler, const char* key) {
    const std::optional<JsonValue> mode = sampler.find(key);
    if (!mode)
        return TextureWrap::REPEAT;
    switch (mode->whole()) {
    case 10497:
        return TextureWrap::REPEAT;
    case 33071:
        return TextureWrap::EDGE;
    case 33648:
        return TextureWrap::MIRROR;
    default:
        mode->fail("10497 (repeat), 33071 (clamp to edge) or 33648 (mirrored repeat)");
    }
}

/// What KHR_texture_transform says, in coordinates from the upper left.
struct UvTransform {
    glm::dvec2 offset{0}, scale{1};
    double rotation = 0; ///< radians, counter-clockwise as seen on the picture
};

glm::dvec2 pair_of(const JsonValue& object, const char* key, const glm::dvec2& otherwise) {
    const std::optional<JsonValue> value = object.find(key);
    if (!value)
        return otherwise;
    const std::array<double, 2> numbers = value->numbers<2>();
    return {numbers[0], numbers[1]};
}

/// u' = c sx u + s sy v + ox, v' = -s sx u + c sy v + oy from the upper left; with t = 1 - v from below.
void set_transform(const UvTransform& from, TextureUse& use) {
    const double c = std::cos(from.rotation), s = std::sin(from.rotation);
    use.scale = {c * from.scale.x, c * from.scale.y};
    use.shear = {-s * from.scale.y, s * from.scale.x};
    use.offset = {from.offset.x + s * from.scale.y, 1 - from.offset.y - c * from.scale.y};
}

/// The image of a texture; EXT_texture_webp may stand in for one that other readers know.
std::optional<JsonValue> find_source(const JsonValue& texture) {
    const std::optional<JsonValue> extensions = texture.find("extensions");
    const std::optional<JsonValue> webp = extensions ? extensions->find("EXT_texture_webp") : std::nullopt;
    return webp ? webp->find("source") : texture.find("source");
}

} // namespace

std::optional<GltfTexture> GltfTextures::find(const JsonValue& info) {
    const JsonDocument& json = buffers_.file().json();
    const JsonValue texture = json.element("textures", info.at("index"));
    const std::optional<JsonValue> source = find_source(texture);
    if (!source) {
        notices_.add("a texture without a picture that can be read (KHR_texture_basisu?) is ignored",
                     texture.place());
        return std::nullopt;
    }
    GltfTexture result;
    result.uv_set = info.whole("texCoord", 0);
    result.use.place = {info.file(), 0};
    set_picture(json.element("images", *source), result.use);
    if (const std::optional<JsonValue> sampler = texture.find("sampler")) {
        const JsonValue modes = json.element("samplers", *sampler);
        result.use.wrap_u = wrap_of(modes, "wrapS");
        result.use.wrap_v = wrap_of(modes, "wrapT");
    }
    const std::optional<JsonValue> extensions = info.find("extensions");
    if (const auto transform = extensions ? extensions->find("KHR_texture_transform") : std::nullopt) {
        result.uv_set = transform->whole("texCoord", result.uv_set);
        set_transform({pair_of(*transform, "offset", glm::dvec2(0)),
                       pair_of(*transform, "scale", glm::dvec2(1)), transform->number("rotation", 0)},
                      result.use);
    }
    return result;
}

void GltfTextures::set_picture(const JsonValue& image, TextureUse& use) {
    const std::optional<JsonValue> uri = image.find("uri");
    if (uri && !is_data_uri(uri->text())) {
        use.file = gltf_file_name(*uri);
        return;
    }
    use.bytes = bytes_of(image);
    const std::string name = image.text("name");
    use.file = name.empty() ? image.path() : fmt::format("{} ({})", image.path(), name);
}

std::shared_ptr<const std::string> GltfTextures::bytes_of(const JsonValue& image) {
    std::shared_ptr<const std::string>& bytes = bytes_[image.path()];
    if (!bytes) {
        const std::optional<JsonValue> uri = image.find("uri");
        bytes = std::make_shared<const std::string>(
            uri ? data_uri_bytes(*uri) : std::string(buffers_.view(image.at("bufferView")).bytes));
    }
    return bytes;
}

} // namespace clrt
