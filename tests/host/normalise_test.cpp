// SPDX-License-Identifier: Apache-2.0
#include "scene/normalise.h"

#include "scene/assemble_geometry.h"
#include "scene_support.h"

#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

MeshTriangle mesh_triangle(u32 a, u32 b, u32 c) {
    return {{a, b, c}, {NO_INDEX, NO_INDEX, NO_INDEX}, {NO_INDEX, NO_INDEX, NO_INDEX}, 0, 0};
}

Mesh wedge(double scale) {
    Mesh mesh;
    mesh.positions = {glm::dvec3(0.1, 0.7, -3.3) * scale, glm::dvec3(1.3, 2.9, 0.3) * scale,
                      glm::dvec3(-4.1, 0.2, 8.8) * scale};
    mesh.triangles = {mesh_triangle(0, 1, 2)};
    return mesh;
}

Scene assembled(Mesh mesh) {
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
    for (double scale : {0.25, 1024., 0x1p-40, 0x1p100}) {
        const Scene other = assembled(wedge(scale));
        EXPECT_EQ(0, std::memcmp(one.positions.data(), other.positions.data(), 3 * sizeof(vec4))) << scale;
        EXPECT_EQ(one.extent, other.extent);
    }
}

TEST(Normalise, FarFromTheOriginPositionsKeepTheirDigits) {
    // 2^23 + k 2^-20 is exact in double and no float: what is left after centring is.
    const Scene near = assembled(wedge(1));
    Mesh mesh = wedge(1);
    for (glm::dvec3& p : mesh.positions)
        p = glm::dvec3(glm::round(p * 0x1p20)) * 0x1p-20;
    const Scene rounded = assembled(mesh);
    for (glm::dvec3& p : mesh.positions)
        p += glm::dvec3(0x1p23, -0x1p22, 0x1p20);
    const Scene far = assembled(mesh);
    EXPECT_EQ(0, std::memcmp(rounded.positions.data(), far.positions.data(), 3 * sizeof(vec4)));
    EXPECT_NEAR(near.positions[0].x, far.positions[0].x, 1e-6);
}

TEST(Normalise, LayersCountFromWhereFloatsResolveTheScene) {
    Normalisation frame;
    frame.scale = 0x1p-8;
    frame.centre = {278, 274.4, 279.6};
    EXPECT_EQ(position_origin(frame), glm::dvec3(0)) << "near the origin world units are kept";
    frame.centre += glm::dvec3(5.4e6, 0, 0);
    const glm::dvec3 origin = position_origin(frame);
    EXPECT_EQ(origin, glm::dvec3(256 * std::nearbyint(5400278 / 256.), 256, 256));
    for (int c = 0; c < 3; ++c)
        EXPECT_LE(std::fabs(frame.centre[c] - origin[c]), 128);
}

TEST(Normalise, PositionsThatNoTriangleUsesDoNotCount) {
    Mesh mesh = wedge(1);
    mesh.positions.push_back(glm::dvec3(1e30));
    mesh.positions.push_back(glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
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
    Mesh mesh = wedge(1);
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
        Mesh mesh = wedge(1);
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
    Mesh mesh = wedge(1);
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
    Mesh mesh = wedge(1);
    mesh.triangles.push_back(mesh_triangle(1, 1, 2));
    mesh.triangles.push_back(mesh_triangle(2, 1, 0));
    const Scene scene = assembled(mesh);
    ASSERT_EQ(scene.triangles.size(), 3u);
    EXPECT_EQ(scene.triangles[1].v0, 1u);
    EXPECT_EQ(scene.triangles[2].v0, 2u);
    EXPECT_EQ(scene.statistics.degenerate_triangles, 1u);
    EXPECT_EQ(count_notices(scene.notices, "1 triangles of zero area"), 1);
}
