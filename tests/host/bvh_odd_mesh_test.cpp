// SPDX-License-Identifier: Apache-2.0
// Meshes that are hard on tree builders: time stays near that of an ordinary mesh of the same size, depth
// within the traversal's stack.
#include "host/bvh_support.h"

#include <ctime>
#include <gtest/gtest.h>

namespace clrt {
namespace {

constexpr int MILLION = 1000000;
constexpr int COUNT = 200000; // where the number is not the point
// So many times as long as an ordinary mesh: far above noise, far below quadratic time (a million triangles).
constexpr double MOST_TIME_RATIO = 12;

/// Processor seconds of all threads: the machine may be busy with other work.
double build_seconds(const Mesh& mesh, BvhQuality quality, Bvh& bvh) {
    const std::clock_t start = std::clock();
    bvh = build_bvh(mesh.positions, mesh.triangles, BvhLayout::BVH8, quality);
    return double(std::clock() - start) / CLOCKS_PER_SEC;
}

// What a triangle of an ordinary mesh takes: unconnected triangles about as large as their distances.
double ordinary_seconds(BvhQuality quality) {
    static const Mesh mesh = random_soup(MILLION / 2, 0.01f, 6);
    static double seconds[2] = {};
    double& s = seconds[quality == BvhQuality::HIGH];
    Bvh bvh;
    if (s == 0)
        s = build_seconds(mesh, quality, bvh) / double(mesh.triangles.size());
    return s;
}

void expect_ordinary_time(const Mesh& mesh, int most_depth = BVH_MAX_DEPTH) {
    for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH}) {
        SCOPED_TRACE(quality == BvhQuality::HIGH ? "high" : "fast");
        Bvh bvh;
        const double seconds = build_seconds(mesh, quality, bvh);
        EXPECT_LT(seconds, MOST_TIME_RATIO * ordinary_seconds(quality) * double(mesh.triangles.size()));
        EXPECT_LE(bvh.depth, most_depth);
        EXPECT_GE(bvh.triangle_count,
                  mesh.triangles.size() * 9 / 10); // a ball has triangles without area at its poles
        EXPECT_LE(double(bvh.reference_count), 1.5 * double(bvh.triangle_count));
    }
}

TEST(BvhOddMesh, MillionCoincidentTriangles) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0.5f, 0}};
    for (int i = 0; i < MILLION; ++i)
        mesh.add(0, 1, 2);
    expect_ordinary_time(mesh, 22); // balanced: log2 of a million and a level or two
}

TEST(BvhOddMesh, EqualCentres) {
    // Triangles of all sizes around one point: no object split, and spatial splits that cut all of them.
    Mesh mesh;
    std::mt19937 random(2);
    std::uniform_int_distribution<int> steps(1, 1 << 20);
    for (int i = 0; i < COUNT; ++i) {
        const float x = std::ldexp(float(steps(random)), -20), y = std::ldexp(float(steps(random)), -20);
        mesh.add({-x, -y, -x, 0}, {x, y, x, 0}, {x, -y, -x, 0});
    }
    expect_ordinary_time(mesh);
}

TEST(BvhOddMesh, Slivers) {
    Mesh mesh;
    std::mt19937 random(9);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < COUNT; ++i) {
        const float x = uniform(random), y = uniform(random), z = uniform(random);
        mesh.add({x, y, z, 0}, {x + 1e-6f, y, z, 0}, {x + 0.01f * uniform(random), y + 0.01f, z - 0.01f, 0});
    }
    expect_ordinary_time(mesh);
}

TEST(BvhOddMesh, LongDiagonalNeedles) {
    // Every needle crosses most of the scene: cutting could go on without end.
    Mesh mesh;
    std::mt19937 random(10);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < COUNT; ++i) {
        const float x = 0.2f * uniform(random), y = 0.2f * uniform(random), z = 0.2f * uniform(random);
        mesh.add({x - 1, y - 1, z - 1, 0}, {x - 1 + 1e-5f, y - 1, z - 1, 0}, {x + 1, y + 1, z + 1, 0});
    }
    expect_ordinary_time(mesh);
}

TEST(BvhOddMesh, OneHugeAmongAMillionTiny) {
    Mesh mesh = random_soup(MILLION, 1e-4f, 8);
    mesh.add({-1e6f, 0, -1e6f, 0}, {1e6f, 0, -1e6f, 0}, {0, 0.5f, 2e6f, 0});
    expect_ordinary_time(mesh);
}

TEST(BvhOddMesh, GridOfRepeatedInstances) {
    // A hundred balls written out, each ten times at the same place.
    const Mesh ball = bumpy_ball(10);
    Mesh mesh;
    for (int i = 0; i < 100; ++i)
        for (int copy = 0; copy < 10; ++copy) {
            const u32 first = u32(mesh.positions.size());
            for (const vec4& p : ball.positions)
                mesh.positions.push_back({p.x + 3 * float(i % 10), p.y, p.z + 3 * float(i / 10), 0});
            for (const Triangle& t : ball.triangles)
                mesh.add(first + t.v0, first + t.v1, first + t.v2);
        }
    expect_ordinary_time(mesh);
}

} // namespace
} // namespace clrt
