// SPDX-License-Identifier: Apache-2.0
// The scene at time 1: which files are one motion, where vertices and normals go, what is refused.
#include "scene/mesh_motion.h"

#include "bvh/bvh.h"
#include "console/progress.h"
#include "error.h"
#include "options/options.h"
#include "scene/load_scene.h"
#include "scene/vectors.h"
#include "scene_support.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const MotionFiles FILES{"start.obj", "end.obj"};

/// Two triangles over a square, cut along either diagonal.
Mesh square(bool other_cut, double lift = 0) {
    Mesh mesh;
    mesh.positions = {{0, 0, lift}, {1, 0, lift}, {1, 1, lift}, {0, 1, lift}};
    const auto triangle = [](u32 a, u32 b, u32 c) {
        return MeshTriangle{{a, b, c}, {NO_INDEX, NO_INDEX, NO_INDEX}, {NO_INDEX, NO_INDEX, NO_INDEX}, 0, 0};
    };
    if (other_cut)
        mesh.triangles = {triangle(0, 1, 3), triangle(1, 2, 3)};
    else
        mesh.triangles = {triangle(0, 1, 2), triangle(0, 2, 3)};
    return mesh;
}

void move(Mesh& mesh, Mesh end, const glm::dvec2& shutter = {0, 1}) {
    NoticeList notices;
    add_motion(FILES, shutter, mesh, std::move(end), notices);
}

std::string refusal(Mesh start, const Mesh& end) {
    try {
        move(start, end);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "none";
}

class EndFrame : public testing::Test {
protected:
    EndFrame() {
        folder.write("s.mtl", "newmtl m\nKd 0.5 0.5 0.5\nnewmtl l\nKe 3 3 3\n");
        folder.write("s.obj", text(0, 0));
    }
    /// A floor, a screen that moves by `screen` and a lamp that moves by `lamp`.
    static std::string text(double screen, double lamp) {
        const auto vertex = [](double x, double y, double z) {
            return "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
        };
        return "mtllib s.mtl\nusemtl m\n" + vertex(-3, 0, -3) + vertex(3, 0, -3) + vertex(0, 0, 3) +
               "f 1 2 3\n" + vertex(screen, 1, 0) + vertex(screen + 1, 1, 0) + vertex(screen, 1, 1) +
               "f 4 5 6\nusemtl l\n" + vertex(lamp, 2, 0) + vertex(lamp, 2, 1) + vertex(lamp + 1, 2, 0) +
               "f 7 8 9\n";
    }
    Scene load(const std::string& end, const std::optional<glm::dvec2>& shutter = {}) const {
        Options options;
        options.scene.path = folder.path("s.obj");
        options.scene.end_path = folder.write("e.obj", end);
        options.camera.shutter = shutter;
        Progress progress(Toggle::OFF, true);
        return load_scene(options, progress);
    }
    TemporaryFolder folder;
};

} // namespace

TEST(MeshMotion, PositionsAreThoseOfTheShuttersTimes) {
    Mesh mesh = square(false);
    move(mesh, square(false, 4));
    EXPECT_EQ(mesh.positions[2], glm::dvec3(1, 1, 0));
    EXPECT_EQ(mesh.end_positions[2], glm::dvec3(1, 1, 4));
    mesh = square(false);
    move(mesh, square(false, 4), {0.25, 0.5});
    EXPECT_EQ(mesh.positions[2], glm::dvec3(1, 1, 1));
    EXPECT_EQ(mesh.end_positions[2], glm::dvec3(1, 1, 2));
    mesh = square(false);
    move(mesh, square(false, 4), {0.5, 0.5});
    EXPECT_EQ(mesh.positions[2], glm::dvec3(1, 1, 2));
    EXPECT_TRUE(mesh.end_positions.empty()) << "a closed shutter sees no motion";
}

TEST(MeshMotion, APolygonMayBeCutInAnotherWayAtTheEnd) {
    Mesh mesh = square(false);
    move(mesh, square(true, 4));
    EXPECT_EQ(mesh.triangles[0].v[2], 2u) << "the start's cut";
    EXPECT_EQ(mesh.end_positions[1].z, 4);
}

