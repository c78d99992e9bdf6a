// SPDX-License-Identifier: Apache-2.0
// Polygons of every shape are cut into triangles that tile them.
#include "scene/triangulate.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>
#include <map>
#include <random>

namespace clrt {
namespace {

using Polygon = std::vector<glm::dvec3>;

/// A polygon in the plane z = 0.
Polygon flat(const std::vector<glm::vec2>& corners) {
    Polygon polygon;
    for (const glm::vec2& c : corners)
        polygon.emplace_back(c, 0);
    return polygon;
}

glm::dvec3 area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return 0.5 * glm::cross(b - a, c - a);
}

glm::dvec3 area_vector(const Polygon& polygon) {
    glm::dvec3 sum(0);
    for (size_t i = 2; i < polygon.size(); ++i)
        sum += area_vector(polygon[0], polygon[i - 1], polygon[i]);
    return sum;
}

/// Triangles tile a polygon if their edges are the polygon's and pairs inside, none is turned over, and the
/// areas add up. `smallest` is the least area allowed for a triangle as a fraction of the polygon's.
void expect_tiles(const Polygon& polygon, const std::vector<u32>& triangles, double smallest) {
    ASSERT_EQ(triangles.size(), 3 * (polygon.size() - 2));
    std::map<std::pair<u32, u32>, int> edges;
    const double whole = glm::length(area_vector(polygon));
    const glm::dvec3 normal = area_vector(polygon) / whole;
    double sum = 0;
    for (size_t i = 0; i < triangles.size(); i += 3) {
        const u32* t = &triangles[i];
        for (int k = 0; k < 3; ++k) {
            ASSERT_LT(t[k], polygon.size());
            ++edges[{t[k], t[(k + 1) % 3]}];
            --edges[{t[(k + 1) % 3], t[k]}];
        }
        const double area = glm::dot(area_vector(polygon[t[0]], polygon[t[1]], polygon[t[2]]), normal);
        EXPECT_GE(area, smallest * whole) << "triangle " << t[0] << ' ' << t[1] << ' ' << t[2];
        sum += area;
    }
    EXPECT_NEAR(sum, whole, 1e-6 * whole);
    for (u32 i = 0; i < polygon.size(); ++i)
        --edges[{i, u32((i + 1) % polygon.size())}], ++edges[{u32((i + 1) % polygon.size()), i}];
    for (const auto& [edge, count] : edges)
        EXPECT_EQ(count, 0) << "edge " << edge.first << ' ' << edge.second;
}

/// Cuts the polygon from each of its corners on, in both windings.
void expect_proper_cut(Polygon polygon, double smallest = 1e-9) {
    for (int winding = 0; winding < 2; ++winding) {
        for (size_t start = 0; start < polygon.size(); ++start) {
            std::vector<u32> triangles;
            EXPECT_TRUE(triangulate(polygon, triangles)) << "start " << start;
            expect_tiles(polygon, triangles, smallest);
            std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
        }
        std::reverse(polygon.begin(), polygon.end());
    }
}

/// Teeth of growing length on a bar: concave, with as many reflex corners as convex ones.
Polygon comb(size_t corners) {
    Polygon polygon;
    for (size_t i = 0; i + 2 < corners; ++i)
        polygon.emplace_back(float(i), i % 2 ? 1.0f : 50.0f + float(i), 0.0f);
    polygon.emplace_back(float(corners), 0.0f, 0.0f);
    polygon.emplace_back(0.0f, 0.0f, 0.0f);
    return polygon;
}

TEST(Triangulate, TriangleStaysAsItIs) {
    std::vector<u32> triangles;
    EXPECT_TRUE(triangulate(flat({{0, 0}, {1, 0}, {0, 1}}), triangles));
    EXPECT_EQ(triangles, (std::vector<u32>{0, 1, 2}));
}

TEST(Triangulate, QuadIsCutAlongItsShorterDiagonal) {
    std::vector<u32> triangles;
    EXPECT_TRUE(triangulate(flat({{0, 0}, {3, 0}, {5, 2}, {0, 2}}), triangles));
    EXPECT_EQ(triangles, (std::vector<u32>{1, 2, 3, 1, 3, 0}));
    EXPECT_TRUE(triangulate(flat({{0, 0}, {5, 0}, {3, 2}, {0, 2}}), triangles));
    EXPECT_EQ(triangles, (std::vector<u32>{0, 1, 2, 0, 2, 3}));
}

TEST(Triangulate, ConcaveQuadIsCutAtItsReflexCorner) {
    // The shorter diagonal lies outside.
    expect_proper_cut(flat({{0, 0}, {4, -1}, {1, 0}, {4, 1}}));
    expect_proper_cut(flat({{0, 0}, {9, -1}, {8, 0}, {9, 1}}));
}

TEST(Triangulate, QuadWithFlatOrDoubledCornerIsCut) {
    expect_proper_cut(flat({{0, 0}, {1, 0}, {4, 0}, {0, 3}}));
    expect_proper_cut(flat({{0, 0}, {4, 0}, {4, 0}, {0, 3}}), 0);
}

TEST(Triangulate, ConvexPolygonBecomesFan) {
    std::vector<u32> triangles;
    EXPECT_TRUE(triangulate(flat({{0, 0}, {2, 0}, {3, 2}, {1, 3}, {-1, 2}}), triangles));
    EXPECT_EQ(triangles, (std::vector<u32>{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

TEST(Triangulate, FlatCornersGetTrianglesWithArea) {
    // One and two corners in the middle of each edge: a fan from a corner would give slivers without area.
    expect_proper_cut(flat({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}));
    expect_proper_cut(flat(
        {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {3, 3}, {2, 3}, {1, 3}, {0, 3}, {0, 2}, {0, 1}}));
    expect_proper_cut(flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 3}}));
}

TEST(Triangulate, ConcavePolygonsAreCutByEarClipping) {
    const Polygon corner = flat({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}});
    const Polygon channel = flat({{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {1, 1}, {1, 3}, {0, 3}});
    Polygon spiral = flat({{0, 0}, {9, 0}, {9, 9}, {1, 9}, {1, 3}, {6, 3}, {6, 6}, {3, 6}});
    const Polygon way_back = flat({{3, 5}, {5, 5}, {5, 4}, {2, 4}, {2, 8}, {8, 8}, {8, 1}, {0, 1}});
    spiral.insert(spiral.end(), way_back.begin(), way_back.end());
    for (const Polygon& polygon : {corner, channel, spiral, comb(40)})
        expect_proper_cut(polygon);
}

TEST(Triangulate, DoubledCornerDoesNotHideReflexTurn) {
    expect_proper_cut(flat({{0, 0}, {4, 0}, {1, 1}, {1, 1}, {0, 4}}), 0);
    expect_proper_cut(flat({{0, 0}, {6, 0}, {5, 2}, {3, 1}, {3, 1}, {1, 2}}), 0);
}

TEST(Triangulate, HoleJoinedByBridgeIsLeftOpen) {
    expect_proper_cut(flat({{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}));
}

TEST(Triangulate, RandomPolygonsInRandomPlanesAreTiled) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int n = 5; n < 60; ++n) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)) - 0.5);
        const glm::dvec3 s = glm::normalize(glm::cross(normal, glm::dvec3(normal.y, normal.z, -normal.x)));
        const glm::dvec3 t = glm::cross(normal, s), centre(100 * unit(random), 7, -3);
        Polygon polygon;
        for (int i = 0; i < n; ++i) {
            const double angle = 2 * M_PI * i / n, radius = 0.2 + double(unit(random));
            polygon.push_back(centre + radius * (std::cos(angle) * s + std::sin(angle) * t));
        }
        // Rounded positions leave the plane a little, so that thin triangles may turn over a little.
        expect_proper_cut(polygon, -1e-12);
    }
}

