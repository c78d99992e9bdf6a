// SPDX-License-Identifier: Apache-2.0
// geometry/instance.h: a ray meets an instance where it meets the instance's triangles written out, to the
// last bit, whatever the map, in every layout; and no ray gets through its seams.
#include "probes/aimed_rays.h"
#include "probes/meshes.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"
#include "support/test_device.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <string>

namespace clrt {
namespace {

constexpr EffectMask EFFECTS = EFFECT_INSTANCES;

glm::dmat4 turned(double angle, const glm::dvec3& place, const glm::dvec3& scale) {
    const glm::dmat4 turn =
        glm::rotate(glm::translate(glm::dmat4(1), place), angle, glm::normalize(glm::dvec3(1, 2, -3)));
    return glm::scale(turn, scale);
}

/// A map that slants what it places.
glm::dmat4 sheared(const glm::dvec3& place) {
    glm::dmat4 map = turned(2, place, glm::dvec3(0.2));
    map[1] += 0.7 * map[0];
    map[2] -= 1.5 * map[1];
    return map;
}

/// Balls of all sizes in and around a soup: turned, mirrored, stretched, sheared, one in the other.
Scene scene_of_instances() {
    Scene scene = make_soup(300, 0.2, 1);
    add_instances(scene, make_ball(12, 10),
                  {turned(0.3, {0.5, 0.4, 0}, glm::dvec3(0.4)), turned(1, {-0.6, 0, 0.1}, {-0.3, 0.3, 0.3}),
                   turned(1, {-0.6, 0, 0.1}, glm::dvec3(1e-3)), turned(4, {0, -0.5, 0.3}, {0.5, 0.01, 0.2}),
                   sheared({0.1, 0.2, -0.3})});
    // A prototype a thousand times larger than the scene, and one far from its frame's origin.
    add_instances(scene, placed(make_soup(300, 0.3, 2), 1e3, {0, 0, 0}),
                  {turned(2, {0, 0, 0}, glm::dvec3(1e-3)), turned(5, {0.3, 0, 0}, glm::dvec3(-4e-4))});
    return scene;
}

/// Where the triangle of a hit is among those written out.
TestHit in_written_out(const Scene& scene, TestHit hit) {
    if (hit.triangle == NO_INDEX || hit.instance == 0)
        return hit;
    u32 first = u32(own_triangle_count(scene.triangles, scene.prototypes));
    for (u32 i = 1; i < hit.instance; ++i)
        first += scene.prototypes[scene.instances[i].prototype].triangle_count;
    hit.triangle += first - scene.prototypes[scene.instances[hit.instance].prototype].first_triangle;
    hit.instance = 0;
    return hit;
}

std::vector<TestHit> in_written_out(const Scene& scene, std::vector<TestHit> hits) {
    for (TestHit& hit : hits)
        hit = in_written_out(scene, hit);
    return hits;
}

RayDeviceOptions options_of(BvhLayout layout, const Scene& all, EffectMask effects = EFFECTS,
                            Precision precision = Precision::SINGLE) {
    RayDeviceOptions options;
    options.layout = layout;
    options.effects = effects;
    options.precision = precision;
    options.extent = extent_of(all);
    return options;
}

/// Rays at triangles, at their corners, and past them.
std::vector<TestRay> rays_for(const Scene& all) {
    return rays_at(all, 20000, 3);
}

void expect_hits_of_written_out(Precision precision) {
    const Scene scene = scene_of_instances(), all = written_out(scene);
    const std::vector<TestRay> rays = rays_for(all);
    const RayDevice reference(test_device(), all, options_of(BvhLayout::BVH8, all, 0, precision));
    const std::vector<TestHit> expected = reference.closest_of_all(rays);
    const std::vector<u32> expected_any = reference.any(rays);
    EXPECT_LT(count_misses(expected), rays.size() / 2);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), scene, options_of(layout, all, EFFECTS, precision));
        const std::vector<TestHit> hits = device.closest(rays);
        EXPECT_EQ(count_differences(in_written_out(scene, hits), expected), 0u)
            << "of " << rays.size() << " rays, " << name_of(layout);
        EXPECT_TRUE(device.any(rays) == expected_any) << name_of(layout);
    }
}

} // namespace

TEST(Instance, HitsAreThoseOfItsTrianglesWrittenOut) {
    expect_hits_of_written_out(Precision::SINGLE);
}

