// SPDX-License-Identifier: Apache-2.0
// Panoramas: pixels show the solid angles that they should, and the equirectangular one is a lat-long map.
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double PI = glm::pi<double>();

/// A rectangular lamp of radiance 1 before a camera that looks at its middle or elsewhere.
class LampScene : public TestScene {
public:
    LampScene(Projection projection, const glm::dvec3& at) {
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
        build.polygon({CORNERS[0], CORNERS[1], CORNERS[2], CORNERS[3]});
        options.camera.eye = glm::dvec3(0);
        options.camera.at = at;
        options.camera.projection = projection;
        options.light.environment = glm::dvec3(0);
        options.transport.max_depth = 1;
    }
    static constexpr glm::dvec3 CORNERS[4] = {
        {-0.7, -0.5, -1}, {0.7, -0.5, -1}, {0.7, 0.5, -1}, {-0.7, 0.5, -1}};
};

/// The solid angle of a rectangle of half sides a and b before the eye at distance d.
double rectangle_angle(double a, double b, double d) {
    return 4 * std::atan(a * b / (d * std::sqrt(a * a + b * b + d * d)));
}

/// Solid angle of a pixel: equirectangular exactly, fisheye at its middle.
double pixel_angle(Projection projection, double fov, const glm::ivec2& size, int x, int y) {
    if (projection == PROJECTION_EQUIRECTANGULAR)
        return 2 * PI / size.x * (std::cos(PI * y / size.y) - std::cos(PI * (y + 1) / size.y));
    const double pixel = fov * PI / 180 / size.y,
                 angle = pixel * std::hypot(x + 0.5 - size.x / 2., y + 0.5 - size.y / 2.);
    return pixel * pixel * std::sin(angle) / angle;
}

} // namespace

TEST(Panorama, PixelsTimesTheirSolidAnglesAreThatOfTheLamp) {
    const double expected = rectangle_angle(0.7, 0.5, 1);
    for (const glm::dvec3& at : {glm::dvec3(0, 0, -1), glm::dvec3(1, 0.3, -0.4), glm::dvec3(-0.2, 1, 0.1)})
        for (const Projection projection : {PROJECTION_EQUIRECTANGULAR, PROJECTION_FISHEYE}) {
            LampScene scene(projection, at);
            const bool is_fisheye = projection == PROJECTION_FISHEYE;
            // Pixels are small beside the lamp: at its edge their means stand for their parts.
            scene.options.film.size = is_fisheye ? glm::ivec2(64, 64) : glm::ivec2(64, 32);
            const double fov = 240;
            if (is_fisheye)
                scene.options.camera.fov_degrees = fov;
            const Film film = scene.render().film;
            double found = 0;
            for (int y = 0; y < film.height; ++y)
                for (int x = 0; x < film.width; ++x)
                    found += film_pixel(film, x, y).x *
                             pixel_angle(projection, fov, scene.options.film.size, x, y);
            EXPECT_NEAR(found / expected, 1, 2e-3) << name_of(projection) << " " << at.x;
        }
}

TEST(Panorama, AFisheyesAngleGrowsWithTheDistanceFromTheMiddle) {
    // A lamp that fills all directions more than 60 degrees off the axis: a cone cut out of darkness.
    TestScene scene;
    scene.options.camera.eye = glm::dvec3(0);
    scene.options.camera.at = glm::dvec3(0, 0, -1);
    scene.options.camera.projection = PROJECTION_FISHEYE;
    scene.options.camera.fov_degrees = 180;
    scene.options.light.environment = glm::dvec3(1);
    scene.options.transport.max_depth = 1;
    scene.options.film.size = {60, 60};
    // A square screen of half side tan(60) at distance 1: its middle row ends at 60 degrees, pixel 40 of 60.
    const double side = std::tan(PI / 3);
    scene.build.material("black", "Kd 0 0 0").use("black");
    scene.build.polygon({{-side, -side, -1}, {side, -side, -1}, {side, side, -1}, {-side, side, -1}});
    const Film film = scene.render().film;
    double row = 0;
    for (int x = 0; x < 60; ++x)
        row += (film_pixel(film, x, 29).x + film_pixel(film, x, 30).x) / 2;
    EXPECT_NEAR(row, 60 - 2 * 20, 0.1);
}

TEST(Panorama, TheEquirectangularPictureIsTheMapOfWhatItSees) {
    // +X is the middle of a map; its picture from there has the map's pixels, but for the bilinear lookup.
    constexpr int WIDTH = 16, HEIGHT = 8;
    std::vector<float> map;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            map.insert(map.end(), {1 + 0.1f * float(x), 1 + 0.2f * float(y), 1});
    TestScene scene;
    scene.texture("sky.exr", WIDTH, HEIGHT, 3, map);
    scene.build.raw("v 0 -9 0\nv 0.01 -9 0\nv 0 -9 0.01\nf 1 2 3");
    scene.options.light.environment_file = scene.folder.file("sky.exr");
    scene.options.camera.eye = glm::dvec3(0);
    scene.options.camera.at = glm::dvec3(1, 0, 0);
    scene.options.camera.projection = PROJECTION_EQUIRECTANGULAR;
    scene.options.film.size = {WIDTH, HEIGHT};
    scene.options.transport.max_depth = 1;
    const Film film = scene.render().film;
    for (int y = 1; y < HEIGHT - 1; ++y)
        for (int x = 1; x < WIDTH - 1; ++x) {
            const glm::dvec3 pixel = film_pixel(film, x, y);
            EXPECT_NEAR(pixel.x, 1 + 0.1 * x, 0.01) << x << " " << y;
            EXPECT_NEAR(pixel.y, 1 + 0.2 * y, 0.02) << x << " " << y;
        }
}

} // namespace clrt
