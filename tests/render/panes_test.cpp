// SPDX-License-Identifier: Apache-2.0
// Light through smooth thin walls in pictures: closed forms behind stacks of panes, for every kind of light,
// and the same means by paths from both ends. A crossing is no event: no segment, no letter.
#include "probes/closed_forms.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

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
            build.floor(60, 1 + 0.1 * i);
        look_at_point({0.3, 0.5, 0.6}, {0, 0, 0});
        options.transport.max_depth = 2;
        options.transport.min_contribution = 0;
        options.light.environment = glm::dvec3(0);
        options.sampling.spp = 256;
    }

    void expect(double (*radiance)(int channel), double sharpness) {
        for (const Integrator integrator :
             {Integrator::RAYCAST, Integrator::WHITTED, Integrator::DISTRIBUTION, Integrator::PATH,
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

TEST(Panes, ASunShinesThroughAStack) {
    FloorBelowPanes scene;
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(2), 0}};
    scene.expect([](int channel) { return 0.5 / PI * 2 * passes(1, channel); }, 1e-5);
}

TEST(Panes, APointShinesThroughAStackByItsAngle) {
    FloorBelowPanes scene;
    scene.options.light.points = {{{1.5, 2, 0}, glm::dvec3(10)}};
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
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp").floor(300, 2);
    scene.expect([](int channel) { return 0.5 * mean_passes(channel); }, 2e-2);
}

TEST(Panes, CrossingsHaveNoLetterAndAreNoSegment) {
    FloorBelowPanes scene;
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(2), 0}};
    scene.options.transport.max_depth = 8;
    scene.look_at_point({0, 5, 0}, {0, 0, 0});
    for (const Integrator integrator : {Integrator::DISTRIBUTION, Integrator::PATH}) {
        scene.options.transport.integrator = integrator;
        scene.options.transport.paths = "LDE";
        EXPECT_TRUE(agrees(film_estimate(scene.render().film, 2), 0.5 / PI * 2 * std::pow(0.96, 2 * STACK),
                           integrator == Integrator::PATH ? 2e-2 : 1e-5))
            << name_of(integrator);
    }
}

// Rough reflections find the lamp by shadow rays and by rays of their own, both through the panes.
TEST(Panes, BothWaysToALampBehindThemAreWeightedAgainstEachOther) {
    TestScene scene;
    scene.build.material("metal", "Kd 1 1 1\nPm 1\nPr 0.4").use("metal").floor(3);
    scene.build.material("pane", "Ni 1.5\nillum 7\nthin_walled 1").use("pane").floor(9, 1).floor(9, 1.5);
    scene.build.material("lamp", "Kd 0 0 0\nKe 3 3 3")
        .use("lamp")
        .polygon({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    scene.look_at_point({0, 0.7, 1}, {0, 0, 0});
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
