// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_material_reader.h"

#include "scene/readers/gltf_values.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>

namespace clrt {

namespace {

/// A texture's alpha against a threshold: a ramp so steep that it is a step for bytes, and for what lies
/// between two texels; floats still resolve it.
constexpr double MASK_SLOPE = 1 << 16;

/// The most that emission is multiplied by: sums of films hold no more.
constexpr double MOST_EMISSIVE_STRENGTH = 1e12;

/// Up to this roughness `whitted` follows the reflection as a mirror's.
constexpr double WHITTED_MIRROR_ROUGHNESS = 0.1;

} // namespace

std::optional<JsonValue> GltfMaterialReader::extension(const char* name) const {
    const std::optional<JsonValue> extensions = json_.find("extensions");
    return extensions ? extensions->find(name) : std::nullopt;
}

bool GltfMaterialReader::has_alpha(const TextureUse& use) const {
    return context_.pictures.has_alpha && context_.pictures.has_alpha(use);
}

void GltfMaterialReader::notice(const std::string& text) const {
    context_.notices.add(text, json_.place());
}

/// Textures of one material read two sets of coordinates, those of the first two textures.
std::optional<TextureUse> GltfMaterialReader::texture(const JsonValue& owner, const char* key) {
    const std::optional<JsonValue> info = owner.find(key);
    std::optional<GltfTexture> found = info ? textures_.find(*info) : std::nullopt;
    if (!found)
        return std::nullopt;
    if (std::find(uv_sets_.begin(), uv_sets_.end(), found->uv_set) == uv_sets_.end()) {
        if (uv_sets_.size() < 2)
            uv_sets_.push_back(found->uv_set);
        else
            notice(
                "a material reads its textures by two sets of coordinates; those that ask for another read "
                "the first");
    }
    found->use.by_second_uvs = uv_sets_.size() == 2 && uv_sets_[1] == found->uv_set;
    return found->use;
}

MaterialDescription GltfMaterialReader::read() {
    m_.name = json_.text("name");
    m_.place = {json_.file(), 0};
    m_.reflection = Reflection::METALLIC;
    m_.base.value = glm::dvec3(1);
    m_.metallic.value = m_.roughness.value = 1;
    m_.rule = "glTF: metallic-roughness";
    read_normal_map();
    if (const auto gloss = extension("KHR_materials_pbrSpecularGlossiness"))
        read_specular_glossiness(*gloss);
    else if (const auto model = json_.find("pbrMetallicRoughness")) {
        read_base(*model);
        read_metallic_roughness(*model);
    }
    read_dielectric();
    read_transmission();
    read_coat();
    read_sheen();
    read_anisotropy();
    read_emission();
    read_alpha();
    if (extension("KHR_materials_unlit"))
        make_unlit();
    m_.whitted_mirror = m_.roughness.value <= WHITTED_MIRROR_ROUGHNESS && !m_.roughness.map;
    return m_;
}

void GltfMaterialReader::read_base(const JsonValue& model) {
    if (const std::optional<JsonValue> factor = model.find("baseColorFactor")) {
        const std::array<double, 4> c = factor->numbers<4>();
        m_.base.value = glm::clamp(glm::dvec3(c[0], c[1], c[2]), 0.0, 1.0);
        base_alpha_ = std::clamp(c[3], 0.0, 1.0);
    }
    m_.base.map = texture(model, "baseColorTexture");
}

void GltfMaterialReader::read_metallic_roughness(const JsonValue& model) {
    m_.metallic.value = gltf_unit_number(model, "metallicFactor", 1);
    m_.roughness.value = gltf_unit_number(model, "roughnessFactor", 1);
    const std::optional<TextureUse> both = texture(model, "metallicRoughnessTexture");
    if (!both)
        return;
    m_.metallic.map = m_.roughness.map = both;
    m_.metallic.map->channel = CHANNEL_BLUE;
    m_.roughness.map->channel = CHANNEL_GREEN;
}

void GltfMaterialReader::read_specular_glossiness(const JsonValue& model) {
    m_.rule = "glTF: specular-glossiness";
    m_.reflection = Reflection::SCHLICK;
    if (const std::optional<JsonValue> factor = model.find("diffuseFactor")) {
        const std::array<double, 4> c = factor->numbers<4>();
        m_.base.value = glm::clamp(glm::dvec3(c[0], c[1], c[2]), 0.0, 1.0);
        base_alpha_ = std::clamp(c[3], 0.0, 1.0);
    }
    m_.base.map = texture(model, "diffuseTexture");
    m_.specular.value = gltf_colour(model, "specularFactor", 1);
    m_.specular.map = texture(model, "specularGlossinessTexture");
    const double glossiness = gltf_unit_number(model, "glossinessFactor", 1);
    m_.roughness.value = 1 - glossiness;
    if (m_.specular.map && has_alpha(*m_.specular.map))
        m_.roughness = {1, m_.specular.map, 1 - glossiness};
    if (m_.roughness.map) {
        m_.roughness.map->channel = CHANNEL_ALPHA;
        m_.roughness.map->base = 1;
        m_.roughness.map->gain = -glossiness;
    }
}

void GltfMaterialReader::read_normal_map() {
    m_.normal_map = texture(json_, "normalTexture");
    if (m_.normal_map)
        m_.normal_strength = json_.at("normalTexture").number("scale", 1);
}

void GltfMaterialReader::read_emission() {
    const auto strength = extension("KHR_materials_emissive_strength");
    const double factor =
        strength ? std::clamp(strength->number("emissiveStrength", 1), 0.0, MOST_EMISSIVE_STRENGTH) : 1;
    m_.emission.value = gltf_colour(json_, "emissiveFactor", 0) * factor;
    m_.emission.map = texture(json_, "emissiveTexture");
    m_.emits_both_sides = json_.boolean("doubleSided", false);
}

void GltfMaterialReader::read_alpha() {
    const std::optional<JsonValue> mode = json_.find("alphaMode");
    const std::string name = mode ? mode->text() : "OPAQUE";
    if (name == "OPAQUE")
        return;
    if (name != "MASK" && name != "BLEND")
        mode->fail("OPAQUE, MASK or BLEND");
    std::optional<TextureUse> alpha = m_.base.map;
    if (alpha && !has_alpha(*alpha))
        alpha.reset();
    if (alpha)
        alpha->channel = CHANNEL_ALPHA;
    m_.coverage.value = base_alpha_;
    m_.coverage.map = alpha;
    if (name == "BLEND")
        return;
    const double cutoff = json_.number("alphaCutoff", 0.5);
    if (!alpha) {
        m_.coverage.value = base_alpha_ >= cutoff ? 1 : 0;
        return;
    }
    m_.coverage.value = 1;
    alpha->gain = MASK_SLOPE * base_alpha_;
    alpha->base = 1 - MASK_SLOPE * cutoff;
    m_.coverage.map = alpha;
}

/// It shows its colour whatever the light: it shines with it, and reflects nothing.
void GltfMaterialReader::make_unlit() {
    notice("unlit materials shine with their colour, so they light others too");
    m_.rule = "glTF: unlit";
    m_.reflection = Reflection::NONE;
    m_.emission = {m_.base.value, m_.base.map};
    m_.emits_both_sides = true;
    m_.base = {glm::dvec3(0)};
}

} // namespace clrt