TEST(Triangulate, APolygonInMapCoordinatesIsCutAsAtTheOrigin) {
    // A square with a notch, in sixteenths of a unit: floats have steps of half a unit there.
    Polygon polygon = flat({{0, 0}, {1, 0}, {1, 1}, {0.5, 0.0625}, {0, 1}});
    std::vector<u32> near, far;
    EXPECT_TRUE(triangulate(polygon, near));
    for (glm::dvec3& p : polygon)
        p += glm::dvec3(5.4e6, -6.2e6, 1e6);
    EXPECT_TRUE(triangulate(polygon, far));
    EXPECT_EQ(near, far);
}

TEST(Triangulate, WhatCannotBeTiledIsFannedAndReported) {
    const Polygon polygons[] = {
        flat({{0, 0}, {2, 2}, {2, 0}, {0, 2}}),             // bow tie without area
        flat({{0, 0}, {3, 3}, {3, 0}, {0, 2}}),             // bow tie
        flat({{0, 0}, {1, 1}, {2, 2}, {3, 3}, {5, 5}}),     // on a line
        flat({{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}}),     // a point
        flat({{0, 9}, {-5, -8}, {9, 3}, {-9, 3}, {5, -8}}), // pentagram: turns left everywhere, but twice
                                                            // round
        flat({{0, 0}, {4, 4}, {4, 0}, {0, 4}, {-1, 6}, {9, 9}, {3, 1}, {5, 2}}), // tangle
    };
    for (const Polygon& polygon : polygons) {
        std::vector<u32> triangles;
        EXPECT_FALSE(triangulate(polygon, triangles)) << "polygon " << &polygon - polygons;
        EXPECT_EQ(triangles.size(), 3 * (polygon.size() - 2));
        EXPECT_LT(*std::max_element(triangles.begin(), triangles.end()), polygon.size());
    }
}

