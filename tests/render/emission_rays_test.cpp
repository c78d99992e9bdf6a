// SPDX-License-Identifier: Apache-2.0
// Emission that the camera sees from rays of its own: the picture stays the same, its noise at the outlines
// of lights falls, and nothing is paid where there is none.
#include "film/film_error.h"
#include "probes/film_estimate.h"
#include "render/light_outlines.h"
#include "render/prepared_scene.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"
#include "support/test_device.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

namespace clrt {

namespace {

constexpr int SIDE = 32;
constexpr double RADIANCE = 100;

/// A lamp in front of a camera that looks along -z at a plane which it shows 1:1, a pixel a unit.
struct Lamp : TestScene {
    Lamp(const glm::dvec2& low, const glm::dvec2& high, double depth = SIDE / 2.) {
        build.material("lamp", "Kd 0 0 0\nKe 100 100 100").material("wall", "Kd 0.5 0.5 0.5").use("lamp");
        const double z = -depth, scale = depth / (SIDE / 2.);
        build.polygon({{low.x * scale, low.y * scale, z},
                       {high.x * scale, low.y * scale, z},
                       {high.x * scale, high.y * scale, z},
                       {low.x * scale, high.y * scale, z}});
        options.camera.eye = glm::dvec3(0);
        options.camera.at = glm::dvec3(0, 0, -1);
        options.camera.fov_degrees = 90;
        options.film.size = {SIDE, SIDE};
        options.light.environment = glm::dvec3(0);
        options.sampling.spp = 64;
        options.sampling.replicates = 4;
        shared_effects = EFFECT_AREA_LIGHT | EFFECT_MATTE | EFFECT_DEPTH_OF_FIELD | EFFECT_INTERREFLECTION;
    }
    Render render_by(int emission_rays) {
        options.transport.emission_rays = emission_rays;
        return render();
    }
    /// Pixels that may see its outline.
    std::vector<std::uint8_t> outlines() const {
        const auto planned = plan_loaded(test_device(), load(), options);
        return find_light_outlines(planned->scene, launch_params(*planned));
    }
};

/// Share of pixel (x, y) that a rectangle covers, which is given right of and above the picture's centre.
double share_of_pixel(const glm::dvec2& low, const glm::dvec2& high, int x, int y) {
    const double left = x - SIDE / 2., bottom = SIDE / 2. - 1 - y;
    const auto overlap = [](double low, double high, double begin) {
        return std::max(0., std::min(high, begin + 1) - std::max(low, begin));
    };
    return overlap(low.x, high.x, left) * overlap(low.y, high.y, bottom);
}

/// Has the camera look at a lamp behind it by way of a mirror of 4 x 4 pixels; the image goes from `low` to
/// `high`.
struct MirroredLamp : Lamp {
    MirroredLamp(const glm::dvec2& low, const glm::dvec2& high) : Lamp({-40, -40}, {-39, -39}) {
        constexpr double BEHIND = 10, SCALE = (SIDE + BEHIND) / (SIDE / 2.);
        build.use("lamp").polygon({{low.x * SCALE, low.y * SCALE, BEHIND},
                                   {low.x * SCALE, high.y * SCALE, BEHIND},
                                   {high.x * SCALE, high.y * SCALE, BEHIND},
                                   {high.x * SCALE, low.y * SCALE, BEHIND}});
        shared_effects |= EFFECT_MIRROR | EFFECT_LIGHT_TREE;
    }
    void add_mirror(double half, const std::string& colour = "1 1 1") {
        constexpr double z = -SIDE / 2.;
        build.material("mirror", "Kd 0 0 0\nKs " + colour + "\nillum 3").use("mirror");
        build.polygon({{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
    }
};

/// Root of the mean square of a picture's distance from what the camera sees of a rectangle.
double distance_from(const Film& film, const glm::dvec2& low, const glm::dvec2& high) {
    double sum = 0;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            const double difference = film_pixel(film, x, y).x - RADIANCE * share_of_pixel(low, high, x, y);
            sum += difference * difference;
        }
    return std::sqrt(sum / (SIDE * SIDE));
}

} // namespace

TEST(EmissionRays, OutlinesHaveTheirSharesOfPixels) {
    const glm::dvec2 low(-6.3, -4.7), high(3.1, 7.6);
    Lamp lamp(low, high);
    const double without = distance_from(lamp.render_by(1).film, low, high);
    const double with = distance_from(lamp.render_by(16).film, low, high);
    EXPECT_LT(with, 0.01 * RADIANCE);
    EXPECT_LT(4 * with, without);
    // The error that is told falls as the one that is there.
    const Film film = lamp.render_by(16).film;
    const double mean = RADIANCE * (high.x - low.x) * (high.y - low.y) / (SIDE * SIDE);
    EXPECT_LT(film_error(film)->relative_rmse, 4 * with / mean);
}

TEST(EmissionRays, ALampSmallerThanAPixelIsSeen) {
    const glm::dvec2 low(2.4, 2.45), high(2.6, 2.6);
    Lamp lamp(low, high);
    double with = 0, without = 0;
    for (int seed = 0; seed < 16; ++seed) {
        lamp.options.sampling.seed = std::uint32_t(seed);
        with += distance_from(lamp.render_by(16).film, low, high);
        without += distance_from(lamp.render_by(1).film, low, high);
    }
    EXPECT_LT(4 * with, without);
}

TEST(EmissionRays, NothingIsPaidWithinALampAndBesideIt) {
    Lamp lamp({-40, -40}, {40, 40});
    EXPECT_EQ(lamp.render_by(16).counts.rays(), lamp.render_by(1).counts.rays());
    EXPECT_EQ(film_pixel(lamp.render_by(16).film, 3, 3).x, RADIANCE);
    Lamp behind({-6, -6}, {6, 6}, -20);
    EXPECT_EQ(behind.render_by(16).counts.rays(), behind.render_by(1).counts.rays());
}

TEST(EmissionRays, OnlyPixelsAroundLampsAreOpen) {
    // 4 x 5 whole pixels, and one to every side.
    Lamp lamp({2, 3}, {6, 8});
    lamp.options.transport.emission_rays = 8;
    const std::vector<std::uint8_t> outlines = lamp.outlines();
    ASSERT_EQ(outlines.size(), size_t(SIDE * SIDE));
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            const int right = x - SIDE / 2, up = SIDE / 2 - 1 - y;
            const bool is_inside = right >= 2 && right < 6 && up >= 3 && up < 8;
            const bool is_near = right >= 1 && right < 7 && up >= 2 && up < 9;
            const bool is_open = outlines[size_t(y * SIDE + x)] & EMISSION_OPEN;
            EXPECT_TRUE(is_inside ? is_open : is_near || !is_open) << x << " " << y;
        }
    lamp.options.transport.emission_rays = 1;
    EXPECT_TRUE(lamp.outlines().empty());
}

TEST(EmissionRays, ALampBesideTheCameraCoversWhatItMayCover) {
    // From behind the camera to far in front of it, to the right.
    Lamp lamp({0, 0}, {1, 1});
    lamp.options.transport.emission_rays = 8;
    lamp.build.use("lamp").polygon({{2, -1, 5}, {2, -1, -100}, {2, 1, -100}, {2, 1, 5}});
    const std::vector<std::uint8_t> outlines = lamp.outlines();
    EXPECT_TRUE(outlines[SIDE * (SIDE / 2) + SIDE - 1] & EMISSION_OPEN);
    EXPECT_EQ(outlines[SIDE * (SIDE / 2) + 2], EMISSION_BY_PATHS);
}

TEST(EmissionRays, LampsOutOfFocusAreOpenAsWideAsTheyAreBlurred) {
    const glm::dvec2 low(-0.5, -0.5), high(0.5, 0.5);
    Lamp lamp(low, high);
    lamp.options.camera.aperture = 8;
    lamp.options.camera.focus = 1e6;
    const std::vector<std::uint8_t> outlines = lamp.outlines();
    // The circle of confusion of 8 units at a depth of 16 is 8 pixels wide.
    EXPECT_TRUE(outlines[SIDE * (SIDE / 2) + SIDE / 2 + 3] & EMISSION_OPEN);
    EXPECT_EQ(outlines[SIDE * (SIDE / 2) + SIDE / 2 + 8], EMISSION_BY_PATHS);
    // Light is moved, and none is lost.
    lamp.options.sampling.spp = 1024;
    const Film few = lamp.render_by(1).film;
    lamp.options.sampling.seed = 1;
    expect_equal_means(few, lamp.render_by(8).film, "out of focus");
}

TEST(EmissionRays, ALampSmallerThanAPixelIsSeenInASmallMirror) {
    const glm::dvec2 low(0.4, 0.45), high(0.6, 0.6);
    double with = 0, without = 0;
    MirroredLamp lamp(low, high);
    lamp.add_mirror(2);
    for (int seed = 0; seed < 16; ++seed) {
        lamp.options.sampling.seed = std::uint32_t(seed);
        with += distance_from(lamp.render_by(16).film, low, high);
        without += distance_from(lamp.render_by(1).film, low, high);
    }
    EXPECT_LT(with, 16 * 0.1 * RADIANCE * 0.2 * 0.15 / SIDE);
    EXPECT_LT(4 * with, without);
}

TEST(EmissionRays, ALampThatProbesMissIsLookedAt) {
    EXPECT_GT(Lamp({2.49, 2.49}, {2.51, 2.51}).render_by(16).counts.outline_pixels, 0);
}

TEST(EmissionRays, LightOnWhatIsSeenBesideLampsIsKept) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT}) {
        SCOPED_TRACE(name_of(integrator));
        // A strip and a block of glass before a wall, whose light comes from a large lamp behind the camera,
        // by hits as well as by connections.
        Lamp strip({-15, -0.05}, {15, 0.05});
        strip.build.use("lamp").polygon({{-40, -40, 4}, {-40, 40, 4}, {40, 40, 4}, {40, -40, 4}});
        strip.build.use("wall").polygon({{-40, -40, -20}, {40, -40, -20}, {40, 40, -20}, {-40, 40, -20}});
        strip.build.material("glass", "Ni 1.5\nillum 7").use("glass").box({-1, 1, -11}, {1, 3, -10});
        strip.shared_effects |= EFFECT_LIGHT_TREE | EFFECT_REFRACTION;
        strip.options.transport.integrator = integrator;
        strip.options.sampling.spp = 1024;
        const Film few = strip.render_by(1).film;
        strip.options.sampling.seed = 1;
        const Render many = strip.render_by(4);
        EXPECT_GT(many.counts.outline_pixels, SIDE);
        expect_equal_means(few, many.film, name_of(integrator));
    }
}