TEST(MeshMotion, OtherFilesAreRefusedWithTheFirstDifference) {
    Mesh other = square(false);
    other.positions.emplace_back(0, 0, 9);
    EXPECT_EQ(refusal(square(false), other), "end.obj: expected the 4 vertices of 'start.obj', found 5");
    other = square(false);
    other.triangles.pop_back();
    EXPECT_EQ(refusal(square(false), other), "end.obj: expected the 2 triangles of 'start.obj', found 1");
    other = square(false);
    other.normals.emplace_back(0, 0, 1);
    EXPECT_EQ(refusal(square(false), other), "end.obj: expected the 0 normals (vn) of 'start.obj', found 1");
    other = square(false);
    std::swap(other.triangles[1].v[1], other.triangles[1].v[2]);
    EXPECT_NE(refusal(square(false), other)
                  .find("found another as triangle 2: vertices 1, 4, 3 instead of 1, 3, 4"),
              std::string::npos)
        << refusal(square(false), other);
}

TEST(MeshMotion, SmoothingGroupsAreSmoothOnTheWholeWay) {
    // Flat at the start, a roof at the end: its normals turn from the plane's to the roof's.
    Mesh start = square(false), roof = square(false);
    start.smoothing = roof.smoothing = {1, 1};
    roof.positions[1].z = roof.positions[3].z = -0.5;
    move(start, roof);
    ASSERT_EQ(start.end_normals.size(), start.normals.size());
    for (const MeshTriangle& triangle : start.triangles)
        for (int k = 0; k < 3; ++k) {
            ASSERT_NE(triangle.n[k], NO_INDEX);
            EXPECT_EQ(start.normals[triangle.n[k]], glm::vec3(0, 0, 1));
        }
    EXPECT_NE(start.end_normals[start.triangles[0].n[1]], glm::vec3(0, 0, 1));
}

TEST_F(EndFrame, WhatMovesHasItsWayAndTheRestHasNone) {
    const Scene scene = load(text(2, 0));
    ASSERT_EQ(scene.position_moves.size(), scene.positions.size());
    for (u32 v = 0; v < 9; ++v) {
        const glm::dvec3 way = to_dvec3(scene.position_moves[v]) / scene.normalisation.scale;
        EXPECT_NEAR(way.x, v >= 3 && v < 6 ? 2 : 0, 1e-6) << v;
        EXPECT_EQ(way.y, 0);
    }
    ASSERT_EQ(scene.files.back().path.substr(scene.files.back().path.size() - 5), "s.mtl");
}

TEST_F(EndFrame, TheSameFileMovesNothing) {
    EXPECT_TRUE(load(text(0, 0)).position_moves.empty());
    EXPECT_TRUE(load(text(2, 0), glm::dvec2(0.5, 0.5)).position_moves.empty());
}

TEST_F(EndFrame, LampsThatMoveAreRefusedUnlessTheShutterIsClosed) {
    try {
        load(text(0, 1));
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what())
                      .find("e.obj: expected lamps that stand still while the shutter is open, "
                            "found triangle 3 of the emissive material \"l\" moving"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_TRUE(load(text(0, 1), glm::dvec2(1, 1)).position_moves.empty());
}

TEST_F(EndFrame, BoxesEncloseTheWholeWayAndLeavesKnowIt) {
    const Scene scene = load(text(2, 0));
    for (const BvhLayout layout : ALL_LAYOUTS)
        for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH}) {
            const Bvh bvh =
                build_bvh(scene.positions, scene.triangles, layout, quality, scene.position_moves);
            EXPECT_EQ(bvh.reference_count, bvh.triangle_count) << "no triangle is cut";
            ASSERT_EQ(bvh.leaf_moves.size(), bvh.leaves.size());
            const float way = float(2 * scene.normalisation.scale);
            size_t moving = 0;
            for (const u32 word : bvh.leaf_moves) {
                float value = 0;
                std::memcpy(&value, &word, sizeof value);
                moving += value == way;
            }
            EXPECT_GE(moving, 3u) << name_of(layout);
        }
    EXPECT_TRUE(build_bvh(scene.positions, scene.triangles, BvhLayout::BVH8).leaf_moves.empty());
}

} // namespace clrt
