// SPDX-License-Identifier: Apache-2.0
// Meshes that break builders and traversals: corners on a line, coordinates that are not finite, needles.
// More is in the catalogue (tools/stability/cases/degenerate_cases.cpp).
#include "probes/aimed_rays.h"
#include "support/test_device.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace clrt {
namespace {

size_t count_hits(const std::vector<TestHit>& hits) {
    return size_t(
        std::count_if(hits.begin(), hits.end(), [](const TestHit& h) { return h.triangle != NO_INDEX; }));
}

void expect_hits_of_all(const Scene& scene, const std::vector<TestRay>& rays, size_t least_hits) {
    std::vector<TestHit> all;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), scene, layout);
        if (all.empty())
            all = device.closest_of_all(rays);
        EXPECT_EQ(count_differences(device.closest(rays), all), 0u) << name_of(layout);
    }
    EXPECT_GE(count_hits(all), least_hits);
}

} // namespace

TEST(Degenerate, CornersInLineAreHitAsTheTriangleTestSays) {
    Scene scene = make_soup(2000, 0.3, 1);
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const double x = 0.25 * (i % 8 - 4), z = random.between(-1, 1);
        add_triangle(scene, {x, -1, z}, {x, 0.125, z}, {x, 1, z});
    }
    std::vector<TestRay> rays = rays_at(scene, 20000, 1);
    // Along the lines, too.
    for (int i = 0; i < 20000; ++i)
        rays.push_back(
            make_ray_to(random.in_cube(2), {0.25 * (i % 8 - 4), random.between(-1, 1),
                                            corner_position(scene, scene.triangles[2000 + i % 2000], 0).z}));
    expect_hits_of_all(scene, rays, rays.size() / 4);
}

TEST(Degenerate, TrianglesThatAreNotFiniteChangeNoHit) {
    const Scene soup = make_soup(2000, 0.3, 2);
    Scene with_bad = soup;
    for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY), 1e30})
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 corner(0.5);
            corner[axis] = bad;
            add_triangle(with_bad, {-1, 0, 0}, {0, 1, 0}, corner);
            add_triangle(with_bad, corner, {-1, 0, 0}, corner);
        }
    const std::vector<TestRay> rays = rays_at(soup, 20000, 2);
    const float extent = extent_of(soup);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        RayDeviceOptions options;
        options.layout = layout;
        options.extent = extent;
        const RayDevice device(test_device(), with_bad, options);
        EXPECT_EQ(device.bvh().triangle_count, soup.triangles.size());
        EXPECT_EQ(
            count_differences(device.closest(rays), RayDevice(test_device(), soup, layout).closest(rays)), 0u)
            << name_of(layout);
    }
}

// Nested triangles: a tree of about 50 levels, where each ray meets all boxes.
TEST(Degenerate, ADeepTreeOverflowsNoStack) {
    Scene scene = make_empty_scene();
    for (int k = -60; k <= 60; ++k)
        for (int i = 0; i < 64; ++i) {
            const double s = std::ldexp(1.0 + i / 64.0, k);
            add_triangle(scene, {-s, -s, s}, {s, -s, s}, {0, s, s * 1.001});
        }
    Random random(8);
    std::vector<TestRay> rays;
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 d(random.between(-0.3, 0.3), random.between(-0.3, 0.1), 1);
        rays.push_back(i % 2 ? make_ray({0, 0, 0}, d) : make_ray(d * std::ldexp(1.0, 62), -d));
    }
    for (const BvhLayout layout : ALL_LAYOUTS)
        EXPECT_GT(RayDevice(test_device(), scene, layout).bvh().depth, 40) << name_of(layout);
    expect_hits_of_all(scene, rays, rays.size() * 2 / 5);
}

// Edges whose products underflow when they are squared, and edges that become parallel when they are rounded:
// a normal has length 1 all the same, and faces the ray.
TEST(Degenerate, TinyTrianglesAndNeedlesHaveUnitNormals) {
    Random random(9);
    Scene scene = make_empty_scene();
    for (int k = 0; k <= 50; ++k)
        for (int i = 0; i < 8; ++i) {
            const double s = std::ldexp(1.0, -k);
            const glm::dvec3 p0 = random.in_cube(s), p1 = random.in_cube(s);
            add_triangle(scene, p0, p1, random.in_cube(s));
        }
    // The third corner lies 2^-53 off the line between the others.
    add_triangle(scene, {-1, -1, 0}, {1, 1, 0}, {0x1p-30, 0x1p-30 + 0x1p-53, 0});
    std::vector<TestRay> rays;
    std::vector<TestHit> hits;
    for (u32 i = 0; i < scene.triangles.size(); ++i) {
        rays.push_back(make_ray({0, 0, 0}, random.direction()));
        hits.push_back({1, 0.25, 0.25, i});
    }
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const std::vector<vec4> normals = RayDevice(test_device(), scene, layout).normals(rays, hits);
        for (size_t i = 0; i < normals.size(); ++i) {
            const glm::dvec3 n = to_dvec3(normals[i]);
            EXPECT_NEAR(glm::length(n), 1, 4 * FLOAT_U) << "triangle " << i << ", " << name_of(layout);
            EXPECT_LE(glm::dot(n, to_dvec3(rays[i].direction)), 1e-6) << i;
            if (i + 1 == normals.size())
                break; // nobody can tell where the needle's normal points
            const glm::dvec3 exact = glm::normalize(triangle_normal(scene, scene.triangles[i]));
            EXPECT_NEAR(std::abs(glm::dot(n, exact)), 1, 1e-4) << i;
        }
    }
}

} // namespace clrt
