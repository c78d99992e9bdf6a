// SPDX-License-Identifier: Apache-2.0
#include "scene/brightness.h"

#include "colour.h"
#include "kernels/shared/path_types.h"
#include "scene/placed_box.h"
#include "scene/sky_texels.h"
#include "scene/texture_levels.h"
#include "scene/vectors.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace clrt {

namespace {

double largest_of(const vec4& v) {
    return std::max({double(v.x), double(v.y), double(v.z)});
}

/// Smallest and largest r, g or b of a texture's image, linear, without base and gain.
std::pair<double, double> texel_range(const Scene& scene, const Texture& texture) {
    if (texture.format == TEXEL_VERTEX)
        return {0, 1}; // the range of vertex colours
    const u32* words = &scene.texel_words[texture.first_word];
    const size_t texels = size_t(texture.width) * texture.height;
    double low = std::numeric_limits<double>::max(), high = 0;
    for (size_t i = 0; i < texels; ++i) {
        const vec4 t = decode_texel(texture.format, words, i, scene.texel_words.data());
        low = std::min({low, double(t.x), double(t.y), double(t.z)});
        high = std::max({high, double(t.x), double(t.y), double(t.z)});
    }
    return {low, high};
}

/// The largest value of a map that multiplies a reflectance, at most 1 as in kernels/scattering/material.h; 1
/// without a map.
double largest_factor(const Scene& scene, u32 map) {
    if (map == NO_INDEX)
        return 1;
    const Texture& texture = scene.textures[map];
    const auto [low, high] = texel_range(scene, texture);
    return std::clamp(texture.base + std::max(texture.gain * low, texture.gain * high), 0.0, 1.0);
}

double albedo(const Scene& scene, const Material& m) {
    const bool reflects = (m.lobes & (LOBE_GLOSSY | LOBE_MIRROR)) != 0;
    if ((m.lobes & (LOBES_GLASS | LOBE_COAT | LOBE_SHEEN | LOBE_MEASURED)) ||
        (reflects && m.fresnel != FRESNEL_NONE))
        return 1;
    glm::dvec3 sum(0);
    if (m.lobes & LOBE_MATTE)
        sum += to_dvec3(m.matte) * largest_factor(scene, m.map_matte);
    if (reflects)
        sum += to_dvec3(m.specular) * largest_factor(scene, m.map_specular);
    return std::max({sum.x, sum.y, sum.z});
}

double largest_emission(const Scene& scene) {
    double largest = 0;
    for (const Emitter& emitter : scene.emitters) {
        const glm::dvec3& e = scene.emitted[scene.triangles[emitter.triangle].material].largest;
        largest = std::max(largest, largest_component(e));
    }
    return largest;
}

double largest_sky(const Environment& sky) {
    const double texel = sky.texels.empty() ? 1 : largest_sky_texel(sky);
    return texel * std::max({sky.radiance.x, sky.radiance.y, sky.radiance.z});
}

/// Squared distance of a point to a triangle (Ericson 2004, Real-Time Collision Detection, section 5.1.5).
double squared_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double squared = glm::dot(normal, normal);
    const auto outside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::dot(glm::cross(to - from, p - from), normal) < 0;
    };
    if (squared > 0 && !outside(a, b) && !outside(b, c) && !outside(c, a)) {
        const double height = glm::dot(p - a, normal);
        return height * height / squared;
    }
    const auto to_edge = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const glm::dvec3 way = to - from;
        const double length = glm::dot(way, way);
        const double along = length > 0 ? glm::clamp(glm::dot(p - from, way) / length, 0.0, 1.0) : 0;
        const glm::dvec3 apart = p - (from + along * way);
        return glm::dot(apart, apart);
    };
    return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// That of the nearest triangle of an instance, if it is less than `nearest`. Only instances are looked into
/// whose boxes are nearer.
double squared_distance_to_instances(const Scene& scene, const glm::dvec3& p, double nearest) {
    std::vector<PlacedBox> boxes;
    for (const Prototype& prototype : scene.prototypes)
        boxes.push_back(box_of_prototype(scene, prototype, [](const Triangle&) { return true; }));
    for (size_t i = 1; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (boxes[instance.prototype].squared_distance_in(instance, p) >= nearest)
            continue;
        const Prototype& prototype = scene.prototypes[instance.prototype];
        const auto place = [&](u32 v) { return placed(instance, to_dvec3(scene.positions[v])); };
        for (u32 k = 0; k < prototype.triangle_count; ++k) {
            const Triangle& t = scene.triangles[prototype.first_triangle + k];
            nearest = std::min(nearest, squared_distance(p, place(t.v0), place(t.v1), place(t.v2)));
        }
    }
    return nearest;
}

double squared_distance_to_scene(const Scene& scene, const glm::dvec3& p) {
    double nearest = std::numeric_limits<double>::max();
    const size_t own = own_triangle_count(scene.triangles, scene.prototypes);
    for (size_t i = 0; i < own; ++i) {
        const Triangle& t = scene.triangles[i];
        nearest = std::min(nearest, squared_distance(p, to_dvec3(scene.positions[t.v0]),
                                                     to_dvec3(scene.positions[t.v1]),
                                                     to_dvec3(scene.positions[t.v2])));
    }
    return std::min(nearest, squared_distance_to_instances(scene, p, nearest));
}

} // namespace

double largest_albedo(const Scene& scene) {
    std::vector<bool> seen(scene.materials.size(), false);
    double largest = 0;
    for (const Triangle& triangle : scene.triangles)
        if (!seen[triangle.material]) {
            seen[triangle.material] = true;
            largest = std::max(largest, albedo(scene, scene.materials[triangle.material]));
        }
    return largest;
}

double largest_radiance(const Scene& scene, unsigned kinds) {
    double outside = kinds & KIND_SKY ? largest_sky(scene.environment) : 0;
    for (const Light& light : scene.lights)
        if (light.kind == LIGHT_SUN && light.one_minus_cos > 0 && (kinds & KIND_SUN))
            outside += largest_of(light.emission);
    return std::max(outside, kinds & KIND_AREA ? largest_emission(scene) : 0.0);
}

std::optional<double> largest_delta_irradiance(const Scene& scene, unsigned kinds) {
    double sum = 0;
    for (const Light& light : scene.lights) {
        if (light.kind == LIGHT_SUN && light.one_minus_cos == 0 && (kinds & KIND_SUN))
            sum += largest_of(light.emission);
        if (light.kind != LIGHT_POINT || !(kinds & KIND_POINT))
            continue;
        const double squared = squared_distance_to_scene(scene, to_dvec3(light.vector));
        if (!(squared > 0))
            return std::nullopt;
        sum += largest_of(light.emission) / squared;
    }
    return sum;
}

} // namespace clrt