TEST(Instance, HitsInDoubleAreTheSameTriangles) {
    if (!test_device().info.fp64)
        GTEST_SKIP() << "no fp64";
    // Corners that are written out are floats, and those of instances are not.
    const Scene scene = scene_of_instances(), all = written_out(scene);
    const std::vector<TestRay> rays = rays_for(all);
    const std::vector<TestHit> expected =
        RayDevice(test_device(), all, options_of(BvhLayout::BVH8, all, 0, Precision::DOUBLE)).closest(rays);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const RayDevice device(test_device(), scene, options_of(layout, all, EFFECTS, Precision::DOUBLE));
        const std::vector<TestHit> hits = in_written_out(scene, device.closest(rays));
        size_t others = 0;
        for (size_t i = 0; i < hits.size(); ++i)
            others += hits[i].triangle != expected[i].triangle;
        EXPECT_LT(others, rays.size() / 2 + rays.size() / 100) << name_of(layout); // half aim at corners
        for (size_t i = 0; i < hits.size(); ++i)
            if (hits[i].triangle == expected[i].triangle && hits[i].triangle != NO_INDEX) {
                ASSERT_NEAR(hits[i].t, expected[i].t, 1e-2) << i;
            }
    }
}

TEST(Instance, EveryHitOnARayIsFoundOnceInOrder) {
    const Scene scene = scene_of_instances(), all = written_out(scene);
    const std::vector<TestRay> rays = rays_for(all);
    const auto expected =
        RayDevice(test_device(), all, options_of(BvhLayout::BVH8, all, EFFECT_CUT_OUT)).layers(rays);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const auto found =
            RayDevice(test_device(), scene, options_of(layout, all, EFFECTS | EFFECT_CUT_OUT)).layers(rays);
        size_t differences = 0;
        for (size_t i = 0; i < rays.size(); ++i)
            differences += found[i].size() != expected[i].size();
        EXPECT_EQ(differences, 0u) << name_of(layout);
    }
}

TEST(Instance, SurfacesAreThoseOfItsTrianglesWrittenOut) {
    const Scene scene = scene_of_instances(), all = written_out(scene);
    const RayDevice device(test_device(), scene, options_of(BvhLayout::BVH8, all));
    const RayDevice reference(test_device(), all, options_of(BvhLayout::BVH8, all, 0));
    std::vector<TestRay> rays;
    std::vector<TestHit> hits;
    const std::vector<TestRay> tried = rays_for(all);
    const std::vector<TestHit> found = device.closest(tried);
    for (size_t i = 0; i < tried.size(); ++i)
        if (found[i].triangle != NO_INDEX) {
            rays.push_back(tried[i]);
            hits.push_back(found[i]);
        }
    const std::vector<TestHit> there = in_written_out(scene, hits);
    const std::vector<vec4> normals = device.normals(rays, hits),
                            expected_normals = reference.normals(rays, there);
    const std::vector<TestPoint> points = device.points(rays, hits),
                                 expected_points = reference.points(rays, there);
    const std::vector<u32> fronts = device.fronts(rays, hits),
                           expected_fronts = reference.fronts(rays, there);
    size_t instances = 0, mirrored = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        instances += hits[i].instance != 0;
        // What is written out keeps its winding, which a mirror turns round.
        const bool is_mirrored = hits[i].instance != 0 && scene.instances[hits[i].instance].side < 0;
        mirrored += is_mirrored;
        EXPECT_EQ(fronts[i] != expected_fronts[i], is_mirrored) << i;
        EXPECT_EQ(to_dvec3(normals[i]), to_dvec3(expected_normals[i])) << i;
        EXPECT_EQ(normals[i].w, expected_normals[i].w) << i;
        EXPECT_EQ(points[i].position, expected_points[i].position) << i;
    }
    EXPECT_GT(instances, rays.size() / 5);
    EXPECT_GT(mirrored, rays.size() / 50);
}

// From inside, at shared edges and corners.
TEST(Instance, NoAimedRayGetsThroughItsSeams) {
    const glm::dmat4 maps[] = {
        turned(0.7, {0, 0, 0}, glm::dvec3(1)), turned(0.7, {0.2, 0.1, -0.3}, glm::dvec3(-1e-3, 1e-3, 1e-3)),
        turned(2.7, {100, -30, 20}, glm::dvec3(1)), turned(1.7, {0, 0, 0}, glm::dvec3(1e3)),
        turned(3.7, {-0.2, 0.4, 0.3}, glm::dvec3(1, 0.5, 0.7))};
    size_t rays_aimed = 0, lost = 0;
    for (const glm::dmat4& map : maps)
        for (const bool is_star : {false, true}) {
            Scene scene = make_empty_scene();
            add_instances(scene, is_star ? make_star(24, 24, 7) : make_ball(24, 24), {map});
            const Scene all = written_out(scene);
            for (const Aim aim : {Aim::VERTEX, Aim::EDGE}) {
                const std::vector<TestRay> rays =
                    aimed_rays(all, 0.4 * (is_star ? STAR_INNER : BALL_INNER), aim, 10000, 7);
                for (const BvhLayout layout : ALL_LAYOUTS) {
                    const RayDevice device(test_device(), scene, options_of(layout, all));
                    const size_t misses = count_misses(device.closest(rays));
                    EXPECT_EQ(misses, 0u) << name_of(layout) << " " << map[3][0];
                    rays_aimed += rays.size();
                    lost += misses;
                }
            }
        }
    RecordProperty("aimed", int(rays_aimed));
    RecordProperty("lost", int(lost));
}

} // namespace clrt