TEST(EmissionRays, OnlyFewPixelsLookIntoMirrors) {
    MirroredLamp small({-1, -1}, {1, 1});
    small.add_mirror(2);
    const std::vector<std::uint8_t> few = small.outlines();
    EXPECT_EQ(few[SIDE * (SIDE / 2) + SIDE / 2], EMISSION_OPEN | EMISSION_SMALL | EMISSION_GOES_ON);
    EXPECT_EQ(few[SIDE * (SIDE / 2) + SIDE / 2 + 8], EMISSION_BY_PATHS);
    MirroredLamp large({-1, -1}, {1, 1});
    large.add_mirror(6); // a seventh of the picture
    EXPECT_EQ(large.outlines()[SIDE * (SIDE / 2) + SIDE / 2], EMISSION_BY_PATHS);
    small.options.transport.integrator = Integrator::LIGHT; // which sees nothing in mirrors
    EXPECT_EQ(small.outlines()[SIDE * (SIDE / 2) + SIDE / 2], EMISSION_BY_PATHS);
    small.options.transport.integrator = Integrator::PATH;
    small.options.transport.paths = "LS*E";
    EXPECT_EQ(small.outlines()[SIDE * (SIDE / 2) + SIDE / 2], EMISSION_BY_PATHS);
}

TEST(EmissionRays, WhatIsSeenInMirrorsAndThroughGlassIsKept) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT}) {
        SCOPED_TRACE(name_of(integrator));
        // The lamp in a mirror, through a block of coloured glass that is partly a mirror, too, and by way of
        // both the wall.
        MirroredLamp lamp({-0.7, -0.3}, {0.6, 0.9});
        lamp.add_mirror(1.5, "0.9 0.6 0.3");
        lamp.build.material("glass", "Ni 1.5\nillum 7\nattenuation 0.5 0.7 0.9");
        lamp.build.use("glass").box({-0.5, -1, -10}, {0.4, 0.8, -9});
        lamp.build.use("wall").polygon({{-20, -6, -30}, {20, -6, -30}, {20, -6, 9}, {-20, -6, 9}});
        lamp.shared_effects |= EFFECT_REFRACTION | EFFECT_ATTENUATION;
        lamp.options.sampling.spp = 1024;
        lamp.options.transport.integrator = integrator;
        for (const int depth : {2, 3, 16}) {
            lamp.options.transport.max_depth = depth;
            lamp.options.sampling.seed = 0;
            const Film few = lamp.render_by(1).film;
            lamp.options.sampling.seed = 1;
            const Render many = lamp.render_by(4);
            EXPECT_GT(many.counts.outline_pixels, 0);
            expect_equal_means(few, many.film, name_of(integrator));
        }
    }
}

TEST(EmissionRays, AllIntegratorsKeepTheirLight) {
    for (const Integrator integrator :
         {Integrator::PATH, Integrator::LIGHT, Integrator::PATH_LIGHT, Integrator::BDPT}) {
        SCOPED_TRACE(name_of(integrator));
        Lamp lamp({-3.5, -3.5}, {2.5, 2.5});
        lamp.build.use("wall").polygon({{-20, -6, -30}, {20, -6, -30}, {20, -6, 5}, {-20, -6, 5}});
        lamp.options.transport.integrator = integrator;
        const Film few = lamp.render_by(1).film;
        lamp.options.sampling.seed = 1;
        const Render many = lamp.render_by(4);
        EXPECT_GT(many.counts.outline_pixels, 0);
        expect_equal_means(few, many.film, name_of(integrator));
    }
}

} // namespace clrt
