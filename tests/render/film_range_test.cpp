// SPDX-License-Identifier: Apache-2.0
// The film holds every light: mapped lamps far brighter than their scene, points beside a wall, suns nearly
// without a disc. Against closed forms.
#include "film/film.h"
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::WHITTED, Integrator::RAYCAST};

/// Nothing was kept out of the sums.
void expect_no_bad_sample(const Render& render) {
    EXPECT_EQ(render.counts.bad(), 0u);
    EXPECT_EQ(render.counts.overflow, 0u);
}

/// A lamp of a thousandth of the scene's size fills the picture; `map` is what follows map_Ke.
Render render_small_lamp(const std::string& map, Integrator integrator) {
    TestScene scene;
    scene.texture("lamp.exr", 1, 1, 3, {0.5f, 0.25f, 1});
    scene.build.material("dark", "Kd 0 0 0").material("lamp", "Kd 0 0 0\nKe 1 1 1\nmap_Ke " + map);
    scene.build.use("dark").floor(1, -0.5);
    const double h = 2e-4;
    scene.build.use("lamp").textured_quad({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
    scene.look({0, 0, 1}, {0, 0, 0}, 0.01);
    scene.options.transport.integrator = integrator;
    scene.options.sampling.spp = 64;
    return scene.render();
}

/// Mean irradiance of a square of half side `a` by a point of intensity 1 at distance d above its centre: its
/// solid angle over its area.
double square_irradiance(double a, double d) {
    return 4 * std::atan(a * a / (d * std::sqrt(2 * a * a + d * d))) / (4 * a * a);
}

} // namespace

TEST(FilmRange, AMappedLampOfHighGainRendersItsRadiance) {
    for (const Integrator integrator : INTEGRATORS) {
        SCOPED_TRACE(name_of(integrator));
        const Render render = render_small_lamp("-mm 0 100000 lamp.exr", integrator);
        expect_no_bad_sample(render);
        EXPECT_TRUE(agrees(film_estimate(render.film, 0), 5e4));
        EXPECT_TRUE(agrees(film_estimate(render.film, 2), 1e5));
    }
}

TEST(FilmRange, TheBaseOfAMapCounts) {
    const Render render = render_small_lamp("-mm 1000000 -800000 lamp.exr", Integrator::PATH);
    expect_no_bad_sample(render);
    EXPECT_TRUE(agrees(film_estimate(render.film, 0), 6e5));
    EXPECT_TRUE(agrees(film_estimate(render.film, 1), 8e5));
    EXPECT_TRUE(agrees(film_estimate(render.film, 2), 2e5));
}

TEST(FilmRange, PointsBesideAWallLightItAsTheSolidAngleSays) {
    for (const double distance : {1e-4, 1e-5})
        for (const Integrator integrator : INTEGRATORS) {
            SCOPED_TRACE(std::string(name_of(integrator)) + " at " + std::to_string(distance));
            TestScene scene;
            scene.build.material("matte", "Kd 0.5 0.5 0.5").use("matte").floor(1);
            // Off the diagonal: points at the edges of triangles are kept a few offset bounds inside.
            scene.options.light.points.push_back({{0.25, distance, 0.125}, {3, 2, 1}});
            scene.options.transport.integrator = integrator;
            const double half_side = 10 * distance;
            scene.look({0.25, 1, 0.125}, {0.25, 0, 0.125}, 2 * std::atan(half_side) * 180 / PI);
            const Render render = scene.render();
            expect_no_bad_sample(render);
            // Coordinates near 1 are spaced by 1.2e-7, which is a hundredth of the smaller distance.
            const double rounding = 0.5 * 1.2e-7 / distance;
            const double expected = 0.5 / PI * square_irradiance(half_side, distance);
            EXPECT_TRUE(agrees(film_estimate(render.film, 0), 3 * expected, 2e-3, rounding));
            EXPECT_TRUE(agrees(film_estimate(render.film, 2), 1 * expected, 2e-3, rounding));
        }
}

TEST(FilmRange, TheSmallestDiscOfASunLeavesTheQuantumFine) {
    constexpr double IRRADIANCE = 3, RADIUS = 1.01e-6;
    for (const Integrator integrator : INTEGRATORS) {
        SCOPED_TRACE(name_of(integrator));
        TestScene scene;
        scene.build.material("matte", "Kd 0.5 0.5 0.5").use("matte").floor(1);
        scene.options.light.suns.push_back({{0.6, 0.8, 0}, {IRRADIANCE, 1, 1}, 2 * RADIUS * 180 / PI});
        scene.options.transport.integrator = integrator;
        scene.options.sampling.spp = 128;
        scene.look_at_point({0.5, 0.8, 0.4}, {0, 0, 0});
        ASSERT_GT(scene.load().lights.at(0).one_minus_cos, 0) << "it has a disc";
        const Render render = scene.render();
        expect_no_bad_sample(render);
        // What rounding to quanta scatters stays a hundred thousandth of the irradiance a sample.
        EXPECT_LT(render.film.scale.quantum, 1e-5 * IRRADIANCE);
        EXPECT_TRUE(agrees(film_estimate(render.film), 0.8 * IRRADIANCE * 0.5 / PI, 1e-5));
    }
}

TEST(FilmRange, AFilmFullOfASmallDiscHoldsItsRadiance) {
    // The camera looks into the sun with so narrow a view that all samples meet the disc.
    constexpr double RADIUS = 1e-4;
    TestScene scene;
    scene.build.material("matte", "Kd 0.5 0.5 0.5").use("matte").floor(1, -0.5);
    scene.options.light.suns.push_back({{0, 0, -1}, {1, 1, 1}, 2 * RADIUS * 180 / PI});
    scene.look({0, 0, 0}, {0, 0, -1}, 1e-3);
    scene.options.sampling.spp = 512;
    const Render render = scene.render();
    expect_no_bad_sample(render);
    EXPECT_TRUE(agrees(film_estimate(render.film), 1 / (PI * RADIUS * RADIUS), 1e-6, 1e-5));
}

TEST(FilmRange, ASumThatIsFullStaysFullAndIsReported) {
    // Only discs of suns have so many levels, and only a camera that looks into one sees nothing else.
    TestScene scene;
    scene.build.material("matte", "Kd 0.5 0.5 0.5").use("matte").floor(1, -0.5);
    scene.options.light.suns.push_back({{0, 0, -1}, {1, 1e-9, 0}, 2 * 1.01e-6 * 180 / PI});
    scene.look({0, 0, 0}, {0, 0, -1}, 1e-5);
    scene.options.film.size = {1, 1};
    scene.options.sampling.replicates = 1;
    scene.options.sampling.spp = 512;
    const Render render = scene.render();
    EXPECT_EQ(render.film.sums[0], INT64_MAX);
    EXPECT_LT(render.film.sums[1], INT64_MAX);
    EXPECT_GE(render.counts.overflow, 512u - 256u) << "every sample that finds it full";
    EXPECT_LE(render.counts.overflow, 512u - 128u);
    EXPECT_EQ(render.counts.bad_pixels, (std::map<u32, std::uint64_t>{{0, render.counts.overflow}}));
}

} // namespace clrt
