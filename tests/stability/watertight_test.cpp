// SPDX-License-Identifier: Apache-2.0
// No ray passes through a closed mesh, however exactly it is aimed at a vertex or an edge. Random rays prove
// nothing: they never come near one.
#include "support/meshes.h"
#include "support/random_inputs.h"
#include "support/ray_device.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <string>

namespace clrt {
namespace {

/// How large a mesh of radius 1 is made, and how far from the origin it is put.
struct Placement {
    const char* name;
    double size;
    double distance;
};

constexpr Placement PLACEMENTS[] = {
    {"1@0", 1, 0}, {"2@2.6e5", 2, 2.6e5}, {"1e-6@0", 1e-6, 0}, {"1e7@0", 1e7, 0}, {"1@1e4", 1, 1e4}};

// The place where Embree tests its own: no axis is special there.
const glm::dvec3 AWAY = glm::normalize(glm::dvec3(148376, 1234, -223423));

Scene place(const Scene& scene, const Placement& placement) {
    return placed(scene, placement.size, AWAY * placement.distance);
}

enum class Aim { VERTEX, EDGE };

/// Rays from the inner 40 % of a star-shaped mesh to its vertices or to points of its edges. `inner` is the
/// radius of the ball that the mesh encloses, over the smallest half edge of its box.
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

size_t count_misses(const std::vector<TestHit>& hits) {
    size_t misses = 0;
    for (const TestHit& hit : hits)
        misses += hit.triangle == NO_INDEX;
    return misses;
}

void expect_no_misses(const Scene& scene, double inner, const std::string& name, size_t count,
                      Precision precision = Precision::SINGLE) {
    for (const Aim aim : {Aim::VERTEX, Aim::EDGE}) {
        const std::vector<TestRay> rays = aimed_rays(scene, inner, aim, count, 7);
        for (const BvhLayout layout : ALL_LAYOUTS)
            EXPECT_EQ(count_misses(RayDevice(scene, layout, precision).closest(rays)), 0u)
                << "of " << count << " rays at " << (aim == Aim::EDGE ? "edges" : "vertices") << ", " << name
                << ", " << layout_name(layout);
    }
}

// 5 placements, with and without the loader's frame, vertices and edges: 2 million rays a mesh and layout.
constexpr size_t AIMED_RAYS = 100000;

void expect_watertight_everywhere(const Scene& scene, double inner) {
    for (const Placement& placement : PLACEMENTS) {
        const Scene in_world = place(scene, placement);
        expect_no_misses(in_world, inner, std::string(placement.name) + " as it is", AIMED_RAYS);
        expect_no_misses(normalised(in_world), inner, std::string(placement.name) + " normalised",
                         AIMED_RAYS);
    }
}

// The largest distance of a spike's tip is 6 times that of the ball inside.
constexpr double BALL_INNER = 0.95, STAR_INNER = 0.95 / 6;

} // namespace

TEST(Watertight, ABallHoldsRaysAimedAtItsVerticesAndEdges) {
    expect_watertight_everywhere(make_ball(24, 24), BALL_INNER);
}

TEST(Watertight, AStarHoldsRaysAimedAtItsVerticesAndEdges) {
    expect_watertight_everywhere(make_star(24, 24, 5), STAR_INNER);
}

TEST(Watertight, InDoubleToo) {
    const Scene star = make_star(24, 24, 6);
    if (!test_device().info.fp64) {
        EXPECT_THROW(RayDevice(star, BvhLayout::BVH8, Precision::DOUBLE).closest({}), DeviceError);
        return;
    }
    for (const Placement& placement : PLACEMENTS)
        expect_no_misses(place(star, placement), STAR_INNER, placement.name, 20000, Precision::DOUBLE);
}

} // namespace clrt
