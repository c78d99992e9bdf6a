// SPDX-License-Identifier: Apache-2.0
#include "probes/aimed_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace clrt {

Scene place(const Scene& scene, const Placement& placement) {
    // The place where Embree tests its own.
    const glm::dvec3 away = glm::normalize(glm::dvec3(148376, 1234, -223423));
    return placed(scene, placement.size, away * placement.distance);
}

std::vector<TestRay> aimed_rays(const Scene& scene, double inner, Aim aim, size_t count, u32 seed) {
    Random random(seed);
    const Core core = core_of(scene);
    std::vector<TestRay> rays;
    rays.reserve(count);
    while (rays.size() < count) {
        const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
        const int corner = int(random.word() % 3);
        glm::dvec3 target = corner_position(scene, triangle, corner);
        if (aim == Aim::EDGE)
            target += random.unit() * (corner_position(scene, triangle, (corner + 1) % 3) - target);
        const glm::dvec3 origin = core.centre + random.in_cube(0.4 * inner * core.half_edge);
        rays.push_back(make_ray_to(origin, target));
    }
    return rays;
}

std::vector<TestRay> rays_at(const Scene& scene, size_t count, u32 seed) {
    Random random(seed);
    std::vector<TestRay> rays;
    while (rays.size() < count) {
        glm::dvec3 target = random.in_cube(1);
        if (rays.size() % 2 && !scene.triangles.empty())
            target = corner_position(scene, scene.triangles[random.word() % scene.triangles.size()], 0);
        rays.push_back(make_ray_to(random.in_cube(2), target));
    }
    return rays;
}

std::vector<TestRay> rays_in_lattice_planes(size_t count, u32 seed) {
    Random random(seed);
    const auto lattice = [&] { return 0.25 * (int(random.word() % 9) - 4); };
    const auto zero = [&] { return random.word() & 1 ? 0.0 : -0.0; };
    std::vector<TestRay> rays;
    for (size_t i = 0; i < count; ++i) {
        glm::dvec3 origin(lattice(), lattice(), lattice()), direction = random.direction();
        const int axis = int(random.word() % 3);
        direction[axis] = zero();
        if (i % 2)
            direction[(axis + 1) % 3] = zero();
        if (i % 4 < 2)
            origin[(axis + 2) % 3] = random.between(-2, 2);
        rays.push_back(make_ray(origin, direction));
    }
    for (const glm::dvec3& d :
         {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, -1}, {1, 1, 1}})
        rays.push_back(make_ray({0, 0, 0}, d));
    return rays;
}

Scene make_cubes() {
    Scene scene = make_empty_scene();
    for (int i = 0; i < 64; ++i) {
        const glm::dvec3 low(i % 4 * 0.5 - 1, i / 4 % 4 * 0.5 - 1, i / 16 * 0.5 - 1);
        append_scene(scene, make_room(low, low + 0.25));
    }
    return scene;
}

std::vector<TestRay> rays_at_flat_grid(const Scene& grid, int cells, size_t count, u32 seed) {
    Random random(seed);
    std::vector<TestRay> rays;
    while (rays.size() < count) {
        const Triangle& triangle = grid.triangles[random.word() % grid.triangles.size()];
        const glm::dvec3 corner = corner_position(grid, triangle, int(random.word() % 3));
        const glm::dvec3 target =
            corner + (rays.size() % 2 ? glm::dvec3(0) : glm::dvec3(random.unit() / cells, 0, 0));
        if (std::max(std::abs(target.x), std::abs(target.z)) >= 1)
            continue; // on the rim a rounded ray may pass outside
        glm::dvec3 origin = random.in_cube(1);
        if (rays.size() % 4 == 1)
            origin.x = target.x, origin.z = target.z;
        rays.push_back(make_ray_to(origin, target));
    }
    return rays;
}

glm::dvec3 point_on(const Scene& scene, const Triangle& triangle, Random& random) {
    double u = random.unit(), v = random.unit();
    if (u + v > 1)
        u = 1 - u, v = 1 - v;
    const glm::dvec3 p0 = corner_position(scene, triangle, 0);
    return p0 + u * (corner_position(scene, triangle, 1) - p0) +
           v * (corner_position(scene, triangle, 2) - p0);
}

size_t count_misses(const std::vector<TestHit>& hits) {
    return size_t(
        std::count_if(hits.begin(), hits.end(), [](const TestHit& h) { return h.triangle == NO_INDEX; }));
}

size_t count_differences(const std::vector<TestHit>& a, const std::vector<TestHit>& b) {
    size_t differences = a.size() != b.size();
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        differences += a[i] != b[i];
    return differences;
}

} // namespace clrt
