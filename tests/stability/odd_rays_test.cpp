// SPDX-License-Identifier: Apache-2.0
// Rays that are not in general position: invalid ones, zeros in the direction, flat boxes, far and tiny
// targets.
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

constexpr float INFINITE = std::numeric_limits<float>::infinity();
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

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

size_t count_misses(const std::vector<TestHit>& hits) {
    return size_t(
        std::count_if(hits.begin(), hits.end(), [](const TestHit& h) { return h.triangle == NO_INDEX; }));
}

void expect_misses(const std::vector<TestRay>& rays, const char* name) {
    static const Scene ball = make_ball(24, 24);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(ball, layout);
        EXPECT_EQ(count_misses(device.closest(rays)), rays.size()) << name << ", " << layout_name(layout);
        const std::vector<u32> any = device.any(rays);
        EXPECT_EQ(size_t(std::count(any.begin(), any.end(), 0u)), rays.size())
            << name << ", " << layout_name(layout);
    }
}

void expect_hits_of_all(const Scene& scene, const std::vector<TestRay>& rays, const char* name) {
    std::vector<TestHit> all;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(scene, layout);
        if (all.empty())
            all = device.closest_of_all(rays);
        const std::vector<TestHit> found = device.closest(rays);
        size_t differences = 0;
        for (size_t i = 0; i < rays.size(); ++i)
            differences += found[i] != all[i];
        EXPECT_EQ(differences, 0u) << name << ", " << layout_name(layout);
    }
    EXPECT_LT(count_misses(all), rays.size() / 2) << name;
}

/// Cubes with corners on the lattice of quarters: their faces share planes, and so do the boxes of the tree.
Scene make_cubes() {
    Scene scene = make_empty_scene();
    for (int i = 0; i < 64; ++i) {
        const glm::dvec3 low(i % 4 * 0.5 - 1, i / 4 % 4 * 0.5 - 1, i / 16 * 0.5 - 1);
        append_scene(scene, make_room(low, low + 0.25));
    }
    return scene;
}

} // namespace

TEST(OddRays, RaysThatAreNotFiniteMiss) {
    const std::vector<float> bad = {NOT_A_NUMBER, -NOT_A_NUMBER, INFINITE, -INFINITE};
    for (const auto member : {&vec4::x, &vec4::y, &vec4::z}) {
        expect_misses(spoiled_rays(bad, member, &TestRay::origin), "origin");
        expect_misses(spoiled_rays(bad, member, &TestRay::direction), "direction");
    }
}

TEST(OddRays, RaysWithoutDirectionMiss) {
    std::vector<TestRay> rays;
    Random random(2);
    for (int i = 0; i < 8000; ++i) {
        TestRay ray = make_ray(random.in_cube(1), {0, 0, 1});
        ray.direction = {i & 1 ? 0.0f : -0.0f, i & 2 ? 0.0f : -0.0f, i & 4 ? 0.0f : -0.0f, 0};
        rays.push_back(ray);
    }
    expect_misses(rays, "no direction");
}

TEST(OddRays, RaysWithoutLengthMiss) {
    expect_misses(spoiled_rays({NOT_A_NUMBER, -NOT_A_NUMBER, 0.0f, -0.0f, -1.0f, -INFINITE}, &vec4::w,
                               &TestRay::origin),
                  "length");
}

// "Unbounded" by any name finds the same hits.
TEST(OddRays, AnInfiniteLengthIsAsGoodAsAFarOne) {
    const Scene ball = make_ball(24, 24);
    std::vector<TestRay> far = spoiled_rays({FAR_AWAY}, &vec4::w, &TestRay::origin), infinite = far;
    for (TestRay& ray : infinite)
        ray.origin.w = INFINITE;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(ball, layout);
        const std::vector<TestHit> expected = device.closest(far), found = device.closest(infinite);
        size_t differences = 0;
        for (size_t i = 0; i < far.size(); ++i)
            differences += expected[i].triangle != NO_INDEX && expected[i] != found[i];
        EXPECT_EQ(differences, 0u) << layout_name(layout);
    }
}

// Shadow rays are segments: their directions have the length of the way. Powers of two keep every bit.
TEST(OddRays, DirectionsOfAnyLengthGiveTheSameHits) {
    const Scene ball = make_ball(24, 24);
    const std::vector<TestRay> unit = spoiled_rays({FAR_AWAY}, &vec4::w, &TestRay::origin);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(ball, layout);
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
            EXPECT_EQ(differences, 0u) << exponent << ", " << layout_name(layout);
        }
    }
}

