// SPDX-License-Identifier: Apache-2.0
// Meshes that break builders and traversals: no area, copies, twins, nothing at all, depth without end.
#include "support/meshes.h"
#include "support/random_inputs.h"
#include "support/ray_device.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace clrt {
namespace {

/// Rays from around the cube [-1, 1]^3 to points and corners within.
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

size_t count_differences(const std::vector<TestHit>& a, const std::vector<TestHit>& b) {
    size_t differences = a.size() != b.size();
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        differences += a[i] != b[i];
    return differences;
}

size_t count_hits(const std::vector<TestHit>& hits) {
    return size_t(
        std::count_if(hits.begin(), hits.end(), [](const TestHit& h) { return h.triangle != NO_INDEX; }));
}

void expect_hits_of_all(const Scene& scene, const std::vector<TestRay>& rays, size_t least_hits) {
    std::vector<TestHit> all;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(scene, layout);
        if (all.empty())
            all = device.closest_of_all(rays);
        EXPECT_EQ(count_differences(device.closest(rays), all), 0u) << layout_name(layout);
    }
    EXPECT_GE(count_hits(all), least_hits);
}

} // namespace

TEST(Degenerate, TrianglesWithEqualCornersChangeNoHit) {
    const Scene soup = make_soup(2000, 0.3, 1);
    Scene with_degenerate = soup;
    Random random(1);
    const auto any_position = [&] { return u32(random.word() % with_degenerate.positions.size()); };
    for (int i = 0; i < 10000; ++i) {
        const u32 a = any_position(), b = any_position();
        add_triangle(with_degenerate, a, i % 2 == 0 ? a : b, a);
    }
    const std::vector<TestRay> rays = rays_at(with_degenerate, 50000, 1);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(with_degenerate, layout);
        EXPECT_EQ(device.bvh().triangle_count, soup.triangles.size());
        EXPECT_EQ(count_differences(device.closest(rays), RayDevice(soup, layout).closest(rays)), 0u)
            << layout_name(layout);
    }
}

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
        const RayDevice device(with_bad, options);
        EXPECT_EQ(device.bvh().triangle_count, soup.triangles.size());
        EXPECT_EQ(count_differences(device.closest(rays), RayDevice(soup, layout).closest(rays)), 0u)
            << layout_name(layout);
    }
}

// Copies first, the original last: the tree must not keep the one it meets first.
TEST(Degenerate, OfManyCopiesTheLowestIndexIsHit) {
    constexpr u32 COPIES = 100000;
    Scene scene = make_empty_scene();
    const u32 first = add_position(scene, {-1, -1, 0});
    add_position(scene, {1, -1, 0.5});
    add_position(scene, {0, 1, -0.5});
    for (u32 i = 0; i < COPIES; ++i)
        add_triangle(scene, first, first + 1, first + 2);
    Random random(3);
    std::vector<TestRay> rays;
    for (int i = 0; i < 64; ++i)
        rays.push_back(
            make_ray_to(random.in_cube(0.5) + glm::dvec3(0, 0, 3), {random.between(-0.2, 0.2), -0.3, 0}));
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(scene, layout);
        EXPECT_LE(device.bvh().depth, BVH_MAX_DEPTH);
        size_t wrong = 0;
        for (const TestHit& hit : device.closest(rays))
            wrong += hit.triangle != 0;
        EXPECT_EQ(wrong, 0u) << layout_name(layout);
    }
}

TEST(Degenerate, OfTwinsTheFirstIsHit) {
    Scene scene = make_tilted_plane(16);
    const u32 count = u32(scene.triangles.size());
    Random random(4);
    // Each triangle once more, in another order and with its corners in another order, which turns the
    // winding too.
    std::vector<Triangle> twins = scene.triangles;
    for (u32 i = count - 1; i > 0; --i)
        std::swap(twins[i], twins[random.word() % (i + 1)]);
    for (const Triangle& twin : twins)
        add_triangle(scene, twin.v0, twin.v1, twin.v2);
    const std::vector<TestRay> rays = rays_at(scene, 50000, 4);
    expect_hits_of_all(scene, rays, rays.size() / 4);
    for (const BvhLayout layout : ALL_LAYOUTS)
        for (const TestHit& hit : RayDevice(scene, layout).closest(rays))
            ASSERT_TRUE(hit.triangle == NO_INDEX || hit.triangle < count) << layout_name(layout);
}

