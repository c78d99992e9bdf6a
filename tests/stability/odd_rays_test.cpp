// SPDX-License-Identifier: Apache-2.0
// Rays of unusual length and from afar. More is in the catalogue
// (tools/stability/cases/intersection_cases.cpp).
#include "probes/aimed_rays.h"
#include "support/test_device.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace clrt {
namespace {

constexpr float INFINITE = std::numeric_limits<float>::infinity();

/// Valid rays towards the origin with one component replaced.
std::vector<TestRay> spoiled_rays(const std::vector<float>& values, float vec4::*member,
                                  vec4 TestRay::*part) {
    Random random(1);
    std::vector<TestRay> rays;
    for (int i = 0; i < 1000; ++i)
        for (const float value : values) {
            TestRay ray = make_ray_to(random.in_cube(3), random.in_cube(0.5));
            ray.*part.*member = value;
            rays.push_back(ray);
        }
    return rays;
}

} // namespace

// "Unbounded" by any name finds the same hits.
TEST(OddRays, AnInfiniteLengthIsAsGoodAsAFarOne) {
    const Scene ball = make_ball(24, 24);
    std::vector<TestRay> far = spoiled_rays({FAR_AWAY}, &vec4::w, &TestRay::origin), infinite = far;
    for (TestRay& ray : infinite)
        ray.origin.w = INFINITE;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), ball, layout);
        const std::vector<TestHit> expected = device.closest(far), found = device.closest(infinite);
        size_t differences = 0;
        for (size_t i = 0; i < far.size(); ++i)
            differences += expected[i].triangle != NO_INDEX && expected[i] != found[i];
        EXPECT_EQ(differences, 0u) << name_of(layout);
    }
}

// Shadow rays are segments: their directions have the length of the way. Powers of two keep every bit.
TEST(OddRays, DirectionsOfAnyLengthGiveTheSameHits) {
    const Scene ball = make_ball(24, 24);
    const std::vector<TestRay> unit = spoiled_rays({FAR_AWAY}, &vec4::w, &TestRay::origin);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), ball, layout);
        const std::vector<TestHit> expected = device.closest(unit);
        for (const int exponent : {-20, -3, 1, 20}) {
            const float scale = std::ldexp(1.0f, exponent);
            std::vector<TestRay> scaled = unit;
            for (TestRay& ray : scaled)
                ray.direction = {ray.direction.x * scale, ray.direction.y * scale, ray.direction.z * scale,
                                 0};
            std::vector<TestHit> found = device.closest(scaled);
            size_t differences = 0;
            for (size_t i = 0; i < found.size(); ++i) {
                if (found[i].triangle != NO_INDEX)
                    found[i].t *= scale;
                differences += found[i] != expected[i];
            }
            EXPECT_EQ(differences, 0u) << exponent << ", " << name_of(layout);
        }
    }
}

// However far the origin is, the tree finds what all triangles give.
TEST(OddRays, RaysFromAfarHitWhatAllTrianglesGive) {
    const Scene ball = make_ball(12, 12);
    for (const double distance : {1e6, 1e9, 1e12, 1e15}) {
        Random random(7);
        std::vector<TestRay> rays;
        for (int i = 0; i < 10000; ++i) {
            const glm::dvec3 direction = i % 2 ? random.direction() : glm::dvec3(i % 4 ? 1 : -1, 0, 0);
            rays.push_back(make_ray_to(direction * distance, {0, 0, 0}));
        }
        std::vector<TestHit> all;
        for (const BvhLayout layout : ALL_LAYOUTS) {
            const RayDevice device(test_device(), ball, layout);
            all = device.closest_of_all(rays);
            const std::vector<TestHit> found = device.closest(rays);
            size_t differences = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                differences += found[i] != all[i];
            EXPECT_EQ(differences, 0u) << distance << ", " << name_of(layout);
        }
        // A ray along an axis is exact at any distance.
        EXPECT_LE(count_misses(all), rays.size() / 2) << distance;
    }
}

} // namespace clrt
