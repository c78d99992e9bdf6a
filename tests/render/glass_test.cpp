// SPDX-License-Identifier: Apache-2.0
// Glass in pictures: Fresnel's parts of a slab, Snell's directions, total reflection, and tint; closed forms
// of light behind stacks of panes, where a crossing is no event: no segment, no letter.
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator TREES_AND_PATH[] = {Integrator::WHITTED, Integrator::DISTRIBUTION, Integrator::PATH};

const Integrator ALL_THAT_REFRACT[] = {Integrator::WHITTED, Integrator::DISTRIBUTION, Integrator::PATH,
                                       Integrator::PATH_LIGHT, Integrator::BDPT};

/// A slab of glass between z = -0.5 and 0.5, and a lamp at z = -2 that shines towards +z from x = `edge` on.
class Slab : public TestScene {
public:
    explicit Slab(const std::string& glass_keys, double edge = -50) {
        build.material("glass", glass_keys).material("lamp", "Kd 0 0 0\nKe 1 1 1");
        build.use("glass").box({-60, -60, -0.5}, {60, 60, 0.5});
        build.use("lamp").polygon({{edge, -50, -2}, {50, -50, -2}, {50, 50, -2}, {edge, 50, -2}});
        options.transport.max_depth = 30;
        options.transport.min_contribution = 0;
        options.sampling.spp = 256;
    }
};

/// Glass below y = 0 around the camera; a green lamp on its bottom, red light in the air above.
class GlassSea : public TestScene {
public:
    GlassSea() {
        build.material("glass", "Ni 1.5\nillum 7").material("lamp", "Kd 0 0 0\nKe 0 1 0");
        build.use("glass").floor(20).use("lamp").floor(20, -3);
        options.light.environment = glm::dvec3(1, 0, 0);
        options.transport.min_contribution = 0;
    }
};

constexpr int STACK = 3;
const double TINTS[3] = {0.9, 0.5, 1.0};

/// What the stack passes of light at this cosine.
double passes(double cosine, int channel) {
    return std::pow((1 - fresnel_reflectance(cosine, 1 / 1.5)) * TINTS[channel], STACK);
}

/// The mean of what it passes over a matte surface's hemisphere of equal radiance.
double mean_passes(int channel) {
    constexpr int STEPS = 20000;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double square = (i + 0.5) / STEPS; // of the cosine, uniform for matte surfaces
        sum += passes(std::sqrt(square), channel) / STEPS;
    }
    return sum;
}

/// A matte floor below a stack of panes, which the camera looks at from below them, in direct light alone.
class FloorBelowPanes : public TestScene {
public:
    FloorBelowPanes() {
        build.material("floor", "Kd 0.5 0.5 0.5").use("floor").floor(3);
        build.material("pane", "Ni 1.5\nillum 7\nTf 0.9 0.5 1\nthin_walled 1").use("pane");
        for (int i = 0; i < STACK; ++i)
            build.floor(600, 1 + 0.1 * i);
        look_at_point({0.3, 0.5, 0.6}, {0.2, 0, 0.05}); // off the panes' diagonals
        options.transport.max_depth = 2;
        options.transport.min_contribution = 0;
        options.light.environment = glm::dvec3(0);
        options.sampling.spp = 256;
    }

    void expect(double (*radiance)(int channel), double sharpness) {
        for (const Integrator integrator : {Integrator::WHITTED, Integrator::DISTRIBUTION, Integrator::PATH,
                                            Integrator::PATH_LIGHT, Integrator::BDPT}) {
            options.transport.integrator = integrator;
            const Film film = render().film;
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_TRUE(agrees(film_estimate(film, channel), radiance(channel), sharpness))
                    << name_of(integrator) << ", channel " << channel;
        }
    }
};

} // namespace

TEST(Glass, ASlabHeadOnReflectsWhatItDoesNotTransmit) {
    Slab scene("Ni 1.5\nillum 7");
    scene.build.polygon({{-50, 50, 8}, {50, 50, 8}, {50, -50, 8}, {-50, -50, 8}}); // a lamp behind the camera
    scene.look_at_point({0, 0, 5}, {0, 0, -2});
    for (const Integrator integrator : TREES_AND_PATH) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 1, 1e-6)) << name_of(integrator);
    }
}

TEST(Glass, ASolidAbsorbsByItsThickness) {
    // Of an index so near to 1 that nothing else happens; 1 itself is repaired: the square of what is left
    // behind half a unit.
    Slab scene("Ni 1.00001\nillum 7\nattenuation 0.6 0.6 0.6\nattenuation_distance 0.5");
    scene.look_at_point({0, 0, 5}, {0, 0, -2});
    for (const Integrator integrator : ALL_THAT_REFRACT) {
        scene.options.transport.integrator = integrator;
        // 5e-4: rays start off the wall.
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.36, 1e-5, 5e-4)) << name_of(integrator);
    }
}

