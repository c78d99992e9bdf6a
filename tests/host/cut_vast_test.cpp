// SPDX-License-Identifier: Apache-2.0
// Vast triangles are cut near what is small, and nothing else about a scene changes.
#include "scene/cut_vast.h"

#include "probes/meshes.h"
#include "probes/scene_builder.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>

namespace clrt {
namespace {

/// The square [-1, 1]^2 in y = `height` and a small ball on it.
Scene ball_on_ground(double radius, double height = 0) {
    Scene scene = make_empty_scene();
    const u32 first = add_position(scene, {-1, height, -1});
    for (const glm::dvec3& p : {glm::dvec3(1, height, -1), {1, height, 1}, {-1, height, 1}})
        add_position(scene, p);
    add_triangle(scene, first, first + 2, first + 1);
    add_triangle(scene, first, first + 3, first + 2);
    for (const TestTriangle& t : icosphere_triangles({0.3 * radius, height + radius, 0}, radius, 2))
        add_triangle(scene, t.corners[0], t.corners[1], t.corners[2]);
    return scene;
}

double area(const Scene& scene) {
    double sum = 0;
    for (const Triangle& triangle : scene.triangles)
        sum += 0.5 * glm::length(triangle_normal(scene, triangle));
    return sum;
}

double extent(const Scene& scene, const Triangle& t) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 3; ++k)
            most = std::max(most, std::abs(corner_position(scene, t, k)[axis] -
                                           corner_position(scene, t, (k + 1) % 3)[axis]));
    return most;
}

/// Edges whose two sides do not belong to two triangles of opposite course, by corners' places.
size_t open_edges(const Scene& scene) {
    std::map<std::array<double, 6>, int> sides;
    for (const Triangle& triangle : scene.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a = corner_position(scene, triangle, k),
                             b = corner_position(scene, triangle, (k + 1) % 3);
            ++sides[{a.x, a.y, a.z, b.x, b.y, b.z}];
            --sides[{b.x, b.y, b.z, a.x, a.y, a.z}];
        }
    size_t open = 0;
    for (const auto& [edge, count] : sides)
        open += count != 0;
    return open / 2;
}

} // namespace

TEST(CutVast, PiecesNearSomethingSmallAreNotVast) {
    Scene scene = ball_on_ground(0x1p-20);
    const double before = area(scene);
    const size_t count = scene.triangles.size();
    const CutTriangles cut = cut_vast_triangles(scene);
    EXPECT_EQ(cut.vast, 2u);
    EXPECT_EQ(scene.triangles.size(), count + cut.added);
    EXPECT_LT(cut.added, 1000u);
    EXPECT_NEAR(area(scene), before, 1e-12 * before);
    size_t near = 0;
    for (const Triangle& triangle : scene.triangles)
        for (int k = 0; k < 3; ++k)
            if (glm::length(corner_position(scene, triangle, k)) < 0x1p-18) {
                ++near;
                EXPECT_LT(extent(scene, triangle), 2048 * 0x1p-20);
            }
    EXPECT_GT(near, 320u);
}

// Two walls and a floor that share edges: cut where they touch, in both alike.
TEST(CutVast, MeshesStayClosed) {
    Scene scene = make_room({-1, -1, -1}, {1, 1, 1});
    for (const TestTriangle& t : icosphere_triangles({0.1, -1 + 0x1p-18, 1 - 0x1p-18}, 0x1p-18, 1))
        add_triangle(scene, t.corners[0], t.corners[1], t.corners[2]);
    EXPECT_EQ(open_edges(scene), 0u);
    const CutTriangles cut = cut_vast_triangles(scene);
    EXPECT_GT(cut.vast, 3u);
    EXPECT_EQ(open_edges(scene), 0u);
}

