// SPDX-License-Identifier: Apache-2.0
#include "scene/build_extension.h"

#include "colour.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace clrt {
namespace {

/// A channel of the attenuation colour below this counts as this: an absorption that is infinite would make
/// a NaN of a way of length 0.
constexpr double SMALLEST_ATTENUATION = 1e-6;

/// A coat is never a delta lobe, nor its alpha below what the microfacet formulas are good for.
constexpr double SMALLEST_COAT_ALPHA = SMOOTH_ALPHA;

/// The table of the sheen's albedo begins here (scattering/albedo_sheen_table.h).
constexpr double SMALLEST_SHEEN_ALPHA = 0.07;

double larger_component(double value) {
    return value;
}

double larger_component(const glm::dvec3& colour) {
    return largest_component(colour);
}

/// The value that holds with the map or without it.
template <typename T>
T load(const Mapped<T>& quantity, TextureRole role, const LoadMap& load_map, u32& map) {
    if (!quantity.map || !(larger_component(quantity.value) > 0))
        return quantity.value;
    map = load_map(*quantity.map, role);
    return map == NO_INDEX ? quantity.without_map.value_or(quantity.value) : quantity.value;
}

/// Absorption per length of the normalised frame by which white light becomes `colour` behind `distance`.
glm::dvec3 absorption(const glm::dvec3& colour, double distance) {
    const glm::dvec3 left = glm::clamp(colour, glm::dvec3(SMALLEST_ATTENUATION), glm::dvec3(1));
    return glm::dvec3(-std::log(left.x), -std::log(left.y), -std::log(left.z)) / distance;
}

MaterialExtension empty_extension() {
    MaterialExtension e{};
    e.coat_alpha = float(SMALLEST_COAT_ALPHA);
    EXTENSION_SHEEN_ALPHA(e) = 1;
    e.turn_cos = 1;
    e.map_transmission = e.map_coat = e.map_sheen = e.map_coat_roughness = e.map_sheen_roughness = NO_INDEX;
    e.map_anisotropy = NO_INDEX;
    return e;
}

} // namespace

BuiltExtension build_extension(const MaterialDescription& from, const Material& material,
                               const MaterialContext& context, const LoadMap& load_map) {
    BuiltExtension built{false, empty_extension()};
    MaterialExtension& e = built.extension;
    const auto squared = [](double x) { return x * x; };
    if (material.flags & MATERIAL_ATTENUATES)
        e.attenuation =
            to_vec4(absorption(from.attenuation_colour, from.attenuation_distance * context.unit));
    if (material.flags & MATERIAL_DISPERSES)
        e.spread = float((from.ior - 1) / std::max(from.abbe, SMALLEST_ABBE));
    if (material.flags & MATERIAL_NESTED)
        e.priority = float(from.priority.value_or(0));
    if (material.flags & MATERIAL_PART_GLASS)
        EXTENSION_TRANSMISSION(e) =
            float(load(from.transmission_weight, TextureRole::SCALAR, load_map, e.map_transmission));
    if (material.flags & MATERIAL_TURNED) {
        const double angle = 2 * PI * from.anisotropy_rotation;
        e.turn_cos = float(std::cos(angle));
        e.turn_sin = float(std::sin(angle));
        if (from.anisotropy_map)
            e.map_anisotropy = load_map(*from.anisotropy_map, TextureRole::NORMAL);
        e.anisotropy = float(from.anisotropy_strength);
    }
    if (material.lobes & LOBE_COAT) {
        e.coat = float(load(from.coat_weight, TextureRole::SCALAR, load_map, e.map_coat));
        const double roughness =
            load(from.coat_roughness, TextureRole::SCALAR, load_map, e.map_coat_roughness);
        e.coat_alpha = float(std::max(squared(roughness), SMALLEST_COAT_ALPHA));
    }
    if (material.lobes & LOBE_SHEEN) {
        const glm::dvec3 colour = load(from.sheen, TextureRole::COLOUR, load_map, e.map_sheen);
        const double roughness =
            load(from.sheen_roughness, TextureRole::SCALAR, load_map, e.map_sheen_roughness);
        e.sheen = to_vec4(colour, std::max(squared(roughness), SMALLEST_SHEEN_ALPHA));
    }
    const u32 flags =
        MATERIAL_ATTENUATES | MATERIAL_PART_GLASS | MATERIAL_TURNED | MATERIAL_DISPERSES | MATERIAL_NESTED;
    built.is_needed = (material.flags & flags) || (material.lobes & (LOBE_COAT | LOBE_SHEEN | LOBE_MEASURED));
    return built;
}

void append_extension(const BuiltExtension& built, Scene& scene) {
    if (scene.extensions.empty() && !built.is_needed)
        return;
    scene.extensions.resize(scene.materials.size() - 1, empty_extension());
    scene.extensions.push_back(built.extension);
}

} // namespace clrt
