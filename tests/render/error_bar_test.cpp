// SPDX-License-Identifier: Apache-2.0
// Whether the printed error is the error of the picture: many renders of small scenes with different seeds
// against a long run.
#include "film/error_slope.h"
#include "film/film_error.h"
#include "probes/statistics.h"
#include "render/kernels.h"
#include "support/drawn.h"
#include "support/render_scene.h"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace clrt {

namespace {

constexpr int SEEDS = 50;
constexpr std::uint32_t SPP = 16, ADAPTIVE_SPP = 64, REFERENCE_SEED = 1000;
/// Samples of a reference over those of the renders. What its noise adds to a realised squared error, (1 /
/// 16) / sqrt(N) of it for N pixels that hold the error, is small against the scatter over the seeds, sqrt(2
/// / 50 / N).
constexpr std::uint32_t REFERENCE_FACTOR = 16;
/// Of 50 intervals of 95 %, 47.5 hold the error on average; fewer than 43 happen once in 200 times.
constexpr int FEWEST_COVERED = 43;
constexpr double LARGEST_BIAS = 0.05; ///< of the estimated error, beyond its scatter over the seeds
constexpr double LARGEST_Z = 3;

/// A room with a lamp, a block that throws soft shadows, and a mirror.
void make_room(TestScene& scene) {
    scene.build.material("white", "Kd 0.7 0.7 0.7").material("red", "Kd 0.6 0.1 0.1");
    scene.build.material("mirror", "Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nillum 3")
        .material("lamp", "Kd 0 0 0\nKe 8 7 5");
    scene.build.use("white").box({-1, 0, -1}, {1, 2, 1}, Facing::INWARD);
    scene.build.use("lamp").polygon({{-0.4, 1.9, -0.4}, {0.4, 1.9, -0.4}, {0.4, 1.9, 0.4}, {-0.4, 1.9, 0.4}});
    scene.build.use("red").box({-0.6, 0.01, -0.5}, {0, 0.8, 0.1});
    scene.build.use("mirror").box({0.2, 0.01, -0.7}, {0.7, 1.1, -0.2});
    scene.look({0.2, 1, 0.9}, {0, 0.7, -1}, 80);
    scene.options.film.size = {32, 32};
    scene.options.sampling.replicates = 4; // the default
}

/// The same with a camera that sees a small bright lamp: the pixels at its edge hold nearly all of the error.
void make_lamp(TestScene& scene) {
    make_room(scene);
    scene.build.material("bright", "Kd 0 0 0\nKe 300 300 200");
    scene.build.use("bright").polygon(
        {{-0.1, 1.2, -0.5}, {0.13, 1.2, -0.5}, {0.13, 1.43, -0.45}, {-0.1, 1.4, -0.45}});
}

/// mean((x - a)(x - b)), weighted: the squared error of x without the noise of two independent references.
double realised_squared_error(const std::vector<float>& x, const std::vector<float>& a,
                              const std::vector<float>& b, const ErrorWeights& weights) {
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i)
        sum +=
            weights.of(i) * (double(x[i]) - double(a[i])) * (double(x[i]) - double(b[i])) / double(x.size());
    return sum;
}

/// Adaptive renders are measured in several ways; the others by the mean squared error.
struct Case {
    const char* name;
    Integrator integrator;
    std::vector<ErrorMeasure> adaptive;
    void (*make_scene)(TestScene&) = make_room;
};

struct ErrorBar : testing::TestWithParam<Case> {};

/// Two long renders of one scene.
struct References {
    Film film;
    std::vector<float> a, b;
};

using RenderSeed = std::function<Film(std::uint32_t seed, std::uint32_t spp)>;

/// Compares what each of many renders says with what it is wrong by.
void expect_error_bar(const std::string& name, const RenderSeed& render, std::uint32_t spp,
                      const References& references, ErrorMeasure measure) {
    SCOPED_TRACE(name);
    const ErrorWeights weights(references.film, PixelChoice(references.film, ErrorPixels::ALL), measure);
    std::vector<double> realised, differences, ratios;
    std::vector<SquaredError> estimates;
    for (int seed = 0; seed < SEEDS; ++seed) {
        const Film film = render(std::uint32_t(seed), spp);
        const auto estimate = film_squared_error(film, ErrorPixels::SCENE, 1, measure);
        ASSERT_TRUE(estimate);
        estimates.push_back(*estimate);
        realised.push_back(realised_squared_error(film_mean(film), references.a, references.b, weights));
        differences.push_back(estimate->mean_squared - realised.back());
    }
    const double truth = moments_of(realised).mean;
    int covered = 0;
    for (size_t seed = 0; seed < estimates.size(); ++seed) {
        const auto error = relative_error(estimates[seed]);
        ASSERT_TRUE(error && error->low && error->high);
        const double own = std::sqrt(std::max(realised[seed], 0.0)) / estimates[seed].mean_radiance;
        covered += *error->low <= own && own <= *error->high;
        ratios.push_back(estimates[seed].mean_squared / truth);
    }
    const Moments ratio = moments_of(ratios);
    std::printf(
        "%-8s error %.2f %%, squared error estimated over true %.3f +- %.3f, degrees %.0f, interval holds "
        "it in %d of %d\n",
        name.c_str(), 100 * std::sqrt(truth) / estimates[0].mean_radiance, ratio.mean,
        std::sqrt(ratio.variance_of_mean()), estimates[0].degrees, covered, SEEDS);
    EXPECT_GT(truth, 0);
    EXPECT_GE(covered, FEWEST_COVERED);
    // The weights of the relative measure come from the noisy picture: their bias is of second order.
    if (measure == ErrorMeasure::MSE) {
        EXPECT_LE(std::abs(z_of_mean(moments_of(differences), 0)), LARGEST_Z);
    }
    EXPECT_LE(std::abs(std::sqrt(ratio.mean) - 1), LARGEST_BIAS + std::sqrt(ratio.variance_of_mean()));
}

} // namespace

