// SPDX-License-Identifier: Apache-2.0
// Rays through a tree hit what a test of all triangles hits, to the last bit, in every layout.
#include "probes/meshes.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"
#include "support/test_device.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

namespace clrt {
namespace {

/// Rays in and around the cube [-1, 1]^3: into the void, at corners, at edges, and with zeros in the
/// direction.
std::vector<TestRay> mixed_rays(const Scene& scene, size_t count, u32 seed) {
    Random random(seed);
    std::vector<TestRay> rays;
    rays.reserve(count);
    while (rays.size() < count) {
        const glm::dvec3 origin = random.in_cube(1.5);
        const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
        const glm::dvec3 p0 = corner_position(scene, triangle, 0), p1 = corner_position(scene, triangle, 1);
        glm::dvec3 direction = random.direction();
        switch (rays.size() % 4) {
        case 0:
            break;
        case 1:
            direction = p0 - to_dvec3(to_vec4(origin));
            break;
        case 2:
            direction = p0 + random.unit() * (p1 - p0) - to_dvec3(to_vec4(origin));
            break;
        default:
            direction[int(random.word() % 3)] = random.word() & 1 ? 0.0 : -0.0;
        }
        rays.push_back(make_ray(origin, direction));
    }
    return rays;
}

size_t count_hits(const std::vector<TestHit>& hits) {
    return size_t(
        std::count_if(hits.begin(), hits.end(), [](const TestHit& h) { return h.triangle != NO_INDEX; }));
}

size_t count_differences(const std::vector<TestHit>& a, const std::vector<TestHit>& b) {
    size_t differences = 0;
    for (size_t i = 0; i < a.size(); ++i)
        differences += a[i] != b[i];
    return differences;
}

void expect_hits_of_all(const Scene& scene, const std::vector<TestRay>& rays,
                        Precision precision = Precision::SINGLE) {
    std::vector<TestHit> all;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), scene, layout, precision);
        if (all.empty())
            all = device.closest_of_all(rays);
        EXPECT_EQ(count_differences(device.closest(rays), all), 0u)
            << "of " << rays.size() << " rays, " << name_of(layout);
    }
    EXPECT_GT(count_hits(all), rays.size() / 10);
}

} // namespace

TEST(Traverse, HitsOnClosedMeshesAreThoseOfAllTriangles) {
    const Scene ball = make_ball(24, 24);
    expect_hits_of_all(ball, mixed_rays(ball, 50000, 1));
    const Scene star = placed(make_star(24, 24, 2), 0.25, {0, 0, 0});
    expect_hits_of_all(star, mixed_rays(star, 50000, 2));
}

TEST(Traverse, HitsInASoupAreThoseOfAllTriangles) {
    const Scene coarse = make_soup(1000, 0.3, 3);
    expect_hits_of_all(coarse, mixed_rays(coarse, 50000, 3));
    const Scene fine = make_soup(100000, 0.02, 4);
    expect_hits_of_all(fine, mixed_rays(fine, 1000, 4));
}

TEST(Traverse, HitsInDoubleAreThoseOfAllTriangles) {
    const Scene soup = make_soup(1000, 0.3, 5);
    if (!test_device().info.fp64) {
        EXPECT_THROW(RayDevice(test_device(), soup, BvhLayout::BVH8, Precision::DOUBLE).closest({}),
                     DeviceError);
        return;
    }
    expect_hits_of_all(soup, mixed_rays(soup, 20000, 5), Precision::DOUBLE);
}

