// SPDX-License-Identifier: Apache-2.0
#include "scene/normalise.h"

#include "scene/assemble_geometry.h"
#include "scene_support.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

ObjTriangle obj_triangle(u32 a, u32 b, u32 c) {
    return {{a, b, c}, {NO_INDEX, NO_INDEX, NO_INDEX}, {NO_INDEX, NO_INDEX, NO_INDEX}, 0, 0};
}

ObjMesh wedge(float scale) {
    ObjMesh mesh;
    mesh.positions = {glm::vec3(0.1f, 0.7f, -3.3f) * scale, glm::vec3(1.3f, 2.9f, 0.3f) * scale,
                      glm::vec3(-4.1f, 0.2f, 8.8f) * scale};
    mesh.triangles = {obj_triangle(0, 1, 2)};
    return mesh;
}

Scene assembled(ObjMesh mesh) {
    Scene scene;
    NoticeList notices;
    const Bounds bounds = bounds_of_triangles(mesh);
    scene.normalisation = fit_normalisation(bounds);
    assemble_geometry(mesh, bounds, scene.normalisation, "test.obj", scene, notices);
    scene.notices = notices.lines();
    return scene;
}

} // namespace

TEST(Normalise, HalfDiagonalIsBetweenOneAndTwoForEverySize) {
    for (double size = 1e-40; size < 1e38; size *= 3.7) {
        const Bounds bounds{glm::dvec3(5 * size), glm::dvec3(6 * size, 7 * size, 5 * size)};
        const Normalisation frame = fit_normalisation(bounds);
        EXPECT_GE(bounds.radius() * frame.scale, 1) << size;
        EXPECT_LT(bounds.radius() * frame.scale, 2) << size;
        int exponent = 0;
        EXPECT_EQ(std::frexp(frame.scale, &exponent), 0.5) << "no power of two at " << size;
        EXPECT_EQ(to_normalised(frame, bounds.centre()), glm::dvec3(0));
    }
}

TEST(Normalise, ARadiusOfExactlyOneKeepsScaleOne) {
    EXPECT_EQ(fit_normalisation({glm::dvec3(-1, 0, 0), glm::dvec3(1, 0, 0)}).scale, 1);
    EXPECT_EQ(fit_normalisation({glm::dvec3(-2, 0, 0), glm::dvec3(2, 0, 0)}).scale, 0.5);
}

TEST(Normalise, ASinglePointGetsScaleOne) {
    const Normalisation frame = fit_normalisation({glm::dvec3(3), glm::dvec3(3)});
    EXPECT_EQ(frame.scale, 1);
    EXPECT_EQ(to_normalised(frame, glm::dvec3(3)), glm::dvec3(0));
}

TEST(Normalise, ScalingByAPowerOfTwoChangesNoBit) {
    const Scene one = assembled(wedge(1));
    for (float scale : {0.25f, 1024.f, std::ldexp(1.f, -40), std::ldexp(1.f, 100)}) {
        const Scene other = assembled(wedge(scale));
        EXPECT_EQ(0, std::memcmp(one.positions.data(), other.positions.data(), 3 * sizeof(vec4))) << scale;
        EXPECT_EQ(one.extent, other.extent);
    }
}

TEST(Normalise, PositionsThatNoTriangleUsesDoNotCount) {
    ObjMesh mesh = wedge(1);
    mesh.positions.push_back(glm::vec3(1e30f));
    mesh.positions.push_back(glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    const Scene scene = assembled(mesh);
    EXPECT_EQ(scene.normalisation.scale, assembled(wedge(1)).normalisation.scale);
    EXPECT_EQ(scene.positions[4].x, 0) << "a position that is not finite must not reach the device";
}

TEST(AssembleGeometry, ExtentIsTheLargestCoordinate) {
    const Scene scene = assembled(wedge(1));
    float largest = 0;
    for (const vec4& p : scene.positions)
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    EXPECT_EQ(scene.extent, largest);
}

TEST(AssembleGeometry, NormalsBecomeUnitVectors) {
    ObjMesh mesh = wedge(1);
    mesh.normals = {glm::vec3(0, 0, 5), glm::vec3(1e-30f, 0, 0), glm::vec3(3e38f, 3e38f, 0)};
    mesh.triangles[0].n[0] = 0, mesh.triangles[0].n[1] = 1, mesh.triangles[0].n[2] = 2;
    const Scene scene = assembled(mesh);
    EXPECT_EQ(scene.normals[0].z, 1);
    EXPECT_EQ(scene.normals[1].x, 1);
    EXPECT_NEAR(scene.normals[2].x, std::sqrt(0.5), 1e-7);
    EXPECT_EQ(scene.triangles[0].n2, 2u);
    EXPECT_TRUE(scene.notices.empty());
}

TEST(AssembleGeometry, ATriangleWithABrokenNormalIsFlat) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const glm::vec3& broken : {glm::vec3(0), glm::vec3(nan, 0, 1), glm::vec3(INFINITY, 0, 0)}) {
        ObjMesh mesh = wedge(1);
        mesh.normals = {glm::vec3(0, 0, 1), broken};
        mesh.triangles[0].n[0] = 0, mesh.triangles[0].n[1] = 1, mesh.triangles[0].n[2] = 0;
        const Scene scene = assembled(mesh);
        EXPECT_EQ(scene.triangles[0].n0, NO_INDEX);
        EXPECT_EQ(scene.triangles[0].n1, NO_INDEX);
        EXPECT_EQ(scene.triangles[0].n2, NO_INDEX);
        EXPECT_EQ(count_notices(scene.notices, "1 triangles with a zero, infinite or missing vn"), 1);
    }
}

TEST(AssembleGeometry, TextureCoordinatesAreForAllCornersOrNone) {
    ObjMesh mesh = wedge(1);
    mesh.uvs = {glm::vec2(0.25f, 0.5f), glm::vec2(INFINITY, 0)};
    mesh.triangles.push_back(mesh.triangles[0]);
    mesh.triangles.push_back(mesh.triangles[0]);
    for (u32& t : mesh.triangles[0].t)
        t = 0;
    mesh.triangles[1].t[0] = 0; // the other two corners have none
    for (u32& t : mesh.triangles[2].t)
        t = 1;
    const Scene scene = assembled(mesh);
    EXPECT_EQ(scene.triangles[0].t1, 0u);
    EXPECT_EQ(scene.uvs[1], 0.5f);
    EXPECT_EQ(scene.triangles[1].t0, NO_INDEX);
    EXPECT_EQ(scene.triangles[2].t0, NO_INDEX);
    EXPECT_EQ(count_notices(scene.notices, "2 triangles with an infinite or missing vt"), 1);
}

TEST(AssembleGeometry, TrianglesKeepTheirOrderAndDegenerateOnesAreCounted) {
    ObjMesh mesh = wedge(1);
    mesh.triangles.push_back(obj_triangle(1, 1, 2));
    mesh.triangles.push_back(obj_triangle(2, 1, 0));
    const Scene scene = assembled(mesh);
    ASSERT_EQ(scene.triangles.size(), 3u);
    EXPECT_EQ(scene.triangles[1].v0, 1u);
    EXPECT_EQ(scene.triangles[2].v0, 2u);
    EXPECT_EQ(scene.statistics.degenerate_triangles, 1u);
    EXPECT_EQ(count_notices(scene.notices, "1 triangles of zero area"), 1);
}
