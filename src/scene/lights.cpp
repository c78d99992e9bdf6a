// SPDX-License-Identifier: Apache-2.0
#include "scene/lights.h"

#include "colour.h"
#include "error.h"
#include "scene/alias_table.h"
#include "scene/emission.h"
#include "scene/emitter_parts.h"
#include "scene/normalise.h"
#include "scene/vectors.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace clrt {
namespace {

void check_colour(const glm::dvec3& colour, const char* option, const char* what) {
    if (!is_finite(colour) || colour.x < 0 || colour.y < 0 || colour.z < 0)
        throw UsageError(fmt::format("{}: expected {} of finite numbers not below 0, found {},{},{}", option,
                                     what, colour.x, colour.y, colour.z));
}

/// A falloff over less than this share of 1 - cos(outer angle) is an edge: it is narrower than the angles
/// that directions in floats tell apart, and 1 / width stays finite.
constexpr double SHARPEST_FALLOFF = 0x1p-20;

double one_minus_cos(double degrees) {
    const double half_sine = std::sin(0.5 * degrees * PI / 180); // without the cancellation of 1 - cos
    return 2 * half_sine * half_sine;
}

void set_cone(const SpotCone& cone, const char* source, Light& light) {
    const double length = glm::length(cone.direction);
    if (!std::isfinite(length) || length <= 0)
        throw UsageError(fmt::format("{}: expected a direction that is not 0, found {},{},{}", source,
                                     cone.direction.x, cone.direction.y, cone.direction.z));
    if (!(cone.inner_degrees >= 0 && cone.inner_degrees <= cone.outer_degrees && cone.outer_degrees <= 180))
        throw UsageError(fmt::format("{}: expected an outer angle from 0 to 180 degrees and an inner one "
                                     "from 0 to it, found {},{}",
                                     source, cone.outer_degrees, cone.inner_degrees));
    const glm::dvec3 axis = cone.direction / length;
    light.axis_x = float(axis.x);
    light.axis_y = float(axis.y);
    light.axis_z = float(axis.z);
    const double outer = one_minus_cos(cone.outer_degrees);
    light.one_minus_cos = float(outer);
    if (light.one_minus_cos >= std::numeric_limits<float>::min())
        LIGHT_SHARPNESS(light) =
            float(1 / std::max(outer - one_minus_cos(cone.inner_degrees), SHARPEST_FALLOFF * outer));
    else
        light.emission = {0, 0, 0, 0}; // nothing is left of the cone
}

/// Radiant intensity scales with the square of lengths: radiance on the surfaces stays what it was.
Light point_light(const PointOptions& option, const Normalisation& frame) {
    check_colour(option.intensity, option.source, "an intensity");
    if (!is_finite(option.position))
        throw UsageError(fmt::format("{}: expected a position of finite numbers, found {},{},{}",
                                     option.source, option.position.x, option.position.y, option.position.z));
    Light light{};
    light.kind = LIGHT_POINT;
    light.vector = to_vec4(to_normalised(frame, option.position));
    light.emission = to_vec4(option.intensity * frame.scale * frame.scale);
    if (option.cone)
        set_cone(*option.cone, option.source, light);
    return light;
}

/// The share of a point light's power that meets the scene: all of it from within the bounding sphere, else
/// its solid angle over 4 pi. It makes a far light's power what a sun of its irradiance has.
double share_that_meets_scene(const glm::dvec3& position, double radius) {
    const double distance = glm::length(position);
    if (distance < radius)
        return 1;
    const double sine = radius / distance;
    return sine * sine / (2 * (1 + std::sqrt(1 - sine * sine))); // (1 - cos) / 2 without cancellation
}

/// A disc of angular radius r and radiance L gives, at normal incidence, the irradiance L pi sin^2 r.
Light sun_light(const SunOptions& option) {
    check_colour(option.irradiance, option.source, "an irradiance");
    const double length = glm::length(option.towards);
    if (!std::isfinite(length) || length <= 0)
        throw UsageError(fmt::format("{}: expected a direction that is not 0, found {},{},{}", option.source,
                                     option.towards.x, option.towards.y, option.towards.z));
    if (!(option.diameter_degrees >= 0 && option.diameter_degrees < 180))
        throw UsageError(fmt::format("{}: expected an angular diameter from 0 to below 180 degrees, found {}",
                                     option.source, option.diameter_degrees));
    Light light{};
    light.kind = LIGHT_SUN;
    light.vector = to_vec4(option.towards / length);
    light.emission = to_vec4(option.irradiance);
    const double r = 0.5 * option.diameter_degrees * PI / 180;
    if (r >= SMALLEST_SUN_RADIUS) {
        const double half_sine = std::sin(0.5 * r);
        light.one_minus_cos = float(2 * half_sine * half_sine); // without the cancellation of 1 - cos r
        light.emission = to_vec4(option.irradiance / (PI * std::sin(r) * std::sin(r)));
    }
    return light;
}

} // namespace