// Every leaf's box touches the corners of its triangles, and no neighbour hides a box that was missed.
TEST(Traverse, CornersOfScatteredTrianglesAreFoundFromNearAndFar) {
    for (const double size : {0.02, 1e-4, 1e-6}) {
        const Scene scene = make_soup(1000, size, 6);
        Random random(6);
        std::vector<TestRay> rays;
        for (const double distance : {1.0, 10.0, 1000.0})
            for (int i = 0; i < 20000; ++i) {
                const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
                const glm::dvec3 target = corner_position(scene, triangle, int(random.word() % 3));
                rays.push_back(make_ray_to(random.direction() * (distance * random.unit()), target));
            }
        std::vector<TestHit> all;
        for (const BvhLayout layout : ALL_LAYOUTS) {
            const RayDevice device(test_device(), scene, layout);
            if (all.empty())
                all = device.closest_of_all(rays);
            EXPECT_EQ(count_differences(device.closest(rays), all), 0u) << size << ", " << name_of(layout);
        }
        EXPECT_GT(count_hits(all), rays.size() / 20);
    }
}

// A stack that forgets all but the latest children sends traversal back to the root again and again.
TEST(Traverse, ShortStacksOfBvh2GiveTheSameBits) {
    // Nested shells: behind each child that a ray enters, others wait on every level.
    Scene scene = make_soup(20000, 0.1, 10);
    for (int k = 0; k < 40; ++k)
        append_scene(scene, placed(make_soup(50, 0.5, unsigned(11 + k)), std::ldexp(1.0, -k), {0, 0, 0}));
    const std::vector<TestRay> rays = mixed_rays(scene, 50000, 10);
    const RayDevice wide(test_device(), scene, BvhLayout::BVH8);
    const std::vector<TestHit> expected = wide.closest(rays);
    const std::vector<u32> expected_any = wide.any(rays);
    EXPECT_GT(count_hits(expected), rays.size() / 2);
    for (const int entries : {1, 2, 4, 64}) {
        RayDeviceOptions options;
        options.layout = BvhLayout::BVH2;
        options.defines = {"BVH2_STACK_SIZE=" + std::to_string(entries)};
        const RayDevice device(test_device(), scene, options);
        EXPECT_GT(device.bvh().depth, 40);
        EXPECT_EQ(count_differences(device.closest(rays), expected), 0u) << entries;
        EXPECT_TRUE(device.any(rays) == expected_any) << entries;
    }
}

TEST(Traverse, LayoutsGiveTheSameBits) {
    const Scene soup = make_soup(100000, 0.03, 7);
    const std::vector<TestRay> rays = mixed_rays(soup, 500000, 7);
    const std::vector<TestHit> wide = RayDevice(test_device(), soup, BvhLayout::BVH8).closest(rays);
    for (const BvhLayout layout : {BvhLayout::BVH2, BvhLayout::CWBVH})
        EXPECT_EQ(count_differences(RayDevice(test_device(), soup, layout).closest(rays), wide), 0u)
            << name_of(layout);
    EXPECT_GT(count_hits(wide), rays.size() / 2);
}

/// Long thin triangles that cross each other in a twisted sheaf, where spatial splits pay.
Scene make_sheaf(int count, u32 seed) {
    Scene scene = make_empty_scene();
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const double x = random.unit(), y = random.unit();
        add_triangle(scene, {x, y, 0.0}, {y, 1 - x, 1.0}, {x + 1e-3, y, 0.0});
    }
    return scene;
}

TEST(Traverse, SpatialSplitsChangeNoBit) {
    const Scene scenes[] = {make_sheaf(4000, 9), make_sheaf(10000, 10)};
    for (const Scene& scene : scenes) {
        const std::vector<TestRay> rays = mixed_rays(scene, 40000, 9);
        for (const BvhLayout layout : ALL_LAYOUTS) {
            const RayDevice fast(test_device(), scene, layout),
                high(test_device(), scene, {layout, BvhQuality::HIGH});
            EXPECT_GT(high.bvh().reference_count, fast.bvh().reference_count);
            const std::vector<TestHit> hits = fast.closest(rays);
            EXPECT_EQ(count_differences(hits, high.closest(rays)), 0u) << name_of(layout);
            EXPECT_EQ(fast.any(rays), high.any(rays)) << name_of(layout);
            EXPECT_GT(count_hits(hits), rays.size() / 3);
        }
    }
}

