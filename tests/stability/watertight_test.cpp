// SPDX-License-Identifier: Apache-2.0
// No ray passes through the seams of a closed mesh whose neighbours share edges but not their middles.
#include "probes/aimed_rays.h"
#include "support/test_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <map>
#include <string>

namespace clrt {
namespace {

constexpr size_t AIMED_RAYS = 50000;

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

void expect_no_misses(const Scene& scene, double inner, const std::string& name) {
    for (const Aim aim : {Aim::VERTEX, Aim::EDGE}) {
        const std::vector<TestRay> rays = aimed_rays(scene, inner, aim, AIMED_RAYS, 7);
        for (const BvhLayout layout : ALL_LAYOUTS)
            for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH}) {
                RayDeviceOptions options;
                options.layout = layout;
                options.quality = quality;
                EXPECT_EQ(count_misses(RayDevice(test_device(), scene, options).closest(rays)), 0u)
                    << "of " << AIMED_RAYS << " rays at " << (aim == Aim::EDGE ? "edges" : "vertices") << ", "
                    << name << ", " << name_of(layout) << (quality == BvhQuality::HIGH ? ", high" : ", fast");
            }
    }
}

} // namespace

// A ray's arithmetic rounds each corner on its own, so corners in line are no longer in line for it, and
// between the two sides of a seam a gap opens that only the triangle without area fills.
TEST(Watertight, TrianglesWithoutAreaCloseSeams) {
    expect_no_misses(with_seams(make_ball(24, 24)), BALL_INNER, "ball");
    expect_no_misses(with_seams(make_star(24, 24, 7)), STAR_INNER, "star");
}

} // namespace clrt