TEST_P(ErrorBar, HoldsTheErrorOfThePicture) {
    TestScene scene;
    GetParam().make_scene(scene);
    scene.options.transport.integrator = GetParam().integrator;
    scene.options.effects.all = false; // hundreds of renders: the small program is the fast one
    const bool is_adaptive = !GetParam().adaptive.empty();
    if (is_adaptive) // 5 x 5 tiles
        scene.options.film.size = {40, 40};
    const Scene loaded = scene.load();
    const auto render = [&](std::uint32_t seed, std::uint32_t spp) {
        scene.options.sampling.seed = seed;
        scene.options.sampling.spp = spp;
        return render_loaded(loaded, scene.options).film;
    };
    const std::uint32_t reference_spp = REFERENCE_FACTOR * (is_adaptive ? ADAPTIVE_SPP : SPP);
    References references;
    references.film = render(REFERENCE_SEED, reference_spp);
    references.a = film_mean(references.film);
    references.b = film_mean(render(REFERENCE_SEED + 1, reference_spp));

    if (!is_adaptive)
        expect_error_bar(GetParam().name, render, SPP, references, scene.options.sampling.measure());
    for (const ErrorMeasure measure : GetParam().adaptive) {
        scene.options.sampling.adaptive = measure;
        expect_error_bar(fmt::format("{}, {}", GetParam().name, name_of(measure)), render, ADAPTIVE_SPP,
                         references, scene.options.sampling.measure());
    }
}

// Half of them in the suite, neighbours by turns.
INSTANTIATE_TEST_SUITE_P(
    Integrators, ErrorBar,
    testing::ValuesIn(drawn<Case>(
        {{"path", Integrator::PATH, {}},
         {"lamp", Integrator::PATH, {}, make_lamp},
         {"adaptive", Integrator::PATH, {ErrorMeasure::MSE, ErrorMeasure::RELATIVE}},
         {"adaptive_lamp", Integrator::PATH, {ErrorMeasure::MSE, ErrorMeasure::RELATIVE}, make_lamp},
         {"light", Integrator::LIGHT, {}},
         {"path_light", Integrator::PATH_LIGHT, {}},
         {"bdpt", Integrator::BDPT, {}},
         {"mlt", Integrator::MLT, {}},
         {"whitted", Integrator::WHITTED, {}},
         {"raycast", Integrator::RAYCAST, {}}},
        2)),
    [](const auto& test) { return std::string(test.param.name); });

// Direct light without a penumbra, one bounce: what Sobol points are good at.
TEST(ErrorSlope, OfUnshadowedDirectLightIsSteep) {
    TestScene scene;
    scene.build.material("white", "Kd 0.7 0.7 0.7").material("lamp", "Kd 0 0 0\nKe 8 7 5");
    scene.build.use("white").floor(3);
    scene.build.use("lamp").polygon({{-0.4, 1.9, -0.4}, {0.4, 1.9, -0.4}, {0.4, 1.9, 0.4}, {-0.4, 1.9, 0.4}});
    scene.look({0, 1.5, 3}, {0, 0, 0}, 30);
    scene.options.film.size = {32, 32};
    scene.options.sampling.replicates = 8;
    scene.options.effects.all = false;
    scene.options.transport.max_depth = 2;
    scene.options.sampling.spp = 512;
    const Render rendered = scene.render();
    const auto slope = error_slope(rendered.history);
    ASSERT_TRUE(slope);
    std::printf("slope %.3f +- %.3f\n", slope->slope, slope->reach);
    EXPECT_LE(slope->slope, -0.7);
    EXPECT_EQ(slope->first_samples, 8u);
    EXPECT_EQ(slope->last_samples, 512u);
}

} // namespace clrt