double triangle_area(const vec4& a, const vec4& b, const vec4& c) {
    const glm::dvec3 origin(a.x, a.y, a.z);
    const glm::dvec3 normal =
        glm::cross(glm::dvec3(b.x, b.y, b.z) - origin, glm::dvec3(c.x, c.y, c.z) - origin);
    const double area = 0.5 * glm::length(normal);
    return std::isfinite(area) ? area : 0;
}

void tabulate(const std::vector<double>& weights, const std::vector<double>& areas,
              std::vector<Emitter>& emitters) {
    const AliasTable table = build_alias_table(weights);
    for (size_t i = 0; i < emitters.size(); ++i) {
        emitters[i].alias = table.entries[i].alias;
        emitters[i].threshold = table.entries[i].threshold;
        emitters[i].pdf_a = float(table.probability[i] / areas[i]);
    }
}

void tabulate(const std::vector<double>& weights, std::vector<Light>& lights) {
    const AliasTable table = build_alias_table(weights);
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].probability = float(table.probability[i]);
        lights[i].alias = table.entries[i].alias;
        lights[i].threshold = table.entries[i].threshold;
    }
}

Emitters build_emitters(const std::vector<vec4>& positions, std::vector<Triangle>& triangles,
                        const std::vector<double>& exitance) {
    Emitters result;
    std::vector<double> powers, areas;
    for (size_t i = 0; i < triangles.size(); ++i) {
        Triangle& triangle = triangles[i];
        triangle.emitter = NO_INDEX;
        if (!(exitance[triangle.material] > 0))
            continue;
        const double area =
            triangle_area(positions[triangle.v0], positions[triangle.v1], positions[triangle.v2]);
        if (area < SMALLEST_EMITTER_AREA)
            continue;
        triangle.emitter = u32(result.emitters.size());
        result.emitters.push_back({u32(i), 0, 0, 0});
        areas.push_back(area);
        powers.push_back(PI * area * exitance[triangle.material]);
        result.power += powers.back();
    }
    tabulate(powers, areas, result.emitters);
    return result;
}

double emitter_power(const Scene& scene, u32 emitter) {
    const u32 material = scene.triangles[scene.emitters[emitter].triangle].material;
    return PI * emitter_area(scene, emitter) *
           (scene.emitter_exitance.empty()
                ? emitted_luminance(scene.materials[material], scene.emitted[material])
                : scene.emitter_exitance[emitter]);
}

double emitters_power(const Scene& scene) {
    double power = 0;
    for (u32 i = 0; i < scene.emitters.size(); ++i)
        power += emitter_power(scene, i);
    return power;
}

double sun_irradiance(const Light& sun) {
    const double disc = sun.one_minus_cos; // pi sin^2 r = pi (1 - cos r) (1 + cos r)
    return luminance(to_dvec3(sun.emission)) * (disc > 0 ? PI * disc * (2 - disc) : 1);
}

double lit_solid_angle(const Light& light) {
    const double sharpness = LIGHT_SHARPNESS(light);
    if (!(sharpness > 0))
        return 4 * PI;
    // 1 up to the inner angle, then the square of a share that falls evenly over 1 - cos: a third of it.
    return 2 * PI * std::max(double(light.one_minus_cos) - 2 / (3 * sharpness), 0.0);
}

double light_power(const Light& light, double radius) {
    if (light.kind == LIGHT_SUN)
        return sun_irradiance(light) * PI * radius * radius;
    const double seen = share_that_meets_scene(to_dvec3(light.vector), radius) * 4 * PI;
    return std::min(seen, lit_solid_angle(light)) * luminance(to_dvec3(light.emission));
}

Lights build_lights(const LightOptions& options, const Normalisation& frame, double radius,
                    NoticeList& notices) {
    Lights result;
    std::vector<double> powers;
    const auto add = [&](const Light& light, const char* source) {
        const double power = light_power(light, radius);
        if (power > 0) {
            result.lights.push_back(light);
            result.sources.emplace_back(source);
            powers.push_back(power);
            result.power += power;
        } else {
            notices.add(fmt::format("{}: a light without power is left out", source));
        }
    };
    for (const PointOptions& option : options.points)
        add(point_light(option, frame), option.source);
    for (const SunOptions& option : options.suns)
        add(sun_light(option), option.source);
    tabulate(powers, result.lights);
    return result;
}

std::vector<SourceCount> count_lights(const Scene& scene, u32 kind) {
    std::vector<SourceCount> counts;
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        if (scene.lights[i].kind != kind)
            continue;
        const std::string source = i < scene.light_sources.size() ? scene.light_sources[i]
                                   : kind == LIGHT_SUN            ? SunOptions{}.source
                                                                  : PointOptions{}.source;
        if (counts.empty() || counts.back().source != source)
            counts.push_back({source, 0});
        ++counts.back().count;
    }
    return counts;
}

} // namespace clrt
