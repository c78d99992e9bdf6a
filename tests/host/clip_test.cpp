// SPDX-License-Identifier: Apache-2.0
// Parts of triangles: whatever is cut away from one is in the other.
#include "bvh/clip.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace clrt {
namespace {

struct Corners {
    Float4 at[3];
    Box box;
};

// Coordinates of very different sizes, as in slivers far from the origin.
Corners random_corners(std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::uniform_int_distribution<int> exponent(-12, 12);
    Corners corners;
    const float size = std::ldexp(1.0f, exponent(random)), far = std::ldexp(1.0f, exponent(random));
    const Float4 centre = splat(far) * Float4{uniform(random), uniform(random), uniform(random), 0};
    for (Float4& corner : corners.at) {
        corner = centre + splat(size) * Float4{uniform(random), uniform(random), uniform(random), 0};
        corners.box.extend(corner);
    }
    return corners;
}

// How far a point is outside a box along the worst axis, in units of 2^-49 of the triangle's coordinates.
bool holds(const Box& box, const double* point, const Corners& corners) {
    for (int axis = 0; axis < 3; ++axis) {
        const double largest = std::max(std::abs(corners.box.lower[axis]), std::abs(corners.box.upper[axis]));
        const double slack = 0x1p-49 * largest; // what double loses
        if (point[axis] < box.lower[axis] - slack || point[axis] > box.upper[axis] + slack)
            return false;
    }
    return true;
}

// Points of edge `i` on both sides of the plane: its ends, and as near to the plane as double gets.
std::vector<std::array<double, 4>> points_of_edge(const Corners& corners, int i, int axis, float position) {
    const Float4 a = corners.at[i], b = corners.at[(i + 1) % 3];
    std::vector<double> shares{0, 1};
    const double share = (double(position) - a[axis]) / (double(b[axis]) - a[axis]);
    if (share > 0 && share < 1)
        shares.push_back(share);
    std::vector<std::array<double, 4>> points;
    for (double s : shares)
        points.push_back({a[0] + s * (double(b[0]) - a[0]), a[1] + s * (double(b[1]) - a[1]),
                          a[2] + s * (double(b[2]) - a[2]), s == share ? 1.0 : 0.0});
    return points;
}

TEST(Clip, BothPartsHoldWhereTheEdgesCrossThePlane) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    size_t lost = 0, crossings = 0;
    for (int i = 0; i < 200000; ++i) {
        const Corners corners = random_corners(random);
        const int axis = i % 3;
        const float low = corners.box.lower[axis], high = corners.box.upper[axis];
        const float position = low + uniform(random) * (high - low);
        if (!(low < position && position < high))
            continue;
        const BoxParts parts = cut_box(corners.box, corners.at, axis, position);
        for (int edge = 0; edge < 3; ++edge)
            for (const auto& point : points_of_edge(corners, edge, axis, position)) {
                const bool crosses = point[3] != 0, is_left = point[size_t(axis)] <= position;
                crossings += crosses;
                lost += (crosses || is_left) && !holds(parts.left, point.data(), corners);
                lost += (crosses || !is_left) && !holds(parts.right, point.data(), corners);
            }
    }
    EXPECT_GT(crossings, 300000u);
    EXPECT_EQ(lost, 0u);
}

TEST(Clip, PartsOfPartsCoverTheTriangle) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(0, 1);
    size_t lost = 0;
    for (int i = 0; i < 5000; ++i) {
        const Corners corners = random_corners(random);
        // Cut ten times, each time the largest part of those so far.
        std::vector<Box> parts{corners.box};
        for (int cut = 0; cut < 10; ++cut) {
            const Box box = parts[size_t(cut) / 2];
            const int axis = cut % 3;
            const float position = box.lower[axis] + uniform(random) * (box.upper[axis] - box.lower[axis]);
            if (!(box.lower[axis] < position && position < box.upper[axis]))
                break;
            const BoxParts two = cut_box(box, corners.at, axis, position);
            parts[size_t(cut) / 2] = two.left;
            parts.push_back(two.right);
        }
        for (int k = 0; k < 100; ++k) {
            double u = uniform(random), v = uniform(random);
            if (u + v > 1)
                u = 1 - u, v = 1 - v;
            double point[3];
            for (int axis = 0; axis < 3; ++axis)
                point[axis] =
                    (1 - u - v) * corners.at[0][axis] + u * corners.at[1][axis] + v * corners.at[2][axis];
            bool covered = false;
            for (const Box& part : parts)
                covered = covered || (!is_empty(part) && holds(part, point, corners));
            lost += !covered;
        }
    }
    EXPECT_EQ(lost, 0u);
}

TEST(Clip, PartsAreTight) {
    // A triangle in the plane z = 0 cut at x = 1: the tip is 1 by 1/2 large.
    const Float4 corners[3] = {{0, 0, 0, 0}, {4, 0, 0, 0}, {0, 2, 0, 0}};
    Box box;
    for (const Float4& corner : corners)
        box.extend(corner);
    const BoxParts parts = cut_box(box, corners, 0, 3);
    EXPECT_EQ(parts.left.lower[0], 0);
    EXPECT_EQ(parts.left.upper[0], 3);
    EXPECT_EQ(parts.left.upper[1], 2);
    EXPECT_EQ(parts.right.lower[0], 3);
    EXPECT_EQ(parts.right.upper[0], 4);
    EXPECT_NEAR(parts.right.upper[1], 0.5f, 1e-5);
    EXPECT_EQ(parts.right.lower[1], 0);
}

TEST(Clip, APartThatTheTriangleDoesNotReachIsEmpty) {
    // The box is what an earlier cut left around the triangle's left tip; the far corner of it is outside.
    const Float4 corners[3] = {{0, 0, 0, 0}, {4, 0, 0, 0}, {0, 4, 0, 0}};
    Box box;
    box.extend(Float4{2, 1, 0, 0});
    box.extend(Float4{4, 4, 0, 0});
    const BoxParts parts = cut_box(box, corners, 1, 3);
    EXPECT_TRUE(is_empty(parts.right));
    EXPECT_FALSE(is_empty(parts.left));
}

} // namespace
} // namespace clrt
