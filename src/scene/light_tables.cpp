// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tables.h"

#include "colour.h"
#include "scene/casters.h"
#include "scene/emitter_parts.h"
#include "scene/lights.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <utility>

namespace clrt {
namespace {

/// Positions are rounded to floats, and so are rays that start on the sphere.
constexpr double EMISSION_MARGIN = 1 + 1e-5;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Numbers of the objects that emit, apart by material, in the order of their first triangles.
std::vector<u32> shining_objects(const Scene& scene, u32& count) {
    std::map<std::pair<u32, u32>, u32> numbers;
    std::vector<u32> groups;
    for (const Emitter& emitter : scene.emitters) {
        const Triangle& t = scene.triangles[emitter.triangle];
        groups.push_back(numbers.try_emplace({t.object, t.material}, u32(numbers.size())).first->second);
    }
    count = u32(numbers.size());
    return groups;
}

void mix_emitters(Scene& scene) {
    u32 objects = 0;
    const std::vector<u32> groups = shining_objects(scene, objects);
    if (objects < 2) // by power, as they are
        return;
    std::vector<double> powers, areas;
    for (u32 i = 0; i < scene.emitters.size(); ++i) {
        powers.push_back(emitter_power(scene, i));
        areas.push_back(emitter_area(scene, i));
    }
    tabulate(mixed_weights(powers, groups, objects), areas, scene.emitters);
}

void mix_lights(Scene& scene) {
    if (scene.lights.size() < 2)
        return;
    std::vector<double> powers;
    for (const Light& light : scene.lights)
        powers.push_back(light_power(light, scene.radius));
    std::vector<u32> groups(powers.size());
    std::iota(groups.begin(), groups.end(), 0u);
    tabulate(mixed_weights(powers, groups, u32(groups.size())), scene.lights);
}

/// The part of an emissive triangle's light that leaves towards the casters, about: of all of them, whichever
/// side they are on, as if they were above it.
double share_of_casters(const Scene& scene, u32 emitter) {
    const auto corners = emitter_corners(scene, emitter);
    const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    return caster_solid_angle(scene.casters, middle, PI) / PI;
}

double sum_of(const KindShares& powers) {
    return powers.emitters + powers.environment + powers.lights;
}

/// Luminance that lights, and a sky of this mean radiance, send into a sphere about the origin.
KindShares power_into(const Scene& scene, double sky, double radius) {
    KindShares powers;
    powers.emitters = emitters_power(scene);
    powers.environment = sky * 4 * PI * PI * radius * radius;
    for (const Light& light : scene.lights)
        powers.lights += light_power(light, radius);
    return powers;
}

/// The same into the spheres of the casters.
KindShares power_to_casters(const Scene& scene, double sky) {
    const double square = caster_squares(scene.casters);
    KindShares powers;
    for (u32 i = 0; i < scene.emitters.size(); ++i)
        powers.emitters += emitter_power(scene, i) * share_of_casters(scene, i);
    powers.environment = sky * 4 * PI * PI * square;
    for (const Light& light : scene.lights)
        powers.lights += light.kind == LIGHT_SUN
                             ? sun_irradiance(light) * PI * square
                             : luminance(to_dvec3(light.emission)) *
                                   std::min(caster_solid_angle(scene.casters, to_dvec3(light.vector), 4 * PI),
                                            lit_solid_angle(light));
    return powers;
}

} // namespace

double environment_power(const Scene& scene) {
    const Environment& sky = scene.environment;
    if (!(largest_component(sky.radiance) > 0))
        return 0;
    if (!sky.portals.empty())
        return sky.let_in.flux;
    // A direction's radiance meets the sphere over a disc of its radius.
    const double disc = PI * scene.radius * scene.radius;
    if (!sky.texels.empty())
        return sky.mean_radiance * sky.tabulated_share * 4 * PI * disc;
    return 0; // the BSDF's samples find a constant sky without noise
}

std::vector<double> mixed_weights(const std::vector<double>& powers, const std::vector<u32>& groups,
                                  u32 group_count, double even) {
    if (group_count < 2)
        return powers;
    std::vector<double> of_group(group_count);
    for (size_t i = 0; i < powers.size(); ++i)
        of_group[groups[i]] += powers[i];
    const double all = sum_of(powers);
    std::vector<double> weights(powers.size());
    for (size_t i = 0; i < powers.size(); ++i)
        weights[i] = (1 - even) * powers[i] / all + even * (powers[i] / of_group[groups[i]]) / group_count;
    return weights;
}

void tabulate_lights(LightSampler sampler, Scene& scene) {
    if (sampler == LightSampler::POWER)
        return; // as they were built
    mix_emitters(scene);
    mix_lights(scene);
}

KindShares kind_shares(LightSampler sampler, const Scene& scene) {
    double lights = 0;
    for (const Light& light : scene.lights)
        lights += light_power(light, scene.radius);
    const double powers[3] = {emitters_power(scene), environment_power(scene), lights};
    const auto kinds = std::count_if(powers, powers + 3, [](double power) { return power > 0; });
    const double all = powers[0] + powers[1] + powers[2];
    const auto share = [&](double power) {
        if (!(power > 0))
            return 0.0;
        return sampler == LightSampler::POWER ? power / all : 0.5 * power / all + 0.5 / double(kinds);
    };
    return {share(powers[0]), share(powers[1]), share(powers[2])};
}

double emission_radius(const Scene& scene) {
    double square = 0; // the radius covers instances
    const size_t own = own_triangle_count(scene.triangles, scene.prototypes);
    for (size_t i = 0; i < own; ++i)
        for (const u32 corner : {scene.triangles[i].v0, scene.triangles[i].v1, scene.triangles[i].v2}) {
            const glm::dvec3 p = to_dvec3(scene.positions[corner]);
            square = std::max(square, glm::dot(p, p));
        }
    return std::max(std::sqrt(square), scene.radius) * EMISSION_MARGIN;
}

EmissionPlan plan_emission(const Scene& scene, bool must_find_all) {
    const double even = must_find_all ? luminance(scene.environment.radiance) : 0;
    const double sky = scene.environment.texels.empty() ? even : scene.environment.mean_radiance;
    const KindShares sent = power_into(scene, sky, emission_radius(scene));
    const KindShares aimed = scene.casters.empty() ? sent : power_to_casters(scene, sky);
    EmissionPlan plan;
    if (!(sum_of(aimed) > 0))
        return plan;
    const double all = sum_of(aimed);
    plan.kinds = {aimed.emitters / all, aimed.environment / all, aimed.lights / all};
    plan.aimed = std::min(all / sum_of(sent), 1.0);
    return plan;
}

} // namespace clrt
