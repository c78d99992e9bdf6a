// SPDX-License-Identifier: Apache-2.0
// Windows by the ways that paths take out of a room: their edges, in rooms turned about, several of them;
// none in the open.
#include "probes/random_inputs.h"
#include "scene/sky_portals.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

using glm::dvec3;

/// A window in a wall, from low to high.
struct Window {
    dvec3 low, high;
};

/// Ways from random points of the room [-3, 2] x [0, 2.5] x [-2, 2] through its windows, by area; turned by
/// an angle about +Y.
std::vector<Escape> escapes_of(const std::vector<Window>& windows, double angle, size_t count,
                               float surfaces) {
    Random random(5);
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](const dvec3& v) { return dvec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
    std::vector<Escape> escapes;
    for (size_t i = 0; i < count; ++i) {
        const Window& window = windows[i % windows.size()];
        const dvec3 from(-3 + 4.8 * random.unit(), 2.5 * random.unit(), -2 + 4 * random.unit());
        const dvec3 to =
            window.low + (window.high - window.low) * dvec3(random.unit(), random.unit(), random.unit());
        escapes.push_back({to_vec4(turned(from), surfaces), to_vec4(turned(glm::normalize(to - from)), 1)});
    }
    return escapes;
}

glm::dmat3 axes_turned(double angle) {
    glm::dmat3 axes(1.0);
    axes[0] = {std::cos(angle), 0, -std::sin(angle)};
    axes[2] = {std::sin(angle), 0, std::cos(angle)};
    return axes;
}

double area_of(const SkyPortal& portal) {
    return double(portal.axis_u.w) * double(portal.axis_v.w);
}

const Window LEFT = {{2, 1, -1.5}, {2, 2, -0.5}}, RIGHT = {{2, 0.5, 0}, {2, 2.2, 1.6}};
const Window OF_THE_NEXT_WALL = {{-0.5, 0.3, -2}, {1.2, 2.3, -2}};

} // namespace

TEST(SkyPortals, AreWhereTheWindowsAre) {
    for (const double angle : {0.0, 0.4}) {
        std::vector<SkyPortal> portals =
            find_portals(escapes_of({LEFT, RIGHT}, angle, 8000, 3), axes_turned(angle));
        ASSERT_EQ(portals.size(), 2u) << angle;
        std::sort(portals.begin(), portals.end(),
                  [](const SkyPortal& a, const SkyPortal& b) { return area_of(a) < area_of(b); });
        EXPECT_NEAR(area_of(portals[0]), 1.0 * 1.0, 0.1);
        EXPECT_NEAR(area_of(portals[1]), 1.7 * 1.6, 0.2);
        for (const SkyPortal& portal : portals) {
            // Inwards, in the wall.
            const dvec3 normal = to_dvec3(portal.normal);
            EXPECT_NEAR(glm::dot(normal, dvec3(-std::cos(angle), 0, std::sin(angle))), 1, 1e-6);
            EXPECT_NEAR(glm::dot(to_dvec3(portal.corner), normal), -2, 0.15);
        }
    }
}

TEST(SkyPortals, AreInTwoWalls) {
    // Ways through each wall's windows cross the plane of the other's somewhere outside.
    const std::vector<Window> windows = {LEFT, RIGHT, OF_THE_NEXT_WALL};
    const std::vector<SkyPortal> portals = find_portals(escapes_of(windows, 0, 9000, 3), axes_turned(0));
    for (const Window& window : windows) {
        const dvec3 middle = (window.low + window.high) * 0.5, size = window.high - window.low;
        const double area = size.x == 0 ? size.y * size.z : size.x * size.y;
        double covered = 0;
        for (const SkyPortal& portal : portals) {
            const dvec3 u = to_dvec3(portal.axis_u) * double(portal.axis_u.w);
            const dvec3 v = to_dvec3(portal.axis_v) * double(portal.axis_v.w);
            const dvec3 away = to_dvec3(portal.corner) + (u + v) * 0.5 - middle;
            if (glm::all(glm::lessThan(glm::abs(away), size * 0.5 + dvec3(0.1))))
                covered += area_of(portal);
        }
        EXPECT_NEAR(covered, area, 0.15 * area) << middle.x << " " << middle.z;
    }
    EXPECT_LE(portals.size(), 5u);
}

TEST(SkyPortals, LetInWhatPathsHaveSeen) {
    // Of four paths that leave from their third surface two do from the open; one stays within.
    std::vector<Escape> escapes = escapes_of({LEFT}, 0, 8000, 3);
    for (size_t i = 0; i < escapes.size(); i += 4) {
        escapes[i].origin.w = escapes[i + 1].origin.w = -3;
        escapes[i + 2] = {};
        escapes[i + 3].direction.w = i == 0 ? 1e9f : 1.0f; // the sun, by chance
    }
    escapes.resize(escapes.size() * 2, Escape{{}, {0, 1, 0, 1}}); // to the sky at once
    SkyPortal portal{};
    portal.axis_u.w = 2;
    portal.axis_v.w = 3;
    const SkyThroughPortals let_in = light_through({portal}, escapes);
    EXPECT_NEAR(let_in.irradiance, PI / (2 * 2 + 3 + ESCAPE_SEGMENTS - 1), 0.003);
    EXPECT_NEAR(let_in.flux, 6 * PI, 0.2);
    EXPECT_EQ(light_through({portal}, {}).flux, 0);
}

TEST(SkyPortals, AreNoneInTheOpenOrWhereFewPathsLeave) {
    EXPECT_TRUE(find_portals(escapes_of({LEFT}, 0, 8000, 1), axes_turned(0)).empty());
    EXPECT_TRUE(find_portals(escapes_of({LEFT}, 0, 10, 3), axes_turned(0)).empty());
}

} // namespace clrt