TEST(Glass, RoughSolidsAbsorbTheSameToPathsFromBothEnds) {
    TestScene scene;
    scene.build.material("honey",
                         "Ni 1.3\nillum 7\nPr 0.6\nattenuation 0.3 0.3 0.3\nattenuation_distance 0.5");
    scene.build.material("floor", "Kd 0.6 0.6 0.6").material("lamp", "Kd 0 0 0\nKe 6 6 6");
    scene.build.use("honey").box({-0.5, 0.2, -0.5}, {0.5, 0.8, 0.5});
    scene.build.use("floor").floor(3).use("lamp").polygon({{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}});
    scene.look({0, 1.5, 3}, {0, 0.3, 0}, 40);
    scene.options.sampling.spp = 512;
    const Estimate path = film_estimate(scene.render().film);
    for (const Integrator integrator : {Integrator::BDPT, Integrator::PATH_LIGHT, Integrator::LIGHT}) {
        scene.options.transport.integrator = integrator;
        const Estimate other = film_estimate(scene.render().film);
        EXPECT_NEAR(other.mean, path.mean, 5 * std::hypot(other.error, path.error)) << name_of(integrator);
    }
}

TEST(Glass, AThinWallLetsLightPassStraightAndOnce) {
    TestScene scene;
    scene.build.material("pane", "Ni 1.5\nillum 7\nTf 0.9 0.9 0.9\nthin_walled 1");
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1");
    scene.build.use("pane").polygon({{-60, -60, 0}, {60, -60, 0}, {60, 60, 0}, {-60, 60, 0}});
    scene.build.use("lamp").polygon({{-50, -50, -2}, {50, -50, -2}, {50, 50, -2}, {-50, 50, -2}});
    scene.build.polygon({{-50, 50, 8}, {50, 50, 8}, {50, -50, 8}, {-50, -50, 8}}); // behind the camera
    scene.options.sampling.spp = 256;
    scene.options.transport.min_contribution = 0;
    scene.look_at_point({0, 0, 5}, {0, 0, -2});
    for (const Integrator integrator : {Integrator::WHITTED, Integrator::DISTRIBUTION}) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.9 * 0.96 + 0.04, 1e-4))
            << name_of(integrator);
    }
    scene.options.transport.integrator = Integrator::PATH;
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.9 * 0.96 + 0.04, 1e-2));
}

TEST(Glass, TheShallowestTreesSeeTheFirstTermsOfTheSeries) {
    Slab scene("Ni 1.5\nillum 7");
    scene.look_at_point({0, 0, 5}, {0, 0, -2});
    scene.options.transport.integrator = Integrator::WHITTED;
    for (const auto& [depth, expected] :
         {std::pair{2, 0.0}, {3, 0.96 * 0.96}, {4, 0.96 * 0.96}, {5, 0.92307456}}) {
        scene.options.transport.max_depth = depth;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), expected, 2e-6)) << depth;
    }
}

TEST(Glass, EveryCrossingTints) {
    Slab scene("Ni 1.5\nillum 7\nTf 0.8 0.5 1");
    scene.look_at_point({0, 0, 5}, {0, 0, -2});
    for (const Integrator integrator : TREES_AND_PATH) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        EXPECT_TRUE(agrees(film_estimate(film, 0), 0.64 * 0.9230769)) << name_of(integrator);
        EXPECT_TRUE(agrees(film_estimate(film, 1), 0.25 * 0.9230769)) << name_of(integrator);
        EXPECT_TRUE(agrees(film_estimate(film, 2), 0.9230769)) << name_of(integrator);
    }
}

TEST(Glass, AnObliqueRayLeavesASlabShiftedByItsThickness) {
    // At 45 degrees the ray moves on by tan(b) inside the slab and by 1.5 behind it; there the lamp begins,
    // so it lights exactly the right half of the picture. The rays that were reflected inside land on the
    // lamp in any case.
    const double sine = std::sqrt(0.5), inside = std::asin(sine / 1.5);
    Slab scene("Ni 1.5\nillum 7", std::tan(inside) + 1.5);
    scene.look_at_point({-3 * sine, 0, 0.5 + 3 * sine}, {0, 0, 0.5});
    scene.options.transport.integrator = Integrator::WHITTED;
    const Film film = scene.render().film;
    const double f = fresnel_reflectance(sine, 1 / 1.5), once = (1 - f) * (1 - f);
    EXPECT_TRUE(agrees(film_estimate(film, 0, {0, 0, 7, 16}), once * f * f / (1 - f * f), 1e-3, 1e-3));
    EXPECT_TRUE(agrees(film_estimate(film, 0, {9, 0, 16, 16}), once / (1 - f * f), 1e-3, 1e-4));
}

