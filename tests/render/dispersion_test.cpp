// SPDX-License-Identifier: Apache-2.0
// Glass that bends colours apart: each by Snell's law and Fresnel's equations for its own index, whichever
// integrator, and nothing changes where the indices are equal.
#include "probes/closed_forms.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Dominant wavelengths of the primaries of sRGB, and Fraunhofer's lines, in nm.
const double PRIMARIES[3] = {611.4, 549.1, 464.2};
constexpr double LINE_C = 656.27, LINE_D = 587.56, LINE_F = 486.13;

double inverse_square(double x) {
    return 1 / (x * x);
}

/// The index of a colour by Cauchy's formula, of which n_d and the Abbe number are given.
double index_of(int channel, double n, double abbe) {
    const double b = (n - 1) / abbe / (inverse_square(LINE_F) - inverse_square(LINE_C));
    return n + b * (inverse_square(PRIMARIES[channel]) - inverse_square(LINE_D));
}

const Integrator ALL_THAT_DISPERSE[] = {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT,
                                        Integrator::WHITTED, Integrator::DISTRIBUTION};

constexpr double INDEX = 1.5, ABBE = 2;

/// A slab of glass between z = -0.5 and 0.5, and a lamp at z = -2 that shines towards +z from x = `edge` on.
class FlintSlab : public TestScene {
public:
    explicit FlintSlab(double edge) {
        build.material("flint", fmt::format("Ni {}\nillum 7\nabbe {}", INDEX, ABBE));
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("flint").box({-60, -60, -0.5}, {60, 60, 0.5});
        build.use("lamp").polygon({{edge, -50, -2}, {50, -50, -2}, {50, 50, -2}, {edge, 50, -2}});
        options.transport.max_depth = 3;
        options.transport.min_contribution = 0;
        options.sampling.spp = 512;
        const double sine = std::sqrt(0.5);
        look_at_point({-3 * sine, 0, 0.5 + 3 * sine}, {0, 0, 0.5});
    }
};

/// Where the ray lands that meets the slab at x = 0, at 45 degrees.
double landing(double index) {
    return std::tan(std::asin(std::sqrt(0.5) / index)) + 1.5;
}

/// Balls of glass on a floor below a lamp, smooth and rough, and part of one only.
class FlintBalls : public TestScene {
public:
    explicit FlintBalls(const std::string& abbe) {
        build.material("smooth", "Ni 1.6\nillum 7\n" + abbe);
        build.material("rough", "Ni 1.5\nillum 7\nPr 0.5\n" + abbe);
        build.material("part", "Kd 0.7 0.5 0.3\nPm 0\nPr 0.4\nTf 0.6\nNi 1.5\n" + abbe);
        build.material("floor", "Kd 0.6 0.6 0.6").material("lamp", "Kd 0 0 0\nKe 6 6 6");
        build.use("smooth").icosphere({-0.8, 0.4, 0}, 0.35, 2);
        build.use("rough").box({-0.3, 0.1, -0.3}, {0.3, 0.7, 0.3});
        build.use("part").icosphere({0.8, 0.4, 0}, 0.35, 1);
        build.use("floor").floor(3).use("lamp").polygon({{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}});
        look({0, 1.2, 3}, {0, 0.4, 0}, 40);
        options.transport.max_depth = 10;
        options.transport.min_contribution = 0;
        options.sampling.spp = 256;
    }
};

/// A floor seen through smooth flint below a lamp behind rough flint: most connections join one colour to
/// one.
class FlintPanes : public TestScene {
public:
    FlintPanes() {
        build.material("smooth", "Ni 1.6\nillum 7\nabbe 10")
            .material("rough", "Ni 1.5\nillum 7\nPr 0.6\nabbe 10");
        build.material("floor", "Kd 0.8 0.8 0.8").material("lamp", "Kd 0 0 0\nKe 6 6 6");
        build.use("smooth")
            .box({-2, 0.5, 1}, {2, 2.5, 1.2})
            .use("rough")
            .box({-1.4, 1.3, -1.4}, {1.4, 1.5, 0.8});
        build.use("floor").floor(1.5).use("lamp").polygon(
            {{-1, 1.7, -1}, {1, 1.7, -1}, {1, 1.7, 0.5}, {-1, 1.7, 0.5}});
        look({0, 1.6, 2}, {0, 0, -0.2}, 25);
        options.transport.max_depth = 8;
        options.sampling.spp = 1024;
        options.light.environment = glm::dvec3(0);
    }
};

} // namespace

