// SPDX-License-Identifier: Apache-2.0
// Connections to lamps through plane-parallel slabs of glass: a closed form, the light that light paths find,
// and less noise.
#include "film/film_error.h"
#include "probes/closed_forms.h"
#include "support/drawn.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"
#include "support/windowed_room.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// The sine of the angle at which light leaves the origin upwards that comes through a slab of thickness h
/// and index n to a point at (across, up): by bisection.
double find_sine(double across, double up, double h, double n) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double s = (low + high) / 2;
        const double reached = (up - h) * s / std::sqrt(1 - s * s) + h * s / std::sqrt(n * n - s * s);
        (reached < across ? low : high) = s;
    }
    return low;
}

/// A floor, a slab of glass that is as good as endless, and a small lamp above it that faces down; all of the
/// picture shows one point of the floor.
struct GlazedLamp : TestScene {
    static constexpr double ACROSS = 1.2, UP = 1.5, INDEX = 1.5, HALF = 0.01, RADIANCE = 500;
    explicit GlazedLamp(double thickness, int max_depth = 4) {
        build.material("grey", "Kd 0.5 0.5 0.5").material("glass", "Ni 1.5\nillum 7");
        build.material("lamp", "Kd 0 0 0\nKe 500 500 500").use("grey").floor(4);
        build.use("glass").box({-50, 0.6, -50}, {50, 0.6 + thickness, 50}).use("lamp");
        const double x0 = ACROSS - HALF, x1 = ACROSS + HALF;
        build.polygon({{x0, UP, -HALF}, {x1, UP, -HALF}, {x1, UP, HALF}, {x0, UP, HALF}});
        look_at_point({0.2, 0.5, 0.1}, {0, 0, 0});
        options.sampling.spp = 256;
        options.transport.max_depth = max_depth;
        options.transport.guide = Toggle::OFF;
    }
};

/// A room that a lamp outside its window lights; the camera sees the wall that is opposite.
struct LampOutside : TestScene {
    /// `glass`: keys of the panes; empty: there are none.
    explicit LampOutside(const std::string& glass, int panes = 1, double thickness = 0.15) {
        build.material("white", "Kd 0.7 0.6 0.5").use("white");
        add_windowed_room(build);
        build.material("lamp", "Kd 0 0 0\nKe 60 50 40").use("lamp");
        build.polygon({{3.2, 1.8, -0.3}, {3.2, 1.8, 0.3}, {3.2, 2.4, 0.3}, {3.2, 2.4, -0.3}});
        if (!glass.empty())
            build.material("glass", glass).use("glass");
        for (int i = 0; i < panes && !glass.empty(); ++i)
            build.box({2.1 + 0.3 * i, 0.6, -0.9}, {2.1 + thickness + 0.3 * i, 2.6, 0.9});
        look({-0.2, 1.6, 1.7}, {-2.8, 0.6, -1.5}, 75);
        options.light.environment = glm::dvec3(0);
        options.film.size = {24, 24};
        options.sampling.spp = 1024;
        options.transport.max_depth = 8;
        options.transport.guide = Toggle::OFF;
        options.effects.all = false;
    }
    /// A coarse ball with smooth normals, and a veil.
    void add_bodies() {
        build.material("veil", "Kd 0.5 0.5 0.5\nd 0.7")
            .use("white")
            .icosphere({-1.6, 0.6, -0.6}, 0.5, 1, Facing::OUTWARD, Shading::SMOOTH);
        build.use("veil").polygon({{1.5, 0, -0.5}, {1.5, 2.4, -0.5}, {1.5, 2.4, 0}, {1.5, 0, 0}});
    }
};

} // namespace

TEST(SlabLamp, LightComesBentAsFresnelAndSnellSay) {
    for (const double h : {0.1, 0.7}) {
        const double s = find_sine(GlazedLamp::ACROSS, GlazedLamp::UP, h, GlazedLamp::INDEX);
        const double c = std::sqrt(1 - s * s),
                     root = std::sqrt(GlazedLamp::INDEX * GlazedLamp::INDEX - s * s);
        const double f = fresnel_reflectance(c, 1 / GlazedLamp::INDEX);
        const double slope = (GlazedLamp::UP - h) / (c * c) +
                             h * c * GlazedLamp::INDEX * GlazedLamp::INDEX / (root * root * root);
        const double area = 4 * GlazedLamp::HALF * GlazedLamp::HALF;
        // The solid angle over the cosine on the lamp is the area over c (ACROSS / s) slope.
        const double arriving = GlazedLamp::RADIANCE * area * c / (GlazedLamp::ACROSS / s * slope);
        const double expected = 0.5 / PI * arriving * (1 - f) * (1 - f);
        for (const Toggle shares : {Toggle::OFF, Toggle::ON}) {
            GlazedLamp scene(h);
            scene.options.transport.path_reuse = shares;
            EXPECT_TRUE(agrees(film_estimate(scene.render().film, 0), expected, 2e-3, 1e-4)) << h;
        }
    }
}

TEST(SlabLamp, FacetsCountAsSegments) {
    GlazedLamp scene(0.1, 3); // one to the floor, one to either facet
    EXPECT_EQ(film_estimate(scene.render().film, 0).mean, 0);
}

TEST(SlabLamp, ConnectionsFindTheLightThatLightPathsFind) {
    struct Glass {
        const char* keys;
        int panes;
        double thickness;
    };
    const std::vector<Glass> glasses = {{"Ni 1.5\nillum 7", 1, 0.5},
                                        {"Ni 1.3\nTf 0.9 0.8 0.6\nillum 7", 2, 0.2},
                                        {"Ni 1.9\nillum 7\nattenuation 1 2 4", 1, 0.9}};
    for (const auto& [keys, panes, thickness] : drawn(glasses, 2)) {
        SCOPED_TRACE(keys);
        LampOutside room(keys, panes, thickness);
        room.add_bodies();
        Options alone = room.options;
        alone.sampling.spp = 16384;
        expect_equal(tile_means(room, room.options, Integrator::PATH, ""),
                     tile_means(room, alone, Integrator::LIGHT, ""), 0.06);
    }
}

// What paths meet by themselves is weighted against what they are connected to: a large lamp, close behind.
TEST(SlabLamp, PathsThatMeetTheLampAreWeighted) {
    for (const Toggle shares : {Toggle::OFF, Toggle::ON}) {
        LampOutside room("Ni 1.5\nillum 7");
        room.build.use("lamp").polygon(
            {{2.4, 0.7, -0.8}, {2.4, 0.7, 0.8}, {2.4, 2.5, 0.8}, {2.4, 2.5, -0.8}});
        room.add_bodies();
        room.options.transport.path_reuse = shares;
        Options alone = room.options;
        alone.transport.path_reuse = Toggle::OFF;
        alone.sampling.spp = 8192;
        expect_equal(tile_means(room, room.options, Integrator::PATH, ""),
                     tile_means(room, alone, Integrator::LIGHT, ""), 0.04);
    }
}

// Paths that are asked for by an expression are not connected through slabs.
TEST(SlabLamp, IsQuieterThanPathsThatMeetTheLampByChance) {
    LampOutside room("Ni 1.5\nillum 7");
    room.options.sampling.spp = 256;
    const double connected = sample_error(room.render().film, ErrorMeasure::RELATIVE);
    room.options.transport.paths = "L(D|G|S)*E";
    EXPECT_LT(connected, 0.1 * sample_error(room.render().film, ErrorMeasure::RELATIVE));
}

} // namespace clrt
