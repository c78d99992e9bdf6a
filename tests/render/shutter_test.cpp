// SPDX-License-Identifier: Apache-2.0
// Pictures of what moves while the shutter is open.
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr int SIDE = 16;

/// A square lamp of 4 x 4 pixels in the middle of a picture of parallel rays, a unit a pixel.
class LampScene : public TestScene {
public:
    LampScene() {
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
        build.polygon({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
        options.camera.eye = glm::dvec3(0, 0, 5);
        options.camera.at = glm::dvec3(0);
        options.camera.projection = PROJECTION_ORTHOGRAPHIC;
        options.camera.ortho_height = SIDE;
        options.light.environment = glm::dvec3(0);
        options.transport.max_depth = 1;
        options.sampling.spp = 4096;
    }
    /// Moves the camera to the right by so much from time 0 to 1.
    void move(double way) {
        options.camera.end_eye = *options.camera.eye + glm::dvec3(way, 0, 0);
        options.camera.end_at = *options.camera.at + glm::dvec3(way, 0, 0);
    }
};

/// The share of time and of a pixel's width, which begins at `x`, in which the lamp is there that begins at
/// -2 and moves by `way` to the left from time `open` to `close`.
double coverage(double x, double way, double open, double close) {
    constexpr int STEPS = 20000;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double t = open + (close - open) * (i + 0.5) / STEPS, left = -2 - way * t;
        sum += std::max(0.0, std::min(x + 1, left + 4) - std::max(x, left)) / STEPS;
    }
    return sum;
}

} // namespace

TEST(Shutter, AMovingCameraBlursEdgesAsTheirCoverageSays) {
    for (const glm::dvec2& times : {glm::dvec2(0, 1), glm::dvec2(0.25, 0.5)}) {
        LampScene scene;
        scene.move(3.5);
        scene.options.camera.shutter = times;
        const Film film = scene.render().film;
        for (int x = 0; x < SIDE; ++x) {
            const Estimate found = film_estimate(film, 0, {x, 7, x + 1, 8});
            EXPECT_NEAR(found.mean, coverage(x - 8, 3.5, times.x, times.y), 6 * found.error + 2e-3) << x;
        }
        EXPECT_NEAR(film_estimate(film).mean, 16. / 256, 1e-3);
    }
}

TEST(Shutter, AClosedShutterHasTheBitsOfThePictureOfItsMoment) {
    for (const double time : {0.0, 0.25, 1.0})
        for (const bool all : {true, false}) {
            LampScene moving;
            moving.move(4);
            moving.options.camera.shutter = glm::dvec2(time, time);
            LampScene still;
            *still.options.camera.eye += glm::dvec3(4 * time, 0, 0);
            *still.options.camera.at += glm::dvec3(4 * time, 0, 0);
            moving.options.sampling.spp = still.options.sampling.spp = 64;
            moving.options.effects.all = still.options.effects.all = all;
            EXPECT_EQ(moving.render().film.sums, still.render().film.sums) << time;
        }
}

TEST(Shutter, PartsOfTheOpeningSumToTheWhole) {
    const auto render = [](double open, double close) {
        LampScene scene;
        scene.move(4);
        scene.options.camera.shutter = glm::dvec2(open, close);
        return scene.render().film;
    };
    const Film all = render(0, 1), first = render(0, 0.5), second = render(0.5, 1);
    for (int x = 0; x < SIDE; ++x) {
        const Crop pixel{x, 6, x + 1, 10};
        const Estimate a = film_estimate(all, 0, pixel), b = film_estimate(first, 0, pixel),
                       c = film_estimate(second, 0, pixel);
        EXPECT_NEAR(a.mean, (b.mean + c.mean) / 2, 6 * (a.error + b.error + c.error) + 1e-3) << x;
    }
}

} // namespace clrt
