// SPDX-License-Identifier: Apache-2.0
#include "effects/take_out.h"

#include "effects/effect_table.h"
#include "scene/conductors.h"
#include "scene/emission.h"
#include "scene/lobes.h"
#include "scene/sky_texels.h"
#include "scene/split_emitters.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace clrt {

namespace {

/// What materials have that are solid glass.
constexpr u32 FLAGS_OF_SOLIDS = MATERIAL_ATTENUATES | MATERIAL_DISPERSES | MATERIAL_NESTED;

void take_out_area_lights(Scene& scene) {
    scene.emitters.clear();
    scene.emitter_parts.clear();
    scene.emitter_exitance.clear();
    for (Triangle& triangle : scene.triangles)
        triangle.emitter = NO_INDEX;
}

void take_out_cones(Scene& scene) {
    for (Light& light : scene.lights)
        if (LIGHT_SHARPNESS(light) > 0)
            light.axis_x = light.axis_y = light.axis_z = light.one_minus_cos = LIGHT_SHARPNESS(light) = 0;
}

/// The mean of the map's texels over the sphere, factor included.
glm::dvec3 mean_of_map(const Environment& sky) {
    glm::dvec3 sum(0);
    double weights = 0;
    for (int y = 0; y < sky.height; ++y) {
        const double weight = std::sin(PI * (y + 0.5) / sky.height);
        for (int x = 0; x < sky.width; ++x)
            sum += weight * glm::dvec3(sky_texel(sky, x, y));
        weights += weight * sky.width;
    }
    return sky.radiance * sum / weights;
}

/// Makes the sky constant.
void set_sky(Environment& sky, const glm::dvec3& radiance) {
    sky.radiance = radiance;
    sky.texels.clear();
    sky.tiles.clear();
    sky.width = sky.height = 0;
}

void take_out_lobe(u32 lobe, Scene& scene) {
    for (Material& material : scene.materials) {
        material.lobes &= ~lobe;
        if (lobe == LOBE_GLOSSY)
            MATERIAL_EXPONENT(material) = 0;
        if (!(material.lobes & LOBE_DIELECTRIC))
            material.flags &= ~FLAGS_OF_SOLIDS;
        if (!(material.lobes & LOBES_GLASS))
            material.flags &= ~MATERIAL_PART_GLASS;
        if (!(material.lobes & LOBES_ROUGH))
            material.flags &= ~MATERIAL_TURNED;
        if (!(material.lobes & (LOBE_GLOSSY | LOBE_MIRROR)))
            material.flags &= ~MATERIAL_WHITTED_MIRROR;
    }
}

/// The glass beside other lobes goes; where all is glass nothing is partly so.
void take_out_part_glass(Scene& scene) {
    for (Material& material : scene.materials)
        if (material.flags & MATERIAL_PART_GLASS) {
            material.flags &= ~(MATERIAL_PART_GLASS | FLAGS_OF_SOLIDS);
            material.lobes &= ~LOBES_GLASS;
        }
}

void take_out_flag(u32 flag, Scene& scene) {
    for (Material& material : scene.materials)
        material.flags &= ~flag;
}

/// What is partly glass has one roughness: its other reflection is smooth then, too.
void take_out_rough_refraction(Scene& scene) {
    for (Material& material : scene.materials)
        if (material.lobes & LOBE_DIELECTRIC) {
            if (material.lobes & LOBE_GLOSSY)
                material.lobes ^= LOBE_GLOSSY | LOBE_MIRROR;
            material.flags &= ~MATERIAL_TURNED;
            material.alpha_x = material.alpha_y = 0;
            material.roughness_sqrt_x = material.roughness_sqrt_y = 0;
            material.map_roughness = NO_INDEX;
        }
}

void take_out_conductors(Scene& scene) {
    for (Material& material : scene.materials)
        if (material.fresnel == FRESNEL_CONDUCTOR) {
            const ConductorIndex index{to_dvec3(material.transmission), to_dvec3(material.specular)};
            const glm::dvec3 head_on = conductor_head_on(index);
            material.specular = {float(head_on.x), float(head_on.y), float(head_on.z), material.specular.w};
            material.transmission = {1, 1, 1, material.transmission.w};
            material.fresnel = FRESNEL_SCHLICK;
        }
}

void set_cut_out_flag(Material& material) {
    if (MATERIAL_COVERAGE(material) >= 1 && material.map_coverage == NO_INDEX)
        material.flags &= ~MATERIAL_CUT_OUT;
}

void take_out_textures(Scene& scene) {
    for (Material& material : scene.materials) {
        for (u32* map : {&material.map_matte, &material.map_specular, &material.map_emission,
                         &material.map_coverage, &material.map_roughness, &material.map_metallic})
            *map = NO_INDEX;
        set_cut_out_flag(material);
    }
    for (MaterialExtension& extension : scene.extensions)
        for (u32* map :
             {&extension.map_transmission, &extension.map_coat, &extension.map_sheen,
              &extension.map_coat_roughness, &extension.map_sheen_roughness, &extension.map_anisotropy})
            *map = NO_INDEX;
    for (Material& material : scene.materials)
        if (material.alpha_x == material.alpha_y) // maps alone stretched it
            material.flags &= ~MATERIAL_TURNED;
    for (size_t i = 0; i < scene.emitted.size(); ++i)
        scene.emitted[i] = constant_emission(scene.materials[i]);
    unite_emitters(scene);
}

void take_out_normal_maps(Scene& scene) {
    for (Material& material : scene.materials) {
        material.map_normal = material.map_bump = NO_INDEX;
        material.bump_scale = 0;
    }
}

void take_out_cut_outs(Scene& scene) {
    for (Material& material : scene.materials) {
        MATERIAL_COVERAGE(material) = 1;
        material.map_coverage = NO_INDEX;
        set_cut_out_flag(material);
    }
}

/// The front stays where vn put it: a triangle wound the other way is turned round.
void take_out_smooth_normals(Scene& scene) {
    for (Triangle& t : scene.triangles) {
        if (t.n0 == NO_INDEX)
            continue;
        const glm::dvec3 p0 = to_dvec3(scene.positions[t.v0]), p1 = to_dvec3(scene.positions[t.v1]),
                         p2 = to_dvec3(scene.positions[t.v2]);
        const glm::dvec3 sum =
            to_dvec3(scene.normals[t.n0]) + to_dvec3(scene.normals[t.n1]) + to_dvec3(scene.normals[t.n2]);
        if (glm::dot(sum, glm::cross(p1 - p0, p2 - p0)) < 0) {
            std::swap(t.v1, t.v2);
            std::swap(t.t1, t.t2);
        }
        t.n0 = t.n1 = t.n2 = NO_INDEX;
    }
}

void take_out_second_uvs(Scene& scene) {
    scene.second_uvs.clear();
    for (Texture& texture : scene.textures)
        texture.channel &= ~TEXTURE_SECOND_UV;
}

void take_out_motion(Scene& scene) {
    scene.camera.end.reset();
    scene.position_moves.clear();
    scene.normal_moves.clear();
}

/// Without instances nobody asks for the prototypes' triangles, which lie behind all others.
void take_out_instances(Scene& scene) {
    scene.triangles.resize(own_triangle_count(scene.triangles, scene.prototypes));
    scene.prototypes.clear();
    scene.instances.clear();
}

void take_out_lights(EffectMask effects, Scene& scene) {
    if (effects & EFFECT_AREA_LIGHT)
        take_out_area_lights(scene);
    if (effects & EFFECT_DELTA_LIGHT)
        scene.lights.clear();
    if (effects & EFFECT_SPOT)
        take_out_cones(scene);
    if (effects & EFFECT_ENVIRONMENT) {
        set_sky(scene.environment, glm::dvec3(0));
        if (scene.background)
            scene.background = glm::dvec3(0);
    }
    if ((effects & EFFECT_ENVIRONMENT_MAP) && !scene.environment.texels.empty())
        set_sky(scene.environment, mean_of_map(scene.environment));
}

void take_out_lobes(EffectMask effects, Scene& scene) {
    for (const LobeSpec& lobe : LOBE_SPECS)
        if (effects & lobe.effect)
            take_out_lobe(lobe.bit, scene);
    if (effects & EFFECT_CONDUCTOR)
        take_out_conductors(scene);
    if (effects & EFFECT_ROUGH_REFRACTION)
        take_out_rough_refraction(scene);
    if (effects & EFFECT_PART_GLASS)
        take_out_part_glass(scene);
    if (effects & EFFECT_ATTENUATION)
        take_out_flag(MATERIAL_ATTENUATES, scene);
    if (effects & EFFECT_DISPERSION)
        take_out_flag(MATERIAL_DISPERSES, scene);
    if (effects & EFFECT_NESTED)
        take_out_flag(MATERIAL_NESTED, scene);
    if (effects & EFFECT_ROTATION)
        take_out_flag(MATERIAL_TURNED, scene);
}

} // namespace