TEST(Glass, ACeilingOfWaterReflectsTotallyBeyondTheCriticalAngle) {
    for (const double degrees : {20.0, 41.0, 42.5, 60.0, 78.0}) {
        const double angle = degrees * PI / 180, f = fresnel_reflectance(std::cos(angle), 1.5);
        EXPECT_EQ(f == 1, degrees > 41.8103) << degrees;
        for (const Integrator integrator : TREES_AND_PATH) {
            GlassSea scene;
            scene.look_at_point({-std::sin(angle), -std::cos(angle), 0}, {0, 0, 0});
            scene.options.transport.integrator = integrator;
            const Film film = scene.render().film;
            SCOPED_TRACE(std::to_string(degrees) + " degrees, " + name_of(integrator));
            EXPECT_TRUE(agrees(film_estimate(film, 0), (1 - f) * 2.25, 3e-3, 1e-4));
            EXPECT_TRUE(agrees(film_estimate(film, 1), f, 1e-2, 1e-4));
        }
    }
}

TEST(Panes, ASunShinesThroughAStack) {
    FloorBelowPanes scene;
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(2), 0}};
    scene.expect([](int channel) { return 0.5 / PI * 2 * passes(1, channel); }, 1e-5);
}

TEST(Panes, APointShinesThroughAStackByItsAngle) {
    FloorBelowPanes scene;
    scene.options.light.points = {{{1.7, 2, 0.05}, glm::dvec3(10)}};
    scene.expect([](int channel) { return 0.5 / PI * 10 / 6.25 * 0.8 * passes(0.8, channel); },
                 2e-3); // the point is seen over the picture's side
}

TEST(Panes, TheSkyShinesThroughAStack) {
    FloorBelowPanes scene;
    scene.options.light.environment = glm::dvec3(1);
    scene.expect([](int channel) { return 0.5 * mean_passes(channel); }, 2e-2);
}

TEST(Panes, ALampShinesThroughAStack) {
    FloorBelowPanes scene;
    scene.options.light.two_sided = true;
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp").floor(600, 2);
    scene.expect([](int channel) { return 0.5 * mean_passes(channel); }, 2e-2);
}

TEST(Panes, CrossingsHaveNoLetterAndAreNoSegment) {
    FloorBelowPanes scene;
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(2), 0}};
    scene.options.transport.max_depth = 8;
    scene.look_at_point({0.2, 5, 0.05}, {0.2, 0, 0.05});
    scene.options.transport.paths = "LDE";
    EXPECT_TRUE(
        agrees(film_estimate(scene.render().film, 2), 0.5 / PI * 2 * std::pow(0.96, 2 * STACK), 2e-2));
}

// Rough reflections find the lamp by shadow rays and by rays of their own, both through the panes.
TEST(Panes, BothWaysToALampBehindThemAreWeightedAgainstEachOther) {
    TestScene scene;
    scene.build.material("metal", "Kd 1 1 1\nPm 1\nPr 0.4").use("metal").floor(3);
    scene.build.material("pane", "Ni 1.5\nillum 7\nthin_walled 1").use("pane").floor(9, 1).floor(9, 1.5);
    scene.build.material("lamp", "Kd 0 0 0\nKe 20 20 20")
        .use("lamp")
        .polygon({{0.1, 2, -0.6}, {0.3, 2, -0.6}, {0.3, 2, -0.4}, {0.1, 2, -0.4}});
    scene.look_at_point({0.2, 0.7, 0.25}, {0.2, 0, 0.05});
    scene.options.light.environment = glm::dvec3(0);
    scene.options.transport.max_depth = 2;
    scene.options.transport.min_contribution = 0;
    scene.options.sampling.spp = 1024;
    const Estimate path = film_estimate(scene.render().film);
    scene.options.transport.integrator = Integrator::DISTRIBUTION;
    const Estimate tree = film_estimate(scene.render().film);
    EXPECT_GT(path.mean, 0.1);
    EXPECT_LT(path.error, 5e-3 * path.mean);
    EXPECT_NEAR(tree.mean, path.mean, 5 * std::hypot(tree.error, path.error));
}

TEST(Panes, PathsFromBothEndsCrossThemAlike) {
    Room room;
    room.build.material("clear", "Ni 1.5\nillum 7\nthin_walled 1");
    room.build.material("tinted", "Ni 1.5\nillum 7\nTf 0.5 0.9 0.7\nthin_walled 1");
    room.add_lamp();
    room.options.light.suns = {{{1, 2, 1}, {2, 2, 1}, 5}};
    room.build.use("clear").polygon({{-3, 0, 2}, {3, 0, 2}, {3, 3, 2}, {-3, 3, 2}}); // before the camera
    room.build.use("tinted").polygon({{-3, 1.2, -2}, {3, 1.2, -2}, {3, 1.2, 2}, {-3, 1.2, 2}});
    room.options.sampling.spp = 1024;
    const TileMeans path = tile_means(room, room.options, Integrator::PATH, "");
    for (const Integrator integrator : {Integrator::PATH_LIGHT, Integrator::BDPT})
        expect_equal(tile_means(room, room.options, integrator, ""), path, 0.08);
}

} // namespace clrt
