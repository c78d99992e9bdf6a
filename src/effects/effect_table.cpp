// SPDX-License-Identifier: Apache-2.0
#include "effects/effect_table.h"

#include "scene/lobes.h"

#include <algorithm>

namespace clrt {

namespace {

/// What a map can be of; all others are not loaded.
constexpr EffectMask MAPPED = EFFECT_MATTE | EFFECT_GLOSSY | EFFECT_MIRROR | EFFECT_ROUGH_REFRACTION |
                              EFFECT_AREA_LIGHT | EFFECT_CUT_OUT | EFFECT_NORMAL_MAP;

std::string with_hyphens(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

} // namespace

const std::vector<EffectSpec>& effect_table() {
    static const std::vector<EffectSpec> table = {
        {EFFECT_AREA_LIGHT, "area lights", 0, 0, "emissive triangles are dark"},
        {EFFECT_DELTA_LIGHT, "point lights and suns", 0, 0, "--point, --spot and --sun are not there"},
        {EFFECT_ENVIRONMENT, "environment", 0, 0, "black outside the scene, background included"},
        {EFFECT_ENVIRONMENT_MAP, "environment map", EFFECT_ENVIRONMENT, 0,
         "a constant sky of the map's mean radiance"},
        {EFFECT_MATTE, "matte", 0, 0, "no material has a matte lobe"},
        {EFFECT_GLOSSY, "glossy", 0, 0, "no material has a rough reflection"},
        {EFFECT_MIRROR, "mirror", 0, 0, "no material has a mirror reflection"},
        {EFFECT_REFRACTION, "refraction", 0, 0, "dielectrics are black and opaque"},
        {EFFECT_ROUGH_REFRACTION, "rough refraction", EFFECT_REFRACTION, 0, "dielectrics are smooth"},
        {EFFECT_TEXTURES, "textures", 0, MAPPED, "materials keep their constants, every map is 1"},
        {EFFECT_NORMAL_MAP, "normal and bump maps", EFFECT_TEXTURES, 0, "normals as the geometry gives them"},
        {EFFECT_SMOOTH_NORMALS, "smooth normals", 0, 0, "triangles are flat"},
        {EFFECT_CUT_OUT, "cut-outs", 0, 0, "surfaces are opaque"},
        {EFFECT_FILTER, "pixel filter", 0, 0, "a box of one pixel"},
        {EFFECT_PATH_FILTER, "path filter", 0, lobe_effects(), "all paths, and no layers of paths"},
        {EFFECT_LIGHT_TREE, "light tree", 0, EFFECT_AREA_LIGHT | EFFECT_DELTA_LIGHT,
         "lights are chosen by tables, as by --light-sampler mixture"},
        {EFFECT_MOTION_BLUR, "motion blur", 0, 0, "the picture of the moment when the shutter opens"},
        {EFFECT_DEPTH_OF_FIELD, "depth of field", 0, 0, "a pinhole: all depths are sharp"},
        {EFFECT_PART_GLASS, "part glass", EFFECT_REFRACTION, EFFECT_GLOSSY | EFFECT_MIRROR,
         "materials that are partly glass are as if they were no glass"},
        {EFFECT_ATTENUATION, "attenuation", EFFECT_REFRACTION, 0, "solids absorb nothing on the way through"},
        {EFFECT_COAT, "coat", 0, 0, "no material has a clear coat"},
        {EFFECT_SHEEN, "sheen", 0, 0, "no material has a sheen"},
        {EFFECT_SPOT, "spot lights", EFFECT_DELTA_LIGHT, 0, "--spot shines all around, as --point does"},
        {EFFECT_CONDUCTOR, "conductors", 0, EFFECT_GLOSSY | EFFECT_MIRROR,
         "metals reflect by Schlick's approximation from their colour head-on"},
        {EFFECT_INTERREFLECTION, "interreflection", 0, lobe_effects(),
         "direct light only: paths of two segments"},
        {EFFECT_DISPERSION, "dispersion", EFFECT_REFRACTION, 0, "glass bends all colours alike"},
        {EFFECT_NESTED, "nested solids", EFFECT_REFRACTION, 0,
         "surfaces of solids that overlap are what they are alone"},
        {EFFECT_MAPPED_EMISSION, "mapped emission", EFFECT_AREA_LIGHT | EFFECT_TEXTURES, 0,
         "points of lamps are chosen as if their maps were even"},
        {EFFECT_INSTANCES, "instances", 0, 0, "meshes that are shared are not there"},
        {EFFECT_THIN_WALL, "thin walls", 0, 0, "thin walls of glass are black and opaque"},
        {EFFECT_ROTATION, "rotated highlights", 0, EFFECT_GLOSSY | EFFECT_ROUGH_REFRACTION | EFFECT_THIN_WALL,
         "stretched highlights lie along the texture coordinates, and no map stretches one"},
        {EFFECT_TEXTURE_FILTER, "texture filter", EFFECT_TEXTURES, 0,
         "textures are read at a point, as by --texture-filter none"},
        {EFFECT_MEASURED, "measured reflection", 0, 0, "materials with a measured BRDF are black"},
        {EFFECT_SECOND_UV, "second texture coordinates", EFFECT_TEXTURES, 0,
         "all textures of a material are read by its first set of texture coordinates"},
    };
    return table;
}

EffectMask with_implied(EffectMask effects) {
    for (EffectMask before = 0; before != effects;) {
        before = effects;
        for (const EffectSpec& effect : effect_table())
            if (effects & effect.bit)
                effects |= effect.implies;
    }
    return effects;
}

EffectMask without_effects(EffectMask effects, EffectMask taken) {
    EffectMask left = 0;
    for (const EffectSpec& effect : effect_table())
        if ((effects & effect.bit) && !(with_implied(effect.bit) & taken))
            left |= effect.bit;
    return left;
}

std::optional<EffectMask> effect_by_name(const std::string& name) {
    for (const EffectSpec& effect : effect_table())
        if (with_hyphens(name) == with_hyphens(effect.name))
            return effect.bit;
    return std::nullopt;
}

std::vector<std::string> effect_names(EffectMask effects) {
    std::vector<std::string> names;
    for (const EffectSpec& effect : effect_table())
        if (effects & effect.bit)
            names.push_back(with_hyphens(effect.name));
    return names;
}

} // namespace clrt
