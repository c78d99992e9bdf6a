// SPDX-License-Identifier: Apache-2.0
// A ray that leaves a surface meets neither that surface nor its coplanar neighbours again, moves no farther
// than the error bound asks, and never starts behind another wall.
#include "support/meshes.h"
#include "support/random_inputs.h"
#include "support/ray_device.h"
#include "support/scene_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <utility>

namespace clrt {
namespace {

/// Rays with their hits, misses left out.
struct Arrivals {
    std::vector<TestRay> rays;
    std::vector<TestHit> hits;
};

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

/// A direction on the side of the plane from which the ray came, at the given cosine to its normal; rounded
/// to float and on that side even so. `normal` is exact.
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

/// Cosines of which one in four is grazing.
double any_cosine(Random& random) {
    return random.word() % 4 ? random.unit() : std::abs(random.signed_log(1e-7, 1e-3));
}

/// How many of the rays that leave the arrivals are stopped. Directions are on the arrivals' side of the
/// triangles.
size_t count_stopped(const Scene& scene, const RayDevice& device, const Arrivals& from,
                     size_t directions_each, Random& random) {
    size_t stopped = 0;
    for (size_t round = 0; round < directions_each; ++round) {
        std::vector<glm::dvec3> directions;
        for (size_t i = 0; i < from.rays.size(); ++i)
            directions.push_back(
                leaving_direction(triangle_normal(scene, scene.triangles[from.hits[i].triangle]),
                                  from.rays[i], any_cosine(random), random));
        for (const u32 any : device.any(device.leaving(from.rays, from.hits, directions)))
            stopped += any;
    }
    return stopped;
}

glm::dvec3 point_on(const Scene& scene, const Triangle& triangle, Random& random) {
    double u = random.unit(), v = random.unit();
    if (u + v > 1)
        u = 1 - u, v = 1 - v;
    const glm::dvec3 p0 = corner_position(scene, triangle, 0);
    return p0 + u * (corner_position(scene, triangle, 1) - p0) +
           v * (corner_position(scene, triangle, 2) - p0);
}

} // namespace

// One triangle a scene, and so no other to meet; coordinates over sixteen decades, then in the loader's
// frame.
TEST(Offset, NoRayMeetsTheTriangleItLeaves) {
    size_t left = 0;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        Random random(1);
        size_t stopped = 0;
        for (int i = 0; i < 1000; ++i) {
            Scene scene = make_empty_scene();
            const auto corner = [&] {
                const double x = random.signed_log(1e-8, 1e8), y = random.signed_log(1e-8, 1e8);
                return glm::dvec3(x, y, random.signed_log(1e-8, 1e8));
            };
            const glm::dvec3 p0 = corner(), p1 = corner();
            add_triangle(scene, p0, p1, corner());
            scene = normalised(scene);
            const Triangle& triangle = scene.triangles[0];
            const double extent = extent_of(scene);
            std::vector<TestRay> rays;
            for (int k = 0; k < 64; ++k)
                rays.push_back(make_ray_to(random.in_cube(2 * extent), point_on(scene, triangle, random)));
            const RayDevice device(scene, layout);
            const Arrivals from = arrivals(device, rays);
            stopped += count_stopped(scene, device, from, 16, random);
            left += 16 * from.rays.size();
        }
        EXPECT_EQ(stopped, 0u) << layout_name(layout);
    }
    RecordProperty("rays", std::to_string(left));
    EXPECT_GT(left, 1000000u);
}

// Corners are exactly in one plane, so that all of the upper side is free.
TEST(Offset, NoRayMeetsTheNeighboursInItsPlane) {
    for (const double size : {1.0, 0x1p-20}) {
        const Scene scene = placed(make_tilted_plane(256), size, {0, 0, 0});
        Random random(2);
        std::vector<TestRay> rays;
        for (int i = 0; i < 100000; ++i) {
            const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
            // Into triangles, at edges and at corners.
            glm::dvec3 target = point_on(scene, triangle, random);
            if (i % 4 == 1)
                target = corner_position(scene, triangle, 0);
            if (i % 4 == 2)
                target = 0.5 * (corner_position(scene, triangle, 1) + corner_position(scene, triangle, 2));
            rays.push_back(make_ray_to(random.in_cube(2 * size), target));
        }
        for (const BvhLayout layout : ALL_LAYOUTS) {
            const RayDevice device(scene, layout);
            const Arrivals from = arrivals(device, rays);
            EXPECT_GT(from.rays.size(), rays.size() * 9 / 10);
            EXPECT_EQ(count_stopped(scene, device, from, 2, random), 0u)
                << size << ", " << layout_name(layout);
        }
    }
}

