// SPDX-License-Identifier: Apache-2.0
// Lamps whose map is mostly dark: the light of their texels in every integrator, and with how much noise.
#include "probes/closed_forms.h"
#include "scene/split_emitters.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Radiance 40 within a square of a sixteenth of a lamp's side about (5/16, 11/16), bilinear at its rim; else
/// 0.01.
constexpr int TEXELS = 16;
constexpr double BRIGHT = 40, DARK = 0.01;

double texel(int x, int row) {
    return x == 5 && row == 4 ? BRIGHT : DARK;
}

/// A lamp of 2 x 2 at the height 1 over a floor.
struct SpottedLamp : TestScene {
    SpottedLamp() {
        std::vector<float> texels;
        for (int row = 0; row < TEXELS; ++row)
            for (int x = 0; x < TEXELS; ++x)
                texels.push_back(float(texel(x, row)));
        texture("spot.exr", TEXELS, TEXELS, 1, texels);
        build.material("matte", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nmap_Ke spot.exr");
        build.use("matte").floor(9).use("lamp");
        build.textured_quad({{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}});
    }
};

/// Irradiance of the floor by the lamp's bilinear map, in squares of a sixteenth of a texel.
double irradiance_at(const glm::dvec3& point) {
    constexpr int PARTS = 16 * TEXELS;
    const auto at = [](int x, int row) { return texel((x + TEXELS) % TEXELS, (row + TEXELS) % TEXELS); };
    double sum = 0;
    for (int i = 0; i < PARTS; ++i)
        for (int k = 0; k < PARTS; ++k) {
            const double u = (i + 0.5) / PARTS, v = (k + 0.5) / PARTS;
            const double x = u * TEXELS - 0.5, y = (1 - v) * TEXELS - 0.5;
            const int left = int(std::floor(x)), top = int(std::floor(y));
            const double fx = x - left, fy = y - top;
            const double radiance = (at(left, top) * (1 - fx) + at(left + 1, top) * fx) * (1 - fy) +
                                    (at(left, top + 1) * (1 - fx) + at(left + 1, top + 1) * fx) * fy;
            const glm::dvec3 way = glm::dvec3(2 * u - 1, 1, 2 * v - 1) - point;
            const double square = glm::dot(way, way);
            sum += radiance * way.y * way.y / (square * square) * (4.0 / PARTS / PARTS);
        }
    return sum;
}

} // namespace

TEST(MappedEmission, EveryIntegratorGivesTheLightOfTheTexels) {
    SpottedLamp scene;
    const glm::dvec3 point(0.8, 0, 0.1);
    const double expected = 0.5 * irradiance_at(point) / PI;
    scene.look_at_point({3, 0.8, 0.4}, point);
    for (const Integrator integrator : {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT,
                                        Integrator::DISTRIBUTION, Integrator::WHITTED, Integrator::RAYCAST}) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), expected, 1e-2, 1e-4)) << name_of(integrator);
    }
    scene.options.transport.integrator = Integrator::PATH;
    scene.options.device.precision = Precision::DOUBLE;
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), expected, 1e-2, 1e-4)) << "double";
}

TEST(MappedEmission, PathsFromTheLampAgree) {
    SpottedLamp scene;
    scene.look({0, 3, 4}, {0, 0, 0}, 60);
    scene.options.sampling.spp = 256;
    const Film path = scene.render().film;
    for (const Integrator integrator : {Integrator::LIGHT, Integrator::BDPT, Integrator::MLT}) {
        scene.options.transport.integrator = integrator;
        expect_equal_means(scene.render().film, path, name_of(integrator));
    }
}

TEST(MappedEmission, BrightTexelsAreFoundWithoutNoise) {
    SpottedLamp scene;
    scene.look_at_point({3, 0.8, 0.4}, {0.8, 0, 0.1});
    for (const Integrator integrator : {Integrator::PATH, Integrator::RAYCAST}) {
        scene.options.transport.integrator = integrator;
        scene.finish = nullptr;
        const double by_map = film_estimate(scene.render().film).error;
        scene.finish = unite_emitters;
        const double evenly = film_estimate(scene.render().film).error;
        EXPECT_GT(evenly * evenly, 10 * by_map * by_map) << name_of(integrator);
    }
}

} // namespace clrt