void take_out_effects(EffectMask effects, Scene& scene, Options& options) {
    effects = EVERY_EFFECT & ~without_effects(EVERY_EFFECT, effects);
    take_out_lights(effects, scene);
    take_out_lobes(effects, scene);
    if (effects & EFFECT_TEXTURES)
        take_out_textures(scene);
    if (effects & EFFECT_SECOND_UV)
        take_out_second_uvs(scene);
    if (effects & EFFECT_MAPPED_EMISSION)
        unite_emitters(scene);
    if (effects & EFFECT_NORMAL_MAP)
        take_out_normal_maps(scene);
    if (effects & EFFECT_SMOOTH_NORMALS)
        take_out_smooth_normals(scene);
    if (effects & EFFECT_CUT_OUT)
        take_out_cut_outs(scene);
    if (effects & EFFECT_FILTER) {
        options.film.filter = Filter::BOX;
        options.film.filter_radius.reset();
    }
    if (effects & EFFECT_PATH_FILTER) {
        options.transport.paths.clear();
        options.output.path_layers.clear();
    }
    if ((effects & EFFECT_LIGHT_TREE) && options.sampling.light_sampler == LightSampler::TREE)
        options.sampling.light_sampler = LightSampler::MIXTURE;
    if (effects & EFFECT_TEXTURE_FILTER)
        options.scene.texture_filter = TextureFilter::NONE;
    if (effects & EFFECT_INSTANCES)
        take_out_instances(scene);
    if (effects & EFFECT_MOTION_BLUR)
        take_out_motion(scene);
    if (effects & EFFECT_DEPTH_OF_FIELD)
        scene.camera.aperture = 0;
    if (effects & EFFECT_INTERREFLECTION)
        options.transport.max_depth = std::min(effective_max_depth(options.transport), 2);
}

bool turns_triangles(EffectMask effects) {
    return (effects & EFFECT_SMOOTH_NORMALS) != 0; // take_out_smooth_normals
}

} // namespace clrt
