// SPDX-License-Identifier: Apache-2.0
#include "scene/ground.h"

#include "scene/build_extension.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace clrt {
namespace {

/// Along a side.
constexpr int SQUARES = int(2 * GROUND_HALF_SIDE / GROUND_SQUARE);

/// A unit vector perpendicular to a unit vector: along the axis that is nearest to being so.
glm::dvec3 perpendicular(const glm::dvec3& up) {
    const glm::dvec3 axis = std::fabs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    return glm::normalize(axis - glm::dot(axis, up) * up);
}

/// Appends the corners of a lattice, row by row, in the plane through `centre` spanned by u
/// and v.
void append_corners(const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v, Scene& scene) {
    for (int i = 0; i <= SQUARES; ++i)
        for (int j = 0; j <= SQUARES; ++j) {
            const glm::dvec3 p = centre + (j * GROUND_SQUARE - GROUND_HALF_SIDE) * u +
                                 (i * GROUND_SQUARE - GROUND_HALF_SIDE) * v;
            const vec4 corner{float(p.x), float(p.y), float(p.z), 0};
            for (const float c : {corner.x, corner.y, corner.z})
                scene.ground_extent = std::max(scene.ground_extent, std::fabs(c));
            scene.positions.push_back(corner);
        }
}

void append_material(const glm::dvec3& albedo, Scene& scene) {
    MaterialDescription ground;
    ground.base.value = albedo;
    scene.materials.push_back(build_material(ground, {}, {}));
    append_extension(build_extension(ground, scene.materials.back(), {}, {}), scene);
    scene.emitted.emplace_back();
    scene.material_names.emplace_back("ground");
    scene.material_places.emplace_back();
    scene.material_rules.emplace_back("--ground: matte");
}

} // namespace

size_t file_triangles(const Scene& scene) {
    return scene.triangles.size() - (scene.ground_extent > 0 ? 2 * size_t(SQUARES) * SQUARES : 0);
}

double lowest_along(const Scene& scene, const glm::dvec3& up) {
    if (scene.triangles.empty())
        return 0;
    double lowest = std::numeric_limits<double>::max();
    for (const Triangle& triangle : scene.triangles)
        for (const u32 corner : {triangle.v0, triangle.v1, triangle.v2}) {
            const vec4& p = scene.positions[corner];
            lowest = std::min(lowest, p.x * up.x + p.y * up.y + p.z * up.z);
        }
    return lowest;
}

void append_ground(const glm::dvec3& up, const glm::dvec3& albedo, Scene& scene) {
    const glm::dvec3 centre = (lowest_along(scene, up) - GROUND_GAP) * up;
    const glm::dvec3 u = perpendicular(up), v = glm::cross(up, u);
    append_material(albedo, scene);
    scene.object_names.emplace_back("ground");
    const u32 material = u32(scene.materials.size() - 1), object = u32(scene.object_names.size() - 1);
    const u32 first = u32(scene.positions.size());
    append_corners(centre, u, v, scene);
    const auto triangle = [&](u32 a, u32 b, u32 c) {
        scene.triangles.push_back({a, b, c, NO_INDEX, NO_INDEX, NO_INDEX, NO_INDEX, NO_INDEX, NO_INDEX,
                                   material, NO_INDEX, object});
    };
    const u32 row = u32(SQUARES) + 1;
    for (u32 i = 0; i + 1 < row; ++i)
        for (u32 j = 0; j + 1 < row; ++j) {
            const u32 a =
                first + i * row + j; // counter-clockwise seen from above: a, a + 1, a + row + 1, a + row
            triangle(a, a + 1, a + row + 1);
            triangle(a, a + row + 1, a + row);
        }
}

} // namespace clrt