TEST(Dispersion, EveryColourLeavesASlabWhereItsIndexSays) {
    for (int edge = 0; edge < 3; ++edge)
        for (const Integrator integrator : {Integrator::WHITTED, Integrator::DISTRIBUTION}) {
            FlintSlab scene(landing(index_of(edge, INDEX, ABBE)));
            scene.options.transport.integrator = integrator;
            const Film film = scene.render().film;
            for (int channel = 0; channel < 3; ++channel) {
                const double index = index_of(channel, INDEX, ABBE);
                const double passes = std::pow(1 - fresnel_reflectance(std::sqrt(0.5), 1 / index), 2);
                SCOPED_TRACE(fmt::format("{}, channel {}, edge at {}", name_of(integrator), channel, edge));
                const bool left = channel < edge, right = channel <= edge; // red goes farthest
                EXPECT_TRUE(
                    agrees(film_estimate(film, channel, {0, 0, 7, 16}), left ? passes : 0, 2e-2, 1e-6));
                EXPECT_TRUE(
                    agrees(film_estimate(film, channel, {9, 0, 16, 16}), right ? passes : 0, 2e-2, 1e-6));
            }
        }
}

TEST(Dispersion, SmoothGlassReflectsEveryColourByItsOwnFresnel) {
    FlintSlab scene(1000); // the lamp is not seen through the slab
    scene.build.use("lamp").polygon({{90, -50, 50}, {-20, -50, 50}, {-20, 50, 50}, {90, 50, 50}});
    scene.options.transport.max_depth = 2;
    for (const auto& [integrator, sharpness] :
         {std::pair{Integrator::WHITTED, 1e-5}, {Integrator::PATH, 3e-2}}) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_TRUE(agrees(film_estimate(film, channel),
                               fresnel_reflectance(std::sqrt(0.5), 1 / index_of(channel, INDEX, ABBE)),
                               sharpness, 1e-4))
                << name_of(integrator) << ", channel " << channel;
    }
}

TEST(Dispersion, WithEqualIndicesThePictureIsThatOfPlainGlass) {
    FlintBalls plain(""), flint("abbe 1e8");
    for (const Integrator integrator : ALL_THAT_DISPERSE) {
        plain.options.transport.integrator = flint.options.transport.integrator = integrator;
        const Film expected = plain.render().film, film = flint.render().film;
        for (int channel = 0; channel < 3; ++channel) {
            const Estimate a = film_estimate(expected, channel), b = film_estimate(film, channel);
            EXPECT_NEAR(a.mean, b.mean, 5 * std::hypot(a.error, b.error))
                << name_of(integrator) << ", channel " << channel;
            EXPECT_LT(b.error, 3e-2 * b.mean) << name_of(integrator);
        }
    }
}

TEST(Dispersion, PathsFromBothEndsAgreeOnEveryColour) {
    FlintBalls scene("abbe 4");
    const Film path = scene.render().film;
    for (const Integrator integrator : {Integrator::BDPT, Integrator::PATH_LIGHT, Integrator::MLT}) {
        scene.options.transport.integrator = integrator;
        expect_equal_means(path, scene.render().film, name_of(integrator));
    }
}

TEST(Dispersion, BothEndsOfAConnectionHaveOneColour) {
    FlintPanes scene;
    const Film path = scene.render().film;
    scene.options.transport.integrator = Integrator::BDPT;
    const Film bdpt = scene.render().film;
    for (int channel = 0; channel < 3; ++channel) {
        const Estimate a = film_estimate(path, channel), b = film_estimate(bdpt, channel);
        const double error = std::hypot(a.error, b.error);
        EXPECT_NEAR(a.mean, b.mean, 5 * error) << "channel " << channel;
        EXPECT_LT(error, 0.02 * a.mean) << "or the test could not tell";
    }
}

TEST(Dispersion, ABallOfGlassInAWhiteRoomIsNotSeen) {
    for (const char* const keys : {"Ni 1.5\nillum 7\nabbe 10", "Ni 1.5\nillum 7\nabbe 10\nPr 0.5"}) {
        TestScene scene;
        scene.build.material("flint", keys).use("flint").icosphere({0, 0, 0}, 1, 2);
        scene.look({0, 0, 5}, {0, 0, 0}, 15);
        scene.options.light.environment = glm::dvec3(1);
        scene.options.transport.max_depth = 60;
        scene.options.sampling.spp = 512;
        for (const Integrator integrator : {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT}) {
            scene.options.transport.integrator = integrator;
            const Film film = scene.render().film;
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_TRUE(agrees(film_estimate(film, channel), 1, 1e-2, 1e-3))
                    << keys << ", " << name_of(integrator) << ", channel " << channel;
        }
    }
}

} // namespace clrt
