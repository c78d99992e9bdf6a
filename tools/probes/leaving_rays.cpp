// SPDX-License-Identifier: Apache-2.0
#include "probes/leaving_rays.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace clrt {

Arrivals arrivals(const RayDevice& device, const std::vector<TestRay>& rays) {
    const std::vector<TestHit> hits = device.closest(rays);
    Arrivals result;
    for (size_t i = 0; i < rays.size(); ++i)
        if (hits[i].triangle != NO_INDEX) {
            result.rays.push_back(rays[i]);
            result.hits.push_back(hits[i]);
        }
    return result;
}

glm::dvec3 leaving_direction(const glm::dvec3& normal, const TestRay& ray, double cos_o, Random& random) {
    const glm::dvec3 n = glm::normalize(glm::dot(normal, to_dvec3(ray.direction)) > 0 ? -normal : normal);
    for (;;) {
        const glm::dvec3 tangent = glm::cross(n, random.direction());
        if (glm::length(tangent) < 0.1)
            continue;
        const glm::dvec3 direction = n * cos_o + glm::normalize(tangent) * std::sqrt(1 - cos_o * cos_o);
        const glm::dvec3 rounded = to_dvec3(make_ray({0, 0, 0}, direction).direction);
        if (glm::dot(rounded, n) > 0)
            return rounded;
        cos_o = 2 * cos_o + 1e-7; // rounding took it to the other side
    }
}

double any_cosine(Random& random) {
    return random.word() % 4 ? random.unit() : std::abs(random.signed_log(1e-7, 1e-3));
}

std::vector<TestRay> leave_at_random(const Scene& scene, const RayDevice& device, const Arrivals& from,
                                     Random& random) {
    std::vector<glm::dvec3> directions;
    for (size_t i = 0; i < from.rays.size(); ++i)
        directions.push_back(leaving_direction(triangle_normal(scene, scene.triangles[from.hits[i].triangle]),
                                               from.rays[i], any_cosine(random), random));
    return device.leaving(from.rays, from.hits, directions);
}

Scene make_tetrahedron(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    Scene scene = make_empty_scene();
    for (const glm::dvec3& p : {a, b, c, d})
        add_position(scene, p);
    for (const auto& [i, j, k] : {std::array<u32, 3>{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}})
        add_triangle(scene, i, j, k);
    return scene;
}

std::vector<TestRay> rays_in_room(const Scene& room, size_t count, Random& random) {
    glm::dvec3 middle(0);
    for (const vec4& p : room.positions)
        middle += to_dvec3(p) / double(room.positions.size());
    std::vector<TestRay> rays;
    for (size_t i = 0; i < count; ++i) {
        const Triangle& triangle = room.triangles[random.word() % room.triangles.size()];
        glm::dvec3 target = point_on(room, triangle, random);
        const glm::dvec3 corner = corner_position(room, triangle, int(i / 4 % 3));
        if (i % 4 == 1)
            target = corner;
        if (i % 4 == 2)
            target = corner + random.unit() * (corner_position(room, triangle, int(i / 4 + 1) % 3) - corner);
        // From anywhere between the middle and a wall.
        const glm::dvec3 wall = point_on(room, room.triangles[random.word() % room.triangles.size()], random);
        rays.push_back(make_ray_to(middle + 0.9 * random.unit() * (wall - middle), target));
    }
    return rays;
}

} // namespace clrt
