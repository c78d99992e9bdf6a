// SPDX-License-Identifier: Apache-2.0
// Pictures of the studio: what stands in it is seen, white, grey or black, with a shadow and without a
// horizon, and no room is black.
#include "probes/film_estimate.h"
#include "support/render_scene.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::WHITTED, Integrator::RAYCAST};

double luminance_of(const Film& film, int x, int y) {
    return film_pixel(film, x, y).y;
}

/// A ball in the studio, 32 x 24 pixels.
class BallInStudio : public TestScene {
public:
    explicit BallInStudio(double kd) {
        build.material("ball",
                       "Kd " + std::to_string(kd) + " " + std::to_string(kd) + " " + std::to_string(kd));
        build.use("ball").icosphere({3, 5, 2}, 2, 4, Facing::OUTWARD, Shading::SMOOTH);
        options.light.studio = true;
        options.film.size = {32, 24};
        options.sampling.spp = 256;
    }
};

} // namespace

TEST(StudioPicture, HasNoHorizon) {
    // The ground's far end and the backdrop above it, for each integrator.
    for (const Integrator integrator : INTEGRATORS) {
        BallInStudio scene(0.8);
        scene.options.transport.integrator = integrator;
        scene.look({-9, 5, 26}, {3, 4.2, 2}, 40);
        const Scene loaded = scene.load();
        const Render render = render_loaded(loaded, scene.options);
        for (const int y : {0, 9, 12, 22}) {
            const Estimate left = film_estimate(render.film, 1, {0, y, 6, y + 1});
            EXPECT_NEAR(left.mean / loaded.background->y, 1, 0.01 + 6 * left.error) << "row " << y;
        }
    }
}

TEST(StudioPicture, ShowsWhiteGreyAndBlackThings) {
    for (const double kd : {0.8, 0.5, 0.05}) {
        BallInStudio scene(kd);
        const Scene loaded = scene.load();
        const Render render = render_loaded(loaded, scene.options);
        const double backdrop = loaded.background->y;
        double brightest = 0, largest_contrast = 0, darkest_ground = 1;
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x) {
                const double value = luminance_of(render.film, x, y);
                brightest = std::max(brightest, value);
                largest_contrast = std::max(largest_contrast, std::fabs(std::log2(value / backdrop)));
                darkest_ground = std::min(darkest_ground, value);
            }
        EXPECT_LT(brightest, 1) << "Kd " << kd << " is clipped";
        EXPECT_GT(largest_contrast, 1) << "Kd " << kd << ": a stop between it and the backdrop";
        EXPECT_LT(darkest_ground, 0.6 * backdrop) << "Kd " << kd << " has no shadow";
        const double towards_camera = luminance_of(render.film, 16, 12);
        if (kd == 0.8) {
            EXPECT_GT(towards_camera, 2 * backdrop);
        }
        if (kd == 0.05) {
            EXPECT_LT(towards_camera, 0.3 * backdrop);
        }
    }
}

TEST(StudioPicture, AFloorThatLiesOnTheGroundIsSeenWhole) {
    for (const glm::dvec3 up : {glm::dvec3(0, 1, 0), glm::dvec3(1, 2, 2)}) {
        const glm::dvec3 unit = glm::normalize(up), u = glm::normalize(glm::cross(unit, glm::dvec3(0, 0, 1))),
                         v = glm::cross(unit, u);
        TestScene scene;
        scene.build.material("floor", "Kd 0 0 0").use("floor").polygon({-u - v, u - v, u + v, -u + v});
        scene.build.polygon({0.1 * unit, 0.1 * u + 0.1 * unit, 0.1 * v + 0.1 * unit});
        scene.options.light.studio = true;
        scene.options.camera.up = up;
        scene.options.camera.eye = 0.4 * unit + 3.0 * u; // grazing
        scene.options.camera.at = glm::dvec3(0);
        scene.options.camera.fov_degrees = 10;
        scene.options.transport.integrator = Integrator::RAYCAST;
        scene.options.sampling.spp = 64;
        scene.options.sampling.replicates = 8;
        const Render render = scene.render();
        EXPECT_EQ(film_estimate(render.film, 0, {3, 7, 13, 9}).mean, 0);
    }
}

TEST(StudioPicture, AClosedRoomIsNotBlack) {
    TestScene scene;
    scene.options.light.studio = true;
    scene.build.material("wall", "Kd 0.6 0.6 0.6").use("wall").box({0, 0, 0}, {6, 3, 5}, Facing::INWARD);
    scene.options.sampling.spp = 64;
    scene.options.sampling.replicates = 8;
    const double mean = film_estimate(scene.render().film, 1).mean;
    EXPECT_GT(mean, 0.1);
    EXPECT_LT(mean, 0.8);
}

} // namespace clrt
