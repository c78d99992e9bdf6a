// SPDX-License-Identifier: Apache-2.0
// --sampler: both choices give the same expectation; Sobol points bring it with less noise, white noise by
// the known law.
#include "probes/closed_forms.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

const std::vector<glm::dvec3> LAMP = {{-1, 1, -1}, {0.5, 1, -1}, {0.5, 1, 0.7}, {-1, 1, 0.7}};

/// One point of a matte floor below a lamp.
Film floor_below_a_lamp(SamplerChoice sampler, std::uint32_t spp) {
    TestScene scene;
    scene.build.material("matte", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 3 3 3");
    scene.build.use("matte").floor(20).use("lamp").polygon(LAMP);
    scene.look_at_point({3, 0.8, 0.4}, {0, 0, 0});
    scene.options.sampling.sampler = sampler;
    scene.options.sampling.spp = spp;
    return scene.render().film;
}

} // namespace

TEST(SamplerChoice, BothGiveTheSameLightAndSobolLessNoise) {
    const double expected = 3 * 0.5 / PI * polygon_irradiance({0, 0, 0}, {0, 1, 0}, LAMP);
    const Estimate sobol = film_estimate(floor_below_a_lamp(SamplerChoice::SOBOL, 4096));
    const Estimate white = film_estimate(floor_below_a_lamp(SamplerChoice::INDEPENDENT, 4096));
    EXPECT_TRUE(agrees(sobol, expected));
    EXPECT_TRUE(agrees(white, expected));
    // 64 points a replicate and a smooth integrand; the lamp's edge is in view of none of them.
    EXPECT_LT(sobol.error, 0.3 * white.error);
}

TEST(SamplerChoice, WhiteNoiseFallsWithTheSquareRootOfTheSamples) {
    // Of 64 replicates the spread is known to 9 %.
    const Estimate few = film_estimate(floor_below_a_lamp(SamplerChoice::INDEPENDENT, 256));
    const Estimate many = film_estimate(floor_below_a_lamp(SamplerChoice::INDEPENDENT, 4096));
    EXPECT_NEAR(few.error / many.error, 4, 1.6);
}

} // namespace clrt
