// SPDX-License-Identifier: Apache-2.0
// Smooth glass in pictures: Fresnel's parts of a slab, Snell's directions, total reflection, and tint.
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
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
    scene.options.sampling.spp = 256;
    scene.options.transport.min_contribution = 0;
    scene.look_at_point({0, 0, 5}, {0, 0, -2});
    for (const Integrator integrator : {Integrator::WHITTED, Integrator::DISTRIBUTION}) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.9 * 0.96, 1e-4)) << name_of(integrator);
    }
    scene.options.transport.integrator = Integrator::PATH;
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.9 * 0.96, 1e-2));
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

} // namespace clrt
