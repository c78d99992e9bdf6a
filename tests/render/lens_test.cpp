// SPDX-License-Identifier: Apache-2.0
// Pictures through a lens: the blur of a small lamp is the image of the lens, as wide as the closed form
// says.
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double EYE = 6;      ///< along z, from where the camera looks down the axis
constexpr double FOCUS = 4;    ///< depth of the plane in focus
constexpr double LAMP = 0.05;  ///< side of the lamp
constexpr double PIXEL = 0.05; ///< what a pixel shows in the plane in focus
constexpr int SIDE = 32;
constexpr double PI = glm::pi<double>();

/// A small square lamp on the axis, in focus or not.
class LampScene : public TestScene {
public:
    LampScene(Projection projection, double depth, double aperture) {
        const double z = EYE - depth, half = LAMP / 2;
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
        build.polygon({{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
        options.camera.eye = glm::dvec3(0, 0, EYE);
        options.camera.at = glm::dvec3(0);
        options.camera.projection = projection;
        if (projection == PROJECTION_ORTHOGRAPHIC)
            options.camera.ortho_height = SIDE * PIXEL;
        else
            options.camera.fov_degrees = 360 / PI * std::atan(SIDE * PIXEL / FOCUS / 2);
        options.camera.aperture = aperture;
        options.camera.focus = FOCUS;
        options.film.size = {SIDE, SIDE};
        options.light.environment = glm::dvec3(0);
        options.transport.max_depth = 1;
        options.sampling.spp = 8192;
    }
};

/// The whole light of a picture, and the mean square of its distance from the middle, in pixels.
struct Spot {
    double light = 0, mean_square = 0;
};

Spot measure_spot(const Film& film) {
    Spot spot;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            const double light = film_pixel(film, x, y).x, dx = x + 0.5 - SIDE / 2., dy = y + 0.5 - SIDE / 2.;
            spot.light += light;
            spot.mean_square += light * (dx * dx + dy * dy);
        }
    spot.mean_square /= spot.light;
    return spot;
}

/// Mean square distance from the middle of the points of a lens of radius 1: a disc's, or that of the regular
/// polygon in it.
double lens_moment(int blades) {
    return blades == 0 ? 0.5 : (2 + std::cos(2 * PI / blades)) / 6;
}

} // namespace

TEST(Lens, TheBlurOfALampIsTheCircleOfConfusion) {
    // A |S2 - S1| / S2 on the plane in focus at S1 of a point at S2 (parallel rays: A |S2 - S1| / S1).
    constexpr double APERTURE = 0.8;
    for (const Projection projection : {PROJECTION_PERSPECTIVE, PROJECTION_ORTHOGRAPHIC})
        for (const double depth : {2.5, 5.5})
            for (const int blades : {0, 5}) {
                LampScene scene(projection, depth, APERTURE);
                scene.options.camera.blades = blades;
                const Film film = scene.render().film;
                const bool is_parallel = projection == PROJECTION_ORTHOGRAPHIC;
                const double magnification = is_parallel ? 1 : FOCUS / depth;
                const double circle = APERTURE * std::abs(depth - FOCUS) / (is_parallel ? FOCUS : depth);
                const double radius = circle / 2 / PIXEL, lamp = LAMP * magnification / PIXEL;
                const Spot spot = measure_spot(film);
                // Pixels count as their middles: 1/12 a side (Sheppard).
                const double expected = radius * radius * lens_moment(blades) + lamp * lamp / 6 + 1 / 6.;
                // Of n samples that hit, the mean square is known to about 0.6 / sqrt(n) of itself.
                const double hits = spot.light * *scene.options.sampling.spp;
                EXPECT_NEAR(spot.mean_square / expected, 1, 5 * 0.6 / std::sqrt(hits))
                    << name_of(projection) << " " << depth << " " << blades;
                // The lens spreads light and loses none (its cosine is 1 here but for 1 %).
                EXPECT_NEAR(spot.light / (lamp * lamp), 1, 5 / std::sqrt(hits))
                    << name_of(projection) << depth;
                EXPECT_GT(hits, 4000);
            }
}

TEST(Lens, WhatIsInFocusIsSharp) {
    const Film film = LampScene(PROJECTION_PERSPECTIVE, FOCUS, 0.8).render().film;
    EXPECT_NEAR(film_estimate(film, 0, {SIDE / 2 - 1, SIDE / 2 - 1, SIDE / 2 + 1, SIDE / 2 + 1}).mean * 4,
                LAMP * LAMP / (PIXEL * PIXEL), 0.02 * LAMP * LAMP / (PIXEL * PIXEL));
    EXPECT_NEAR(measure_spot(film).light, LAMP * LAMP / (PIXEL * PIXEL),
                0.02 * LAMP * LAMP / (PIXEL * PIXEL));
}

TEST(Lens, ALensOfNoWidthHasTheBitsOfThePinhole) {
    LampScene lens(PROJECTION_PERSPECTIVE, 2.5, 0);
    LampScene pinhole(PROJECTION_PERSPECTIVE, 2.5, 0);
    pinhole.options.camera.aperture.reset();
    pinhole.options.camera.focus.reset();
    for (const bool all : {true, false}) {
        lens.options.effects.all = pinhole.options.effects.all = all;
        EXPECT_EQ(lens.render().film.sums, pinhole.render().film.sums);
    }
}

TEST(Lens, AShiftShowsWhatLiesBesideTheAxis) {
    // A picture shifted by half its size is that quarter of one twice as large.
    LampScene scene(PROJECTION_PERSPECTIVE, 5, 0), wide(PROJECTION_PERSPECTIVE, 5, 0);
    for (LampScene* each : {&scene, &wide})
        each->build.polygon({{0.2, 0.1, 1}, {0.5, 0.1, 1}, {0.5, 0.7, 1}, {0.2, 0.7, 1}});
    wide.options.film.size = {2 * SIDE, 2 * SIDE};
    wide.options.camera.fov_degrees = 360 / PI * std::atan(SIDE * PIXEL / FOCUS);
    scene.options.camera.shift = glm::dvec2(0.5, 0.5);
    scene.options.sampling.spp = wide.options.sampling.spp = 256;
    const Film shifted = scene.render().film, whole = wide.render().film;
    double light = 0;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            const double found = film_pixel(shifted, x, y).x;
            ASSERT_NEAR(found, film_pixel(whole, SIDE + x, y).x, 0.15) << x << " " << y;
            light += found;
        }
    EXPECT_GT(light, 20);
}

} // namespace clrt
