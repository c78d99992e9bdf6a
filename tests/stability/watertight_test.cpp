// SPDX-License-Identifier: Apache-2.0
// No ray passes through a closed mesh, however exactly it is aimed at a vertex or an edge. Random rays prove
// nothing: they never come near one.
#include "support/meshes.h"
#include "support/random_inputs.h"
#include "support/ray_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
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
            for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH})
                EXPECT_EQ(count_misses(RayDevice(scene, {layout, quality, precision}).closest(rays)), 0u)
                    << "of " << count << " rays at " << (aim == Aim::EDGE ? "edges" : "vertices") << ", "
                    << name << ", " << layout_name(layout)
                    << (quality == BvhQuality::HIGH ? ", high" : ", fast");
    }
}

// 5 placements, with and without the loader's frame, vertices and edges: 2 million rays a mesh, layout and
// quality.
constexpr size_t AIMED_RAYS = 100000;

void expect_watertight_everywhere(const Scene& scene, double inner) {
    for (const Placement& placement : PLACEMENTS) {
        const Scene in_world = place(scene, placement);
        expect_no_misses(in_world, inner, std::string(placement.name) + " as it is", AIMED_RAYS);
        expect_no_misses(normalised(in_world), inner, std::string(placement.name) + " normalised",
                         AIMED_RAYS);
    }
}

/// The mesh with every edge cut in the middle on one side only, and the seams closed by triangles whose
/// corners are in line: so rounding leaves fine meshes behind. The mesh must be closed; its corners become
/// multiples of 2^-8, so that the middles are exact.
Scene with_seams(const Scene& closed) {
    Scene scene = make_empty_scene();
    std::map<std::array<double, 3>, u32> places;
    const auto corner = [&](const Triangle& triangle, int i) {
        const glm::dvec3 p = glm::round(corner_position(closed, triangle, i) * 256.0) / 256.0;
        const auto [place, is_new] = places.try_emplace({p.x, p.y, p.z}, u32(scene.positions.size()));
        return is_new ? add_position(scene, p) : place->second;
    };
    const auto middle = [&](u32 a, u32 b) {
        return add_position(scene, 0.5 * (to_dvec3(scene.positions[a]) + to_dvec3(scene.positions[b])));
    };
    for (const Triangle& triangle : closed.triangles) {
        u32 c[3] = {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
            continue;
        // Edges are cut where they ascend: one or two of three do. Turn the corners so that the first edge
        // does and the last does not.
        while (!(c[0] < c[1] && c[2] > c[0]))
            std::rotate(c, c + 1, c + 3);
        const u32 first = middle(c[0], c[1]);
        add_triangle(scene, c[0], c[1], first);
        if (c[1] < c[2]) {
            const u32 second = middle(c[1], c[2]);
            add_triangle(scene, c[1], c[2], second);
            add_triangle(scene, first, c[1], second);
            add_triangle(scene, c[0], first, second);
            add_triangle(scene, c[0], second, c[2]);
        } else {
            add_triangle(scene, c[0], first, c[2]);
            add_triangle(scene, first, c[1], c[2]);
        }
    }
    return scene;
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

// A ray's arithmetic rounds each corner on its own, so corners in line are no longer in line for it, and
// between the two sides of a seam a gap opens that only the triangle without area fills.
TEST(Watertight, TrianglesWithoutAreaCloseSeams) {
    expect_no_misses(with_seams(make_ball(24, 24)), BALL_INNER, "ball", AIMED_RAYS);
    expect_no_misses(with_seams(make_star(24, 24, 7)), STAR_INNER, "star", AIMED_RAYS);
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
