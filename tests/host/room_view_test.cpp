// SPDX-License-Identifier: Apache-2.0
// What the eye in a room looks at.
#include "scene/room_view.h"

#include "probes/meshes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {
namespace {

/// Adds a box, its fronts outside or inside.
void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, bool faces_in) {
    const glm::dvec3 size = high - low;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool is_high : {false, true}) {
            glm::dvec3 u(0), v(0), corner = low;
            u[(axis + 1) % 3] = size[(axis + 1) % 3];
            v[(axis + 2) % 3] = size[(axis + 2) % 3];
            corner[axis] = (is_high ? high : low)[axis];
            if (is_high == faces_in)
                std::swap(u, v);
            add_triangle(scene, corner, corner + u, corner + u + v);
            add_triangle(scene, corner, corner + u + v, corner + v);
        }
}

} // namespace

TEST(RoomView, ALongRoomIsLookedAtWhereThingsAreInIt) {
    // A bathroom: basin, two panes of a shower and what stands in it, all at one end. Who stands among them
    // sees farthest, and a bare wall.
    Scene scene = make_empty_scene();
    scene.extent = 1;
    const auto metres = [&scene](const glm::dvec3& low, const glm::dvec3& high, bool faces_in = false) {
        const glm::dvec3 middle(1.25, 1.25, 1.5);
        add_box(scene, (low - middle) / 1.5, (high - middle) / 1.5, faces_in);
    };
    metres({0, 0, 0}, {2.5, 2.5, 3}, true);
    metres({0.4, 0.7, 0}, {1.4, 0.85, 0.5});
    metres({1.6, 0, 0.9}, {2.5, 2, 0.91});
    metres({1.59, 0, 0}, {1.6, 2, 0.9});
    metres({1.9, 0, 0.3}, {2.2, 0.3, 0.6});
    const auto grid = VoxelGrid::make(scene);
    ASSERT_TRUE(grid);
    const auto view = find_room_view(*grid, true, {0, 1, 0}, {0.577, 0.77});
    ASSERT_TRUE(view);
    EXPECT_LT(view->at.z, view->eye.z) << "towards the things";
    EXPECT_GT(view->eye.z, 0.2) << "from the other end";
}

} // namespace clrt
