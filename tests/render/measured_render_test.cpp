// SPDX-License-Identifier: Apache-2.0
// Measured BRDFs in pictures: a file made from Lambert's law against Kd, by every integrator; a rough one
// under a white sky.
#include "probes/merl_file.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A ball on a floor under a sky and a lamp; `ball` are its keys.
class Ball : public TestScene {
public:
    explicit Ball(const std::string& ball, Integrator integrator) {
        folder.write("matte.binary", merl_file(matte_and_glossy({0.6, 0.4, 0.2}), {12, 10, 8}));
        build.material("ball", ball)
            .material("floor", "Kd 0.5 0.5 0.5")
            .material("lamp", "Kd 0 0 0\nKe 20 20 20");
        build.use("floor").floor(3);
        build.use("ball").icosphere({0, 1, 0}, 1, 3);
        build.use("lamp").polygon({{-0.4, 3, -0.4}, {0.4, 3, -0.4}, {0.4, 3, 0.4}, {-0.4, 3, 0.4}});
        look({0, 1.5, 5}, {0, 0.8, 0}, 40);
        options.light.environment = glm::dvec3(0.3);
        options.effects.all = false; // small programs
        options.transport.integrator = integrator;
        options.sampling.spp = 256;
    }
};

} // namespace

TEST(MeasuredRender, AMatteFileLooksLikeKdByEveryIntegrator) {
    for (const Integrator integrator :
         {Integrator::PATH, Integrator::LIGHT, Integrator::BDPT, Integrator::RAYCAST}) {
        const Film measured = Ball("Kd 1 0 0\nPc 1\nmerl matte.binary", integrator).render().film;
        expect_equal_means(measured, Ball("Kd 0.6 0.4 0.2", integrator).render().film, name_of(integrator));
    }
}

TEST(MeasuredRender, AWhiteFileIsWhiteUnderAWhiteSky) {
    for (const double cosine : {0.1, 0.6, 1.0}) {
        TestScene furnace;
        furnace.folder.write("white.binary", merl_file(matte_and_glossy(glm::dvec3(1)), {12, 10, 8}));
        furnace.build.material("white", "merl white.binary").use("white").floor(9);
        furnace.look_at_point({std::sqrt(1 - cosine * cosine), cosine, 0}, {0, 0, 0});
        furnace.options.light.environment = glm::dvec3(1);
        furnace.options.effects.all = false;
        const Film film = furnace.render().film;
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_TRUE(agrees(film_estimate(film, channel), 1, 2e-3, 0.01)) << cosine;
    }
}

} // namespace clrt
