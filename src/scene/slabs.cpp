// SPDX-License-Identifier: Apache-2.0
#include "scene/slabs.h"

#include "colour.h"
#include "scene/vectors.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace clrt {
namespace {

/// Facets of more directions are those of gems and of what is round: hardly any light crosses two parallel
/// ones of them, and every shadow ray would look for it.
constexpr size_t MOST_DIRECTIONS = 24;
/// Two normals are alike within so many radians.
constexpr double LARGEST_ANGLE = 2e-4;
/// Of the area, what has a parallel part.
constexpr double SMALLEST_SHARE = 0.5;

/// The area of facets by their normals.
class FacetDirections {
public:
    /// `cross`: the normal, twice the area long.
    void add(const glm::dvec3& cross) {
        const double length = glm::length(cross);
        if (!(length > 0) || directions_.size() > MOST_DIRECTIONS)
            return;
        const glm::dvec3 normal = cross / length;
        total_ += length;
        for (Direction& direction : directions_)
            if (glm::distance(direction.normal, normal) <= LARGEST_ANGLE) {
                direction.area += length;
                return;
            }
        directions_.push_back({normal, length});
    }
    bool are_slabs() const {
        if (directions_.size() > MOST_DIRECTIONS)
            return false;
        double paired = 0;
        for (const Direction& a : directions_)
            for (const Direction& b : directions_)
                if (glm::distance(a.normal, -b.normal) <= LARGEST_ANGLE)
                    paired += std::min(a.area, b.area);
        return total_ > 0 && paired >= SMALLEST_SHARE * total_;
    }

private:
    struct Direction {
        glm::dvec3 normal;
        double area;
    };
    std::vector<Direction> directions_;
    double total_ = 0;
};

glm::dvec3 cross_of(const Scene& scene, const Triangle& triangle) {
    const glm::dvec3 corner = to_dvec3(scene.positions[triangle.v0]);
    return glm::cross(to_dvec3(scene.positions[triangle.v1]) - corner,
                      to_dvec3(scene.positions[triangle.v2]) - corner);
}

/// True if the normals of the corners are that of the plane.
bool is_flat(const Scene& scene, const Triangle& triangle) {
    if (triangle.n0 == NO_INDEX)
        return true;
    const glm::dvec3 cross = cross_of(scene, triangle);
    const double smallest = (1 - 1e-6) * glm::length(cross);
    for (const u32 n : {triangle.n0, triangle.n1, triangle.n2})
        if (std::abs(glm::dot(to_dvec3(scene.normals[n]), cross)) < smallest)
            return false;
    return true;
}

/// Smooth clear glass without anything on it.
bool is_clear(const Scene& scene, size_t index) {
    const Material& material = scene.materials[index];
    constexpr u32 OTHERS = MATERIAL_CUT_OUT | MATERIAL_PART_GLASS | MATERIAL_DISPERSES | MATERIAL_NESTED;
    if (material.lobes != LOBE_DIELECTRIC || material.alpha_x != 0 || material.alpha_y != 0 ||
        (material.flags & OTHERS) || !is_zero(material.emission) || material.map_normal != NO_INDEX ||
        material.map_bump != NO_INDEX)
        return false;
    return scene.extensions.empty() ||
           (scene.extensions[index].coat == 0 && is_zero(scene.extensions[index].sheen));
}

/// Whether connections can cross slabs: there are some, and no solids within each other.
bool has_slabs(const Scene& scene) {
    const auto any = [&](u32 flag) {
        return std::any_of(scene.materials.begin(), scene.materials.end(),
                           [&](const Material& material) { return (material.flags & flag) != 0; });
    };
    return any(MATERIAL_SLAB) && !any(MATERIAL_NESTED);
}

} // namespace

void mark_slabs(Scene& scene) {
    std::vector<FacetDirections> directions(scene.materials.size());
    std::vector<bool> may_be(scene.materials.size());
    for (size_t i = 0; i < scene.materials.size(); ++i)
        may_be[i] = is_clear(scene, i);
    for (const Triangle& triangle : scene.triangles) {
        if (!may_be[triangle.material])
            continue;
        may_be[triangle.material] = is_flat(scene, triangle);
        directions[triangle.material].add(cross_of(scene, triangle));
    }
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        scene.materials[i].flags &= ~MATERIAL_SLAB;
        if (may_be[i] && directions[i].are_slabs())
            scene.materials[i].flags |= MATERIAL_SLAB;
    }
}

bool has_suns(const Scene& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const Light& light) { return light.kind == LIGHT_SUN; });
}

bool has_slabs_before_the_sky(const Scene& scene) {
    const Environment& sky = scene.environment;
    const bool has_sky = (sky.texels.empty() ? luminance(sky.radiance) : sky.mean_radiance) > 0;
    return (has_suns(scene) || has_sky) && has_slabs(scene);
}

bool has_slabs_before_lamps(const Scene& scene) {
    const auto dims = [&](const Emitter& emitter) {
        return (scene.materials[scene.triangles[emitter.triangle].material].lobes & LOBE_COAT) != 0;
    };
    return !scene.emitters.empty() && has_slabs(scene) &&
           std::none_of(scene.emitters.begin(), scene.emitters.end(), dims);
}

} // namespace clrt