// Their halves would have two equal corners. The line lies along the edge between the ground's triangles.
TEST(CutVast, LinesWithACornerInTheMiddleStayWhole) {
    Scene scene = ball_on_ground(0x1p-20);
    const u32 first = add_position(scene, {-1, 0, -1});
    add_position(scene, {1, 0, 1});
    add_position(scene, {0, 0, 0});
    add_triangle(scene, first, first + 1, first + 2);
    const Triangle line = scene.triangles.back();
    const size_t at = scene.triangles.size() - 1;
    cut_vast_triangles(scene);
    EXPECT_EQ(scene.triangles[at].v0, line.v0);
    EXPECT_EQ(scene.triangles[at].v1, line.v1);
    EXPECT_EQ(scene.triangles[at].v2, line.v2);
}

TEST(CutVast, TextureCoordinatesAndLabelsGoWithThePlace) {
    Scene scene = ball_on_ground(0x1p-16);
    for (u32 i = 0; i < 4; ++i) {
        scene.uvs.push_back(scene.positions[i].x * 2);
        scene.uvs.push_back(scene.positions[i].z - 1);
        scene.second_uvs.push_back(scene.positions[i].z + 1);
        scene.second_uvs.push_back(scene.positions[i].x * 4);
    }
    for (u32 i = 0; i < 2; ++i) {
        Triangle& t = scene.triangles[i];
        t.t0 = t.v0, t.t1 = t.v1, t.t2 = t.v2;
        t.material = 7, t.object = 3;
    }
    const size_t count = scene.triangles.size();
    ASSERT_GT(cut_vast_triangles(scene).added, 10u);
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        if (i >= 2 && i < count)
            continue;
        EXPECT_EQ(t.material, 7u);
        EXPECT_EQ(t.object, 3u);
        for (const auto& [v, uv] : {std::pair(t.v0, t.t0), {t.v1, t.t1}, {t.v2, t.t2}}) {
            EXPECT_EQ(scene.uvs[2 * uv], scene.positions[v].x * 2);
            EXPECT_EQ(scene.uvs[2 * uv + 1], scene.positions[v].z - 1);
            EXPECT_EQ(scene.second_uvs[2 * uv], scene.positions[v].z + 1);
            EXPECT_EQ(scene.second_uvs[2 * uv + 1], scene.positions[v].x * 4);
        }
    }
}

TEST(CutVast, OrdinaryScenesAndCurvedTrianglesStayAsTheyAre) {
    Scene room = make_room({-1, -1, -1}, {1, 1, 1});
    append_scene(room, placed(make_ball(24, 24), 0.3, {0, -0.5, 0}));
    EXPECT_EQ(cut_vast_triangles(room).added, 0u);
    // Triangles without extent are no features.
    Scene points = make_room({-1, -1, -1}, {1, 1, 1});
    add_triangle(points, {0, -1, 0}, {0, -1, 0}, {0, -1, 0});
    EXPECT_EQ(cut_vast_triangles(points).added, 0u);
    // Middles of normals would not be what the corners describe.
    Scene curved = ball_on_ground(0x1p-16);
    curved.normals = {{0, 1, 0, 0}, {0.6f, 0.8f, 0, 0}};
    for (u32 i = 0; i < 2; ++i) {
        curved.triangles[i].n0 = curved.triangles[i].n1 = 0;
        curved.triangles[i].n2 = 1;
    }
    EXPECT_EQ(cut_vast_triangles(curved).added, 0u);
    Scene nothing = make_empty_scene();
    EXPECT_EQ(cut_vast_triangles(nothing).added, 0u);
}

// A field of 40,000 small things does not cut its ground without end.
TEST(CutVast, TheNumberOfPiecesIsBounded) {
    Scene scene = ball_on_ground(1e-6);
    for (int i = 0; i < 40000; ++i) {
        const glm::dvec3 p(i % 200 * 0.01 - 1, 0, i / 200 * 0.01 - 1);
        add_triangle(scene, p, p + glm::dvec3(1e-7, 0, 0), p + glm::dvec3(0, 1e-7, 0));
    }
    EXPECT_LT(cut_vast_triangles(scene).added, 40000u);
}

} // namespace clrt