TEST(Traverse, PartsOfTrianglesAreHitLikeTheWhole) {
    const Scene scene = make_sheaf(3000, 10);
    const std::vector<TestRay> rays = mixed_rays(scene, 20000, 10);
    std::vector<TestHit> all;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice high(test_device(), scene, {layout, BvhQuality::HIGH});
        const double least_growth = layout == BvhLayout::BVH8 ? 1.05 : 1.005;
        EXPECT_GT(double(high.bvh().reference_count), least_growth * double(high.bvh().triangle_count))
            << name_of(layout);
        if (all.empty())
            all = high.closest_of_all(rays);
        EXPECT_EQ(count_differences(high.closest(rays), all), 0u) << name_of(layout);
    }
}

TEST(Traverse, ARayEndsAtItsLengthAndTheEndBelongsToIt) {
    const Scene soup = make_soup(20000, 0.05, 8);
    const std::vector<TestRay> rays = mixed_rays(soup, 100000, 8);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), soup, layout);
        const std::vector<TestHit> hits = device.closest(rays);
        std::vector<TestRay> to_hit, short_of_hit;
        for (size_t i = 0; i < rays.size(); ++i) {
            to_hit.push_back(rays[i]);
            short_of_hit.push_back(rays[i]);
            const float t = float(hits[i].t);
            to_hit.back().origin.w = t;
            short_of_hit.back().origin.w = std::nextafter(t, 0.0f);
        }
        const std::vector<TestHit> at_end = device.closest(to_hit), before = device.closest(short_of_hit);
        const std::vector<u32> any = device.any(rays), any_at_end = device.any(to_hit);
        const std::vector<u32> any_before = device.any(short_of_hit);
        size_t wrong = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const u32 is_hit = hits[i].triangle != NO_INDEX;
            wrong += is_hit && at_end[i] != hits[i];
            wrong += before[i].triangle != NO_INDEX || any_before[i] != 0;
            wrong += any[i] != is_hit || any_at_end[i] != is_hit;
        }
        EXPECT_EQ(wrong, 0u) << name_of(layout);
        EXPECT_GT(count_hits(hits), rays.size() / 2);
    }
}

// Two parallel squares some units in the last place apart. The distance of each is off by a few roundings, so
// the nearer one must win from four units on.
TEST(Traverse, TheNearerOfTwoCloseSquaresIsHit) {
    for (const double t : {1.0, 37.0, 1e4})
        for (const int gap : {4, 5, 6, 7, 8, 16, 1000}) {
            float next = float(t);
            for (int i = 0; i < gap; ++i)
                next = std::nextafter(next, INFINITY);
            Scene scene = make_empty_scene();
            // The farther one comes first, so that a tie would show it.
            for (const double z : {double(next), double(float(t))}) {
                const u32 first = add_position(scene, {-t, -t, z});
                add_position(scene, {t, -t, z});
                add_position(scene, {t, t, z});
                add_position(scene, {-t, t, z});
                add_triangle(scene, first, first + 1, first + 2);
                add_triangle(scene, first, first + 2, first + 3);
            }
            Random random(9);
            std::vector<TestRay> rays;
            for (int i = 0; i < 10000; ++i)
                rays.push_back(
                    make_ray({0, 0, 0}, {random.between(-0.9, 0.9), random.between(-0.9, 0.9), 1}));
            for (const BvhLayout layout : ALL_LAYOUTS) {
                size_t wrong = 0;
                for (const TestHit& hit : RayDevice(test_device(), scene, layout).closest(rays))
                    wrong += hit.triangle != 2 && hit.triangle != 3;
                EXPECT_EQ(wrong, 0u) << gap << " units at " << t << ", " << name_of(layout);
            }
        }
}

} // namespace clrt
