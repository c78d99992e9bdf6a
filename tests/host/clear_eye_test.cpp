// SPDX-License-Identifier: Apache-2.0
// An eye on a surface is moved off it, to the side that it looks at; any other stays.
#include "scene/clear_eye.h"

#include "probes/meshes.h"
#include "scene/vectors.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {
namespace {

/// Floor y = 0, wall z = -1 and wall x = -1 of a room, each 2 wide, their fronts inside.
Scene room_corner() {
    Scene scene = make_empty_scene();
    const auto square = [&scene](const glm::dvec3& a, const glm::dvec3& u, const glm::dvec3& v) {
        const u32 first = add_position(scene, a);
        for (const glm::dvec3& p : {a + u, a + u + v, a + v})
            add_position(scene, p);
        add_triangle(scene, first, first + 1, first + 2);
        add_triangle(scene, first, first + 2, first + 3);
    };
    const glm::dvec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), corner(-1, 0, -1);
    square(corner, z, x);
    square(corner, x, y);
    square(corner, y, z);
    scene.material_names.assign(1, "plaster");
    return scene;
}

/// How the eye moves.
glm::dvec3 moved(const glm::dvec3& eye, const glm::dvec3& look, size_t notices = 1) {
    Scene scene = room_corner();
    scene.camera.eye = eye;
    scene.camera.at = eye + look;
    NoticeList list;
    clear_eye(scene, list);
    EXPECT_EQ(list.lines().size(), notices);
    const glm::dvec3 way = scene.camera.at - scene.camera.eye - look;
    EXPECT_LT(glm::length(way), 1e-12) << "the view turns";
    return scene.camera.eye - eye;
}

/// u (4 M + 24 E) of squares that are two wide and reach to 1 or 2.
constexpr double LEAST = 0x1p-24 * (4 + 24 * 2), MOST = 0x1p-24 * (4 * 2 + 24 * 2) * 1.001;

void expect_step(double x) {
    EXPECT_GE(x, LEAST);
    EXPECT_LE(x, MOST);
}

} // namespace

TEST(ClearEye, OnAFloorTheEyeIsAboveWhereTheViewRunsAlong) {
    for (const glm::dvec3& look : {glm::dvec3(0, 0, -1), glm::dvec3(1, 0.3, 0), glm::dvec3(1, -0.3, 0)}) {
        const glm::dvec3 move = moved({0.3, 0, 0.4}, look);
        expect_step(move.y);
        EXPECT_EQ(move.x, 0);
        EXPECT_EQ(move.z, 0);
    }
}

TEST(ClearEye, TheEyeIsOnTheSideToWhichItLooks) {
    expect_step(-moved({0.3, 0, 0.4}, {0, -1, 0.1}).y);
    expect_step(moved({0.3, 1, -1}, {0.2, 0, 1}).z);
    expect_step(-moved({0.3, 1, -1}, {0.2, 0, -1}).z);
}

TEST(ClearEye, InACornerTheEyeLeavesAllWalls) {
    const glm::dvec3 move = moved({-1, 0, -1}, {1, 0.5, 1});
    for (int axis = 0; axis < 3; ++axis)
        expect_step(move[axis]);
}

TEST(ClearEye, NearASurfaceItKeepsItsSide) {
    const glm::dvec3 above = moved({0.3, 1e-6, 0.4}, {0.1, -1, 0});
    expect_step(1e-6 + above.y);
    const glm::dvec3 below = moved({0.3, -1e-6, 0.4}, {0.1, 1, 0});
    expect_step(1e-6 - below.y);
}

TEST(ClearEye, ElsewhereTheEyeStays) {
    EXPECT_EQ(moved({0.3, 5e-6, 0.4}, {0, -1, 0.1}, 0), glm::dvec3(0));
    EXPECT_EQ(moved({3, 0, 0.4}, {0, 0, -1}, 0), glm::dvec3(0)) << "in the plane beside the floor";
    Scene scene = room_corner();
    scene.camera.eye = {0.3, 0, 0.4};
    scene.camera.end = CameraPose{{0.3, 1, 0.4}, {0, 0, 0}, {0, 1, 0}};
    NoticeList notices;
    clear_eye(scene, notices);
    EXPECT_EQ(scene.camera.eye, glm::dvec3(0.3, 0, 0.4)) << "a camera that moves";
    EXPECT_TRUE(notices.lines().empty());
}

} // namespace clrt