TEST(Triangulate, HugeCoordinatesDoNotOverflow) {
    expect_proper_cut(flat({{0, 0}, {3e38f, 0}, {3e38f, 1e38f}, {1e38f, 1e38f}, {1e38f, 3e38f}, {0, 3e38f}}));
    expect_proper_cut(
        flat({{0, 0}, {4e-38f, 0}, {4e-38f, 1e-38f}, {1e-38f, 1e-38f}, {1e-38f, 4e-38f}, {0, 4e-38f}}));
}

/// Processor seconds: other work of the machine does not count.
double seconds_to_cut(const Polygon& polygon, bool proper) {
    std::vector<u32> triangles;
    const std::clock_t start = std::clock();
    EXPECT_EQ(triangulate(polygon, triangles), proper);
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_EQ(triangles.size(), 3 * (polygon.size() - 2));
    return seconds;
}

TEST(Triangulate, LargestThatIsClippedIsTiled) {
    const Polygon largest = comb(MAX_CLIPPED_CORNERS);
    std::vector<u32> triangles;
    EXPECT_TRUE(triangulate(largest, triangles));
    expect_tiles(largest, triangles, 0);
}

TEST(Triangulate, PolygonsThatAreNotClippedTakeTimeInProportion) {
    // Clipping them would take 149 times as long as the largest polygon that is clipped.
    constexpr int CORNERS = 100000;
    Polygon circle;
    for (int i = 0; i < CORNERS; ++i)
        circle.emplace_back(1000 * std::cos(6.283185307 * i / CORNERS),
                            1000 * std::sin(6.283185307 * i / CORNERS), 0);
    const double clipped = seconds_to_cut(comb(MAX_CLIPPED_CORNERS), true);
    EXPECT_LT(seconds_to_cut(circle, true), clipped);
    EXPECT_LT(seconds_to_cut(comb(CORNERS), false), clipped);
}

} // namespace
} // namespace clrt
