// SPDX-License-Identifier: Apache-2.0
#include "scene/light_leaves.h"

#include "colour.h"
#include "kernels/shared/path_types.h"
#include "scene/emitter_parts.h"
#include "scene/light_tables.h"
#include "scene/lights.h"
#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <tbb/parallel_for.h>
#include <utility>

namespace clrt {
namespace {

/// Distance of suns in the normalised frame. Spheres around them hold the whole scene, so no vertex takes one
/// for behind its horizon that is not.
constexpr double FAR_AWAY = 1048576;

/// The part of the choice that is even over objects, whatever their power: what is strong and near may yet be
/// hidden, and no bound knows that.
constexpr double EVEN_SHARE = 0.25;

/// cos of the largest angle between normals of one plane.
constexpr double SAME_PLANE_COS = 0.9999;

/// Length of the mean normal of the most open dome: somewhat more than half a sphere's.
constexpr double MOST_OPEN_DOME = 0.55;

/// Determinant of the mean of a dome's n n^T, n its normals, at least; a sphere's and a cube's is 1/27. Lamps
/// that face each other have 0.
constexpr double LEAST_DOME_DETERMINANT = 0.02;

/// Distance of a dome's planes from its middle, at least; over the radius of the scene. Something smaller
/// shines on what lies outside of it too.
constexpr double LEAST_DOME_RADIUS = 0.2;

const Triangle& triangle_of(const Scene& scene, u32 emitter) {
    return scene.triangles[scene.emitters[emitter].triangle];
}

std::array<glm::dvec3, 3> corners_of(const Scene& scene, const Triangle& t) {
    return {to_dvec3(scene.positions[t.v0]), to_dvec3(scene.positions[t.v1]),
            to_dvec3(scene.positions[t.v2])};
}

/// Unit normal of the side that shines where one does: the winding's, or the other where vn say so.
glm::dvec3 shining_normal(const Scene& scene, const Triangle& t) {
    const auto p = corners_of(scene, t);
    glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    if (t.n0 == NO_INDEX)
        return normal;
    const glm::dvec3 given =
        to_dvec3(scene.normals[t.n0]) + to_dvec3(scene.normals[t.n1]) + to_dvec3(scene.normals[t.n2]);
    return glm::dot(given, normal) < 0 ? -normal : normal;
}

/// The vertices of a set that a triangle has too; NO_INDEX in place of the others.
std::array<u32, 3> shared_vertices(std::array<u32, 3> vertices, const Triangle& t) {
    for (u32& v : vertices)
        if (v != t.v0 && v != t.v1 && v != t.v2)
            v = NO_INDEX;
    return vertices;
}

bool is_none(const std::array<u32, 3>& vertices) {
    return std::all_of(vertices.begin(), vertices.end(), [](u32 v) { return v == NO_INDEX; });
}

/// Of emitters of one material: whether its map makes no difference between them.
bool shine_alike(const Scene& scene, u32 a, u32 b) {
    return emitter_place(scene, a).step == 1 && emitter_place(scene, b).step == 1 &&
           (scene.emitter_exitance.empty() || scene.emitter_exitance[a] == scene.emitter_exitance[b]);
}

LightLeaf fan_leaf(const Scene& scene, u32 first, u32 end) {
    const Triangle& t = triangle_of(scene, first);
    LightLeaf leaf;
    leaf.first = first;
    leaf.count = end - first;
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    double power = 0, cos_spread = 1;
    const glm::dvec3 axis = shining_normal(scene, t);
    for (u32 i = first; i < end; ++i) {
        for (const glm::dvec3& p : emitter_corners(scene, i)) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        power += emitter_power(scene, i);
        cos_spread = std::min(cos_spread, glm::dot(axis, shining_normal(scene, triangle_of(scene, i))));
    }
    LightBounds& bounds = leaf.bounds;
    bounds.low = glm::vec3(low);
    bounds.high = glm::vec3(high);
    bounds.axis = glm::vec3(axis);
    bounds.cos_spread = float(cos_spread);
    bounds.both_sides = (scene.materials[t.material].flags & MATERIAL_EMITS_BOTH_SIDES) != 0;
    bounds.power = float(power / (bounds.both_sides ? 2 * PI : PI));
    return leaf;
}

LightLeaf far_leaf(u32 number, LightRange range, const glm::dvec3& centre, double radius, double irradiance) {
    LightLeaf leaf;
    leaf.first = number;
    leaf.range = range;
    const glm::dvec3 half(radius / std::sqrt(3.0));
    leaf.bounds.low = glm::vec3(centre - half);
    leaf.bounds.high = glm::vec3(centre + half);
    leaf.bounds.power = float(irradiance * FAR_AWAY * FAR_AWAY);
    return leaf;
}

LightLeaf light_leaf(const Scene& scene, u32 index, u32 number) {
    const Light& light = scene.lights[index];
    if (light.kind == LIGHT_SUN) {
        const double reach = 2 * std::sqrt(3.0) * double(std::max(scene.extent, scene.ground_extent));
        const double disc = FAR_AWAY * std::sqrt(2.0 * double(light.one_minus_cos)); // at least its sine
        return far_leaf(number, LightRange::SUN, FAR_AWAY * to_dvec3(light.vector), std::max(reach, disc),
                        sun_irradiance(light));
    }
    LightLeaf leaf;
    leaf.first = number;
    leaf.bounds.low = leaf.bounds.high = glm::vec3(to_dvec3(light.vector));
    leaf.bounds.power = float(luminance(to_dvec3(light.emission)));
    if (LIGHT_SHARPNESS(light) > 0) { // as a surface would whose normals are the directions of the cone
        leaf.bounds.axis = glm::vec3(light.axis_x, light.axis_y, light.axis_z);
        leaf.bounds.cos_spread = 1 - light.one_minus_cos;
    }
    return leaf;
}

bool is_chosen(const Environment& sky, unsigned kinds) {
    const bool is_sampled = !sky.texels.empty() || !sky.portals.empty();
    return (kinds & KIND_SKY) && is_sampled && largest_component(sky.radiance) > 0;
}

bool is_chosen(const Light& light, unsigned kinds) {
    return (kinds & (light.kind == LIGHT_SUN ? KIND_SUN : KIND_POINT)) != 0;
}

/// What a surface gets whose normal points to the middle of a map's light, on average, or through portals.
double sky_irradiance(const Environment& sky) {
    return sky.portals.empty() ? 0.5 * sky.mean_radiance * sky.tabulated_share * 4 * PI
                               : sky.let_in.irradiance;
}

void add_fans(const Scene& scene, std::vector<LightLeaf>& leaves) {
    std::vector<u32> ends;
    for (u32 first = 0; first < scene.emitters.size(); first = ends.back())
        ends.push_back(fan_end(scene, first));
    leaves.resize(ends.size());
    tbb::parallel_for(size_t(0), ends.size(),
                      [&](size_t i) { leaves[i] = fan_leaf(scene, i == 0 ? 0 : ends[i - 1], ends[i]); });
}

/// What a leaf's lights send into the bounding sphere.
double flux_of(const Scene& scene, const LightLeaf& leaf) {
    const u32 emitters = u32(scene.emitters.size());
    if (leaf.range == LightRange::SKY)
        return environment_power(scene);
    if (leaf.first >= emitters)
        return light_power(scene.lights[leaf.first - emitters], scene.radius);
    double flux = 0;
    for (u32 i = leaf.first; i < leaf.first + leaf.count; ++i)
        flux += emitter_power(scene, i);
    return flux;
}

/// Numbers of the leaves' objects: those of the file apart by material, and each other light.
std::vector<u32> objects_of(const Scene& scene, const std::vector<LightLeaf>& leaves, u32& count) {
    std::map<std::pair<u32, u32>, u32> numbers;
    std::vector<u32> objects;
    for (const LightLeaf& leaf : leaves) {
        std::pair<u32, u32> key = {leaf.first, NO_INDEX};
        if (leaf.first < scene.emitters.size()) {
            const Triangle& t = triangle_of(scene, leaf.first);
            key = {t.object, t.material};
        }
        objects.push_back(numbers.try_emplace(key, u32(numbers.size())).first->second);
    }
    count = u32(numbers.size());
    return objects;
}

/// Raises the power of what is weak (mixed_weights).
void mix_powers(const Scene& scene, std::vector<LightLeaf>& leaves) {
    std::vector<double> fluxes;
    for (const LightLeaf& leaf : leaves)
        fluxes.push_back(flux_of(scene, leaf));
    u32 objects = 0;
    const std::vector<u32> numbers = objects_of(scene, leaves, objects);
    const std::vector<double> weights = mixed_weights(fluxes, numbers, objects, EVEN_SHARE);
    for (size_t i = 0; i < leaves.size(); ++i)
        if (fluxes[i] > 0)
            leaves[i].bounds.power *= float(weights[i] / fluxes[i]);
}

/// Powers as shares of the largest, so that no unit brings them near the ends of the floats.
void scale_powers(std::vector<LightLeaf>& leaves) {
    constexpr float SMALLEST = 1e-30f;
    float largest = 0;
    for (const LightLeaf& leaf : leaves)
        largest = std::max(largest, leaf.bounds.power);
    for (LightLeaf& leaf : leaves)
        leaf.bounds.power = std::max(leaf.bounds.power / largest, SMALLEST);
}

bool emitters_are_one_object(const Scene& scene) {
    const Triangle& first = triangle_of(scene, 0);
    return std::all_of(scene.emitters.begin(), scene.emitters.end(), [&](const Emitter& emitter) {
        const Triangle& t = scene.triangles[emitter.triangle];
        return t.object == first.object && t.material == first.material;
    });
}

/// Of the emissive triangles, by area: centres, normals n, and n n^T.
struct NormalSums {
    double area = 0;
    glm::dvec3 points{0}, normals{0};
    glm::dmat3 squares{0};
};

NormalSums sum_normals(const Scene& scene) {
    NormalSums sums;
    for (u32 i = 0; i < scene.emitters.size(); ++i) {
        const Triangle& t = triangle_of(scene, i);
        const auto p = emitter_corners(scene, i);
        const double area = 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        const glm::dvec3 normal = shining_normal(scene, t);
        sums.area += area;
        sums.points += area / 3 * (p[0] + p[1] + p[2]);
        sums.normals += area * normal;
        sums.squares += glm::outerProduct(area * normal, normal);
    }
    return sums;
}

} // namespace

u32 fan_end(const Scene& scene, u32 first) {
    const Triangle& t = triangle_of(scene, first);
    const glm::dvec3 normal = shining_normal(scene, t);
    std::array<u32, 3> shared = {t.v0, t.v1, t.v2};
    const u32 limit = std::min(first + LARGEST_FAN, u32(scene.emitters.size()));
    u32 end = first + 1;
    for (; end < limit; ++end) {
        const Triangle& next = triangle_of(scene, end);
        shared = shared_vertices(shared, next);
        if (is_none(shared) || !shine_alike(scene, first, end) || next.object != t.object ||
            next.material != t.material || glm::dot(shining_normal(scene, next), normal) < SAME_PLANE_COS)
            break;
    }
    return end;
}

bool has_several_leaves(const Scene& scene, unsigned kinds) {
    size_t leaves = is_chosen(scene.environment, kinds);
    for (const Light& light : scene.lights)
        leaves += is_chosen(light, kinds);
    if ((kinds & KIND_AREA) && !scene.emitters.empty())
        leaves += fan_end(scene, 0) < scene.emitters.size() ? 2 : 1;
    return leaves > 1;
}

bool is_glowing_dome(const Scene& scene, unsigned kinds) {
    const bool has_others = is_chosen(scene.environment, kinds) ||
                            std::any_of(scene.lights.begin(), scene.lights.end(),
                                        [&](const Light& light) { return is_chosen(light, kinds); });
    if (!(kinds & KIND_AREA) || scene.emitters.empty() || has_others || !emitters_are_one_object(scene))
        return false;
    const NormalSums sums = sum_normals(scene);
    if (glm::length(sums.normals) > MOST_OPEN_DOME * sums.area ||
        glm::determinant(sums.squares / sums.area) < LEAST_DOME_DETERMINANT)
        return false;
    const glm::dvec3 middle = sums.points / sums.area;
    for (u32 i = 0; i < scene.emitters.size(); ++i) {
        const Triangle& t = triangle_of(scene, i);
        const double distance = glm::dot(middle - corners_of(scene, t)[0], shining_normal(scene, t));
        if (distance < LEAST_DOME_RADIUS * double(scene.radius))
            return false;
    }
    return true;
}

std::vector<LightLeaf> light_leaves(const Scene& scene, unsigned kinds) {
    std::vector<LightLeaf> leaves;
    if (kinds & KIND_AREA)
        add_fans(scene, leaves);
    const u32 emitters = u32(scene.emitters.size());
    for (u32 i = 0; i < scene.lights.size(); ++i)
        if (is_chosen(scene.lights[i], kinds))
            leaves.push_back(light_leaf(scene, i, emitters + i));
    if (is_chosen(scene.environment, kinds))
        leaves.push_back(far_leaf(emitters + u32(scene.lights.size()), LightRange::SKY, glm::dvec3(0),
                                  FAR_AWAY, sky_irradiance(scene.environment)));
    mix_powers(scene, leaves);
    scale_powers(leaves);
    return leaves;
}

} // namespace clrt
