// SPDX-License-Identifier: Apache-2.0
// The extensions of glTF materials.
#include "colour.h"
#include "scene/readers/gltf_material_reader.h"
#include "scene/readers/gltf_values.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>

namespace clrt {

namespace {

/// Reflectance head-on of an index of refraction; the standard's 0 stands for infinity.
double reflectance_of_index(double ior) {
    const double root = (ior - 1) / (ior + 1);
    return ior > 0 ? root * root : 1;
}

/// KHR_materials_dispersion stores this over the Abbe number.
constexpr double DISPERSION_TIMES_ABBE = 20;

/// The least a / b of GGX roughnesses across and along that `anisotropy` makes.
constexpr double LEAST_ASPECT = 0.1;

/// What is smooth stays so: of this roughness a map can stretch a highlight.
constexpr double LEAST_STRETCHED_ROUGHNESS = 0.02;

} // namespace

std::optional<TextureUse> GltfMaterialReader::channel(const JsonValue& owner, const char* key, u32 channel) {
    std::optional<TextureUse> use = texture(owner, key);
    if (use)
        use->channel = channel;
    return use;
}

/// F0 = min(F0(ior) colour, 1) weight, of what is no metal.
void GltfMaterialReader::read_dielectric() {
    if (const auto ior = extension("KHR_materials_ior"))
        m_.ior = ior->number("ior", DEFAULT_IOR);
    m_.dielectric_f0.value = reflectance_of_index(m_.ior);
    m_.ior = m_.ior > 0 ? m_.ior : DEFAULT_IOR;
    const std::optional<JsonValue> specular = extension("KHR_materials_specular");
    if (!specular)
        return;
    const double weight = gltf_unit_number(*specular, "specularFactor", 1), plain = m_.dielectric_f0.value;
    const glm::dvec3 f0 =
        plain > 0 ? plain * gltf_colour(*specular, "specularColorFactor", 1, 1 / plain) : glm::dvec3(0);
    const double largest = largest_component(f0);
    m_.dielectric_f0.value = largest * weight;
    m_.specular_tint = largest > 0 ? f0 / largest : glm::dvec3(1);
    read_specular_textures(*specular);
}

/// The alpha of one multiplies the colours of the other; they are mostly one picture.
void GltfMaterialReader::read_specular_textures(const JsonValue& specular) {
    std::optional<TextureUse> weight = texture(specular, "specularTexture"),
                              colour = texture(specular, "specularColorTexture");
    if (colour && weight && !is_same_lookup(*colour, *weight)) {
        notice("specularTexture is ignored beside a specularColorTexture of another picture");
        weight.reset();
    }
    if (weight)
        weight->alpha = colour ? TextureAlpha::MULTIPLIES : TextureAlpha::ALONE;
    m_.dielectric_f0.map = weight ? weight : colour;
    m_.dielectric_f0_role = TextureRole::COLOUR;
}

/// Without a volume the surface is a wall of no thickness, by the letter of the standard.
void GltfMaterialReader::read_transmission() {
    const std::optional<JsonValue> transmission = extension("KHR_materials_transmission");
    if (!transmission)
        return;
    m_.transmission_weight.value = gltf_unit_number(*transmission, "transmissionFactor", 0);
    m_.transmission_weight.map = channel(*transmission, "transmissionTexture", CHANNEL_RED);
    if (!(m_.transmission_weight.value > 0))
        return;
    m_.rule += ", glass";
    const std::optional<JsonValue> volume = extension("KHR_materials_volume");
    const bool is_solid = volume && volume->number("thicknessFactor", 0) > 0;
    m_.is_thin = !is_solid && !context_.gltf.solid_glass;
    if (is_solid)
        read_volume();
    else
        notice(m_.is_thin ? "transmission without a volume is a thin wall, as the standard says: "
                            "--gltf-solid-glass makes it solid, as Blender does"
                          : "transmission without a volume is solid glass (--gltf-solid-glass)");
}

/// The thickness is that of the mesh: its factor and texture are for those who do not trace rays.
void GltfMaterialReader::read_volume() {
    const JsonValue volume = *extension("KHR_materials_volume");
    m_.attenuation_colour = gltf_colour(volume, "attenuationColor", 1);
    m_.attenuation_distance = std::max(volume.number("attenuationDistance", 0), 0.0);
    const std::optional<JsonValue> dispersion = extension("KHR_materials_dispersion");
    const double amount = dispersion ? dispersion->number("dispersion", 0) : 0;
    m_.abbe = amount > 0 ? DISPERSION_TIMES_ABBE / amount : 0;
}

void GltfMaterialReader::read_coat() {
    const std::optional<JsonValue> coat = extension("KHR_materials_clearcoat");
    if (!coat)
        return;
    m_.coat_weight.value = gltf_unit_number(*coat, "clearcoatFactor", 0);
    m_.coat_weight.map = channel(*coat, "clearcoatTexture", CHANNEL_RED);
    m_.coat_roughness.value = gltf_unit_number(*coat, "clearcoatRoughnessFactor", 0);
    m_.coat_roughness.map = channel(*coat, "clearcoatRoughnessTexture", CHANNEL_GREEN);
    if (coat->find("clearcoatNormalTexture"))
        notice("clearcoatNormalTexture is ignored: a coat has the normals of what it covers");
}

void GltfMaterialReader::read_sheen() {
    const std::optional<JsonValue> sheen = extension("KHR_materials_sheen");
    if (!sheen)
        return;
    m_.sheen.value = gltf_colour(*sheen, "sheenColorFactor", 0);
    m_.sheen.map = texture(*sheen, "sheenColorTexture");
    m_.sheen_roughness.value = gltf_unit_number(*sheen, "sheenRoughnessFactor", 0);
    m_.sheen_roughness.map = channel(*sheen, "sheenRoughnessTexture", CHANNEL_ALPHA);
}

/// Along the tangent a_t = mix(a, 1, s^2), across it a_b = a = roughness^2; ours are r^2 over and times the
/// root of (1 - 0.9 anisotropy), so r^4 = a_t a_b.
void GltfMaterialReader::read_anisotropy() {
    const std::optional<JsonValue> anisotropy = extension("KHR_materials_anisotropy");
    if (!anisotropy)
        return;
    const double strength = gltf_unit_number(*anisotropy, "anisotropyStrength", 0);
    // The tangent's right-hand neighbour is the v that grows upwards, as ours does.
    m_.anisotropy_rotation = anisotropy->number("anisotropyRotation", 0) / glm::two_pi<double>();
    m_.anisotropy_map = strength > 0 ? texture(*anisotropy, "anisotropyTexture") : std::nullopt;
    m_.anisotropy_strength = strength;
    if (m_.anisotropy_map) {
        m_.roughness.value = std::max(m_.roughness.value, LEAST_STRETCHED_ROUGHNESS);
        return;
    }
    const double across = m_.roughness.value * m_.roughness.value,
                 along = glm::mix(across, 1.0, strength * strength);
    if (!(along > 0))
        return;
    const double aspect = std::max(across / along, LEAST_ASPECT);
    m_.anisotropy = (1 - aspect) / (1 - LEAST_ASPECT);
    m_.roughness.value = std::sqrt(std::sqrt(along * along * aspect));
    if (across / along < LEAST_ASPECT)
        notice("highlights are stretched to 1:10 at most");
}

} // namespace clrt