TEST(Degenerate, AnEmptySceneIsHitNowhere) {
    Scene scene = make_empty_scene();
    const std::vector<TestRay> rays = rays_at(scene, 10000, 5);
    for (int points = 0; points < 2; ++points) {
        for (const BvhLayout layout : ALL_LAYOUTS) {
            const RayDevice device(scene, layout);
            EXPECT_EQ(count_hits(device.closest(rays)), 0u) << layout_name(layout);
            const std::vector<u32> any = device.any(rays);
            EXPECT_EQ(std::count(any.begin(), any.end(), 1u), 0) << layout_name(layout);
        }
        add_triangle(scene, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}); // a point is nothing, too
    }
}

TEST(Degenerate, ASingleTriangleIsHitWhereItIs) {
    Scene scene = make_empty_scene();
    add_triangle(scene, {-1, -1, 0.25}, {1, -1, 0.25}, {0, 1, 0.25});
    const std::vector<TestRay> rays = rays_at(scene, 20000, 6);
    expect_hits_of_all(scene, rays, rays.size() / 20);
}

// Triangles at 2^-k: each level of a tree splits few of them off.
TEST(Degenerate, ChainsOfShrinkingTrianglesAreHitLikeAllTriangles) {
    Scene scene = make_empty_scene();
    for (int k = 0; k <= 120; ++k) {
        const double s = std::ldexp(1.0, -k);
        add_triangle(scene, {s, 0, 0}, {s, s / 2, 0}, {s, 0, s / 2});
        add_triangle(scene, {s, s, 0}, {s / 2, s, s / 4}, {s, s / 2, s / 4});
    }
    Random random(7);
    std::vector<TestRay> rays;
    for (int i = 0; i < 100000; ++i) {
        const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
        const glm::dvec3 target = corner_position(scene, triangle, int(random.word() % 3));
        // From everywhere, and along the chain so that all boxes are met.
        rays.push_back(
            i % 2 ? make_ray_to(random.in_cube(2), target)
                  : make_ray({-0.5, 0, 0}, {1, random.between(-1e-3, 1e-3), random.between(-1e-3, 1e-3)}));
    }
    expect_hits_of_all(scene, rays, rays.size() / 8);
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
        EXPECT_GT(RayDevice(scene, layout).bvh().depth, 40) << layout_name(layout);
    expect_hits_of_all(scene, rays, rays.size() * 2 / 5);
}

// Beside each of 58 shrinking levels stands a group of much larger triangles: the cheapest wide tree would
// have more levels than the stack of cwbvh has entries. Rays near the small end meet nearly all boxes.
TEST(Degenerate, TheLongestPathOverflowsNoStack) {
    Scene scene = make_empty_scene();
    for (int k = 0; k < 58; ++k)
        for (int i = 0; i < 64; ++i) {
            const double s = std::ldexp(1.0, 58 - 3 * k), step = s / 8, y = i % 8 * step, z = i / 8 * step;
            add_triangle(scene, {0.9 * s, y, z}, {s, y + step / 2, z}, {0.95 * s, y, z + step / 2});
        }
    Random random(10);
    std::vector<TestRay> rays;
    for (int i = 0; i < 2000; ++i)
        rays.push_back(make_ray_to(
            {0, 0, 0},
            corner_position(scene, scene.triangles[random.word() % scene.triangles.size()], i % 3)));
    expect_hits_of_all(scene, rays, rays.size() / 4);
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
        const std::vector<vec4> normals = RayDevice(scene, layout).normals(rays, hits);
        for (size_t i = 0; i < normals.size(); ++i) {
            const glm::dvec3 n = to_dvec3(normals[i]);
            EXPECT_NEAR(glm::length(n), 1, 4 * FLOAT_U) << "triangle " << i << ", " << layout_name(layout);
            EXPECT_LE(glm::dot(n, to_dvec3(rays[i].direction)), 1e-6) << i;
            if (i + 1 == normals.size())
                break; // nobody can tell where the needle's normal points
            const glm::dvec3 exact = glm::normalize(triangle_normal(scene, scene.triangles[i]));
            EXPECT_NEAR(std::abs(glm::dot(n, exact)), 1, 1e-4) << i;
        }
    }
}

} // namespace clrt