// The planes of the tree's boxes hold the origin, the direction, or both; zeros have either sign.
TEST(OddRays, RaysInThePlanesOfFacesHitWhatAllTrianglesGive) {
    const Scene cubes = make_cubes();
    Random random(3);
    const auto lattice = [&] { return 0.25 * (int(random.word() % 9) - 4); };
    const auto zero = [&] { return random.word() & 1 ? 0.0 : -0.0; };
    std::vector<TestRay> rays;
    for (int i = 0; i < 100000; ++i) {
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
    expect_hits_of_all(cubes, rays, "cubes");
}

// Inside a closed box, no ray within the plane of a wall or along an edge between two walls' diagonals gets
// out.
TEST(OddRays, RaysAlongAxesStayInABox) {
    const Scene room = make_room({-1, -1, -1}, {1, 1, 1});
    Random random(4);
    std::vector<TestRay> rays;
    for (int i = 0; i < 100000; ++i) {
        glm::dvec3 direction(0), origin = random.in_cube(0.999);
        direction[i % 3] = i & 1 ? 1 : -1;
        if (i % 5 == 0)
            origin[(i + 1) % 3] = origin[(i + 2) % 3]; // onto the diagonals of the walls
        if (i % 7 == 0)
            origin = {0, 0, 0};
        rays.push_back(make_ray(origin, direction));
    }
    for (const BvhLayout layout : ALL_LAYOUTS)
        EXPECT_EQ(count_misses(RayDevice(room, layout).closest(rays)), 0u) << layout_name(layout);
}

// All boxes of a flat grid have no thickness.
TEST(OddRays, AFlatGridIsHitWhereverItIsAimedAt) {
    constexpr int CELLS = 256;
    Scene grid = make_tilted_plane(CELLS);
    for (vec4& p : grid.positions)
        p = {p.x, 0.0f, p.y, 0.0f};
    Random random(5);
    std::vector<TestRay> rays;
    while (rays.size() < 250000) {
        const Triangle& triangle = grid.triangles[random.word() % grid.triangles.size()];
        const glm::dvec3 corner = corner_position(grid, triangle, int(random.word() % 3));
        const glm::dvec3 target =
            corner + (rays.size() % 2 ? glm::dvec3(0) : glm::dvec3(random.unit() / CELLS, 0, 0));
        if (std::max(std::abs(target.x), std::abs(target.z)) >= 1)
            continue; // on the rim a rounded ray may pass outside
        glm::dvec3 origin = random.in_cube(1);
        // A quarter stands exactly above its target.
        if (rays.size() % 4 == 1)
            origin.x = target.x, origin.z = target.z;
        rays.push_back(make_ray_to(origin, target));
    }
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const std::vector<TestHit> hits = RayDevice(grid, layout).closest(rays);
        EXPECT_EQ(count_misses(hits), 0u) << layout_name(layout);
        // Of the weighted depths 6 u, of the weights' sum 4 u, and of two quotients and a product 3 u where
        // divisions are exact, 11 u where they are within 2.5 units in the last place.
        const double limit = (test_device().info.correctly_rounded_division ? 13 : 21) * FLOAT_U;
        double worst = 0;
        for (size_t i = 0; i < hits.size(); ++i) {
            const double t = -double(rays[i].origin.y) / rays[i].direction.y;
            worst = std::max(worst, std::abs(hits[i].t - t) / t);
        }
        RecordProperty("worst_in_u", std::to_string(worst / FLOAT_U));
        EXPECT_LE(worst, limit) << layout_name(layout);
    }
}

// A ball that fills 1e-4 of the view is hit at the right distance.
TEST(OddRays, AFarSmallBallIsHitAtTheRightDistance) {
    const Scene ball = make_ball(24, 24);
    for (const double distance : {10.0, 100.0, 1e3, 1e4, 1e5}) {
        Random random(6);
        std::vector<TestRay> rays;
        std::vector<glm::dvec3> targets;
        while (rays.size() < 20000) {
            const Triangle& triangle = ball.triangles[random.word() % ball.triangles.size()];
            const glm::dvec3 target = corner_position(ball, triangle, int(random.word() % 3));
            const glm::dvec3 origin = to_dvec3(to_vec4(distance * random.direction()));
            // Away from the outline, where the rounding of the direction decides.
            if (glm::dot(target, glm::normalize(origin)) < 0.4)
                continue;
            rays.push_back(make_ray_to(origin, target));
            targets.push_back(target);
        }
        for (const BvhLayout layout : ALL_LAYOUTS) {
            const std::vector<TestHit> hits = RayDevice(ball, layout).closest(rays);
            EXPECT_EQ(count_misses(hits), 0u) << distance << ", " << layout_name(layout);
            double worst = 0;
            for (size_t i = 0; i < hits.size(); ++i) {
                // The rounded direction passes the target by up to 2 u distance, on a slope of up to 1 /
                // 0.35.
                const double t = glm::length(targets[i] - to_dvec3(rays[i].origin));
                worst = std::max(worst, std::abs(hits[i].t - t) / t);
            }
            EXPECT_LE(worst, 20 * FLOAT_U) << distance << ", " << layout_name(layout);
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
            const RayDevice device(ball, layout);
            all = device.closest_of_all(rays);
            const std::vector<TestHit> found = device.closest(rays);
            size_t differences = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                differences += found[i] != all[i];
            EXPECT_EQ(differences, 0u) << distance << ", " << layout_name(layout);
        }
        // A ray along an axis is exact at any distance.
        EXPECT_LE(count_misses(all), rays.size() / 2) << distance;
    }
}

} // namespace clrt