TEST(Offset, NoRayMeetsTheConvexBodyItLeaves) {
    Scene scene = make_empty_scene();
    for (const TestTriangle& triangle : icosphere_triangles({0, 0, 0}, 1, 5))
        add_triangle(scene, triangle.corners[0], triangle.corners[1], triangle.corners[2]);
    Random random(3);
    std::vector<TestRay> rays;
    for (int i = 0; i < 200000; ++i) {
        const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
        const glm::dvec3 target =
            i % 2 ? point_on(scene, triangle, random) : corner_position(scene, triangle, 0);
        rays.push_back(
            make_ray_to(target + 2.0 * random.unit() * triangle_normal(scene, triangle) * 4096.0, target));
    }
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(scene, layout);
        const Arrivals from = arrivals(device, rays);
        EXPECT_GT(from.rays.size(), rays.size() * 99 / 100);
        EXPECT_EQ(count_stopped(scene, device, from, 3, random), 0u) << layout_name(layout);
    }
}

// The bound is small: beside the body it belongs to, or beside the spacing of floats where that stands.
TEST(Offset, ItIsAFewRoundingsOfSizeAndPlace) {
    struct Case {
        double size, distance, limit;
    };
    for (const Case& c : {Case{1, 0, 2e-6}, {1e-6, 0, 2e-6}, {1e7, 0, 2e-6}, {1, 1e4, 0}, {2, 2.6e5, 0}}) {
        const Scene scene = placed(make_ball(24, 24), c.size, glm::dvec3(0.6, 0.1, -0.8) * c.distance);
        std::vector<TestRay> rays;
        std::vector<TestHit> hits;
        for (u32 i = 0; i < scene.triangles.size(); ++i) {
            rays.push_back(make_ray({0, 0, 0}, {0, 0, 1}));
            hits.push_back({1, 0.25, 0.25, i});
        }
        // Two units in the last place of the distance, or a share of the size.
        const double limit = c.limit > 0 ? c.limit * c.size : 8 * FLOAT_U * c.distance;
        for (const vec4& n : RayDevice(scene, BvhLayout::BVH2).normals(rays, hits))
            ASSERT_LE(n.w, limit) << c.size << "@" << c.distance;
    }
}

namespace {

Scene make_tetrahedron(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    Scene scene = make_empty_scene();
    for (const glm::dvec3& p : {a, b, c, d})
        add_position(scene, p);
    for (const auto& [i, j, k] : {std::array<u32, 3>{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}})
        add_triangle(scene, i, j, k);
    return scene;
}

/// The middle of a convex room.
glm::dvec3 middle_of(const Scene& room) {
    glm::dvec3 sum(0);
    for (const vec4& p : room.positions)
        sum += to_dvec3(p);
    return sum / double(room.positions.size());
}

/// Follows rays around a convex room, off its walls in random directions, and counts those that get out.
size_t count_escapes(const Scene& room, BvhLayout layout, size_t paths, int bounces, u32 seed) {
    const RayDevice device(room, layout);
    Random random(seed);
    const glm::dvec3 middle = middle_of(room);
    std::vector<TestRay> rays;
    for (size_t i = 0; i < paths; ++i) {
        const Triangle& triangle = room.triangles[random.word() % room.triangles.size()];
        // Anywhere, into the edges between walls, and into the corners.
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
    size_t escapes = 0;
    for (int bounce = 0; bounce < bounces; ++bounce) {
        const Arrivals from = arrivals(device, rays);
        escapes += rays.size() - from.rays.size();
        std::vector<glm::dvec3> directions;
        for (size_t i = 0; i < from.rays.size(); ++i) {
            const glm::dvec3 normal = triangle_normal(room, room.triangles[from.hits[i].triangle]);
            directions.push_back(leaving_direction(normal, from.rays[i], any_cosine(random), random));
        }
        rays = device.leaving(from.rays, from.hits, directions);
    }
    return escapes + rays.size() - arrivals(device, rays).rays.size();
}

} // namespace

TEST(Offset, NoLightGetsOutOfARoomNotEvenAtItsCorners) {
    const Scene upright = make_room({-1, -1, -1}, {1, 1, 1});
    Scene turned = make_room({-1, -0.6, -1.1}, {0.7, 0.8, 0.9});
    const glm::dvec3 x = glm::normalize(glm::dvec3(1, 0.3, -0.2)),
                     z = glm::normalize(glm::cross(x, {0.1, 1, 0.4}));
    for (vec4& p : turned.positions)
        p = to_vec4(double(p.x) * x + double(p.y) * glm::cross(z, x) + double(p.z) * z);
    // Walls at 70 and at 30 degrees.
    const Scene tetrahedron = make_tetrahedron({1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1});
    const Scene wedge = make_tetrahedron({-1, 0, 0.1}, {1, 0.1, 0}, {0.1, 1, 0.27}, {0, 1, -0.27});
    const std::pair<const char*, const Scene*> rooms[] = {
        {"upright", &upright}, {"turned", &turned}, {"tetrahedron", &tetrahedron}, {"wedge", &wedge}};
    for (const auto& [name, room] : rooms)
        for (const BvhLayout layout : ALL_LAYOUTS)
            EXPECT_EQ(count_escapes(*room, layout, 50000, 5, 4), 0u) << name << ", " << layout_name(layout);
}

} // namespace clrt
