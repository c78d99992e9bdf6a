// SPDX-License-Identifier: Apache-2.0
// Pictures in parallel projection: size does not depend on distance, and the film's plane bounds what is
// seen.
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double EYE = 5; ///< along z, from where the camera looks down the axis

/// 16 x 16 pixels, one unit each, of a square lamp on the axis that covers 4 x 4 of them.
class LampScene : public TestScene {
public:
    LampScene(Integrator integrator, double z) {
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
        build.polygon({{-2, -2, z}, {2, -2, z}, {2, 2, z}, {-2, 2, z}});
        options.camera.eye = glm::dvec3(0, 0, EYE);
        options.camera.at = glm::dvec3(0);
        options.camera.projection = PROJECTION_ORTHOGRAPHIC;
        options.camera.ortho_height = 16;
        options.light.environment = glm::dvec3(0);
        options.transport.integrator = integrator;
        options.sampling.spp = 64;
    }
};

/// Mean of a window over the lamp's radiance.
double mean(const Film& film, const Crop& window) {
    return film_estimate(film, 0, window).mean;
}

} // namespace

TEST(Orthographic, ALampCoversTheSamePixelsHoweverFarItLies) {
    for (const Integrator integrator : {Integrator::RAYCAST, Integrator::WHITTED, Integrator::PATH})
        for (const double z : {4.0, 0.0, -100.0}) {
            const Film film = LampScene(integrator, z).render().film;
            EXPECT_NEAR(mean(film, {6, 6, 10, 10}), 1, 1e-6) << z;
            EXPECT_NEAR(mean(film, {0, 0, 16, 16}), 16. / 256, 1e-7) << z;
        }
}

TEST(Orthographic, WhatIsBehindTheFilmIsNotSeen) {
    EXPECT_EQ(mean(LampScene(Integrator::PATH, EYE + 1).render().film, {0, 0, 16, 16}), 0);
}

TEST(Orthographic, LightOnAFloorFollowsLambertsFormulaUnderParallelRays) {
    // A floor under a point light on the axis: E = I cos^4 / h^2 at a distance x from below it, radiance E Kd
    // / pi.
    TestScene scene;
    scene.build.material("floor", "Kd 0.5 0.5 0.5").use("floor");
    scene.build.polygon({{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
    scene.options.camera.eye = glm::dvec3(0, 0, 20);
    scene.options.camera.at = glm::dvec3(0);
    scene.options.camera.projection = PROJECTION_ORTHOGRAPHIC;
    scene.options.camera.ortho_height = 16;
    scene.options.light.environment = glm::dvec3(0);
    constexpr double HEIGHT = 4, INTENSITY = 50;
    scene.options.light.points = {{glm::dvec3(0, 0, HEIGHT), glm::dvec3(INTENSITY)}};
    const Film film = scene.render().film;
    for (const int x : {0, 3, 8, 12}) {
        double expected = 0;
        constexpr int PARTS = 64; // of a pixel's side
        for (int i = 0; i < PARTS * PARTS; ++i) {
            const double px = x - 8 + (i % PARTS + 0.5) / PARTS, py = (i / PARTS + 0.5) / PARTS;
            const double square = px * px + py * py + HEIGHT * HEIGHT;
            expected += INTENSITY * HEIGHT / (square * std::sqrt(square)) / (PARTS * PARTS);
        }
        expected *= 0.5 / 3.14159265358979323846;
        const Estimate found = film_estimate(film, 0, {x, 7, x + 1, 8});
        EXPECT_TRUE(agrees(found, expected, 0.002, 1e-5)) << x;
    }
}

} // namespace clrt
