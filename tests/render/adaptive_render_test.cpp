// SPDX-License-Identifier: Apache-2.0
// Adaptive renders: no bias against uniform ones, less error for the same samples, and the same samples to
// begin with.
#include "film/film_error.h"
#include "probes/statistics.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr int SEEDS = 50;
constexpr std::uint32_t SPP = 48;
constexpr double LARGEST_T = 6;

/// A floor with a lamp in view, whose edges are noisy, and a mirror that throws light which is rarely found.
void make_floor(TestScene& scene) {
    scene.build.material("white", "Kd 0.7 0.7 0.7")
        .material("mirror", "Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nillum 3");
    scene.build.material("lamp", "Kd 0 0 0\nKe 80 70 50");
    scene.build.use("white").floor(3);
    scene.build.use("lamp").polygon(
        {{-0.1, 1.7, -0.5}, {0.1, 1.7, -0.5}, {0.1, 1.7, -0.3}, {-0.1, 1.7, -0.3}});
    scene.build.use("mirror").box({0.2, 0.01, -0.7}, {0.7, 1.1, -0.2});
    scene.look({0.2, 1, 1.4}, {0, 0.9, -1}, 70);
    scene.options.film.size = {64, 48}; // 8 x 6 tiles
    scene.options.sampling.replicates = 8;
    scene.options.sampling.spp = SPP;
}

/// Mean over the pixels of each tile, and behind them that of the picture.
std::vector<double> tile_means(const Film& film) {
    const std::vector<float> mean = film_mean(film);
    const std::vector<std::uint32_t> pixels = tile_pixel_counts(film);
    std::vector<double> means(film_tiles(film) + 1, 0.0);
    for (size_t i = 0; i < mean.size(); ++i) {
        const size_t tile = film_tile(film, i / 3);
        means[tile] += double(mean[i]) / (3.0 * pixels[tile]);
        means.back() += double(mean[i]) / double(mean.size());
    }
    return means;
}

/// The means of many seeds, [tile][seed], and the mean of the squared errors that the renders state.
struct Seeds {
    std::vector<std::vector<double>> means;
    double mean_squared = 0;
};

Seeds render_seeds(TestScene& scene, std::optional<ErrorMeasure> measure, std::uint32_t first_seed,
                   ErrorMeasure judge) {
    scene.options.sampling.adaptive = measure;
    const Scene loaded = scene.load();
    Seeds seeds;
    for (std::uint32_t seed = 0; seed < SEEDS; ++seed) {
        scene.options.sampling.seed = first_seed + seed;
        const Film film = render_loaded(loaded, scene.options).film;
        const std::vector<double> means = tile_means(film);
        seeds.means.resize(means.size());
        for (size_t tile = 0; tile < means.size(); ++tile)
            seeds.means[tile].push_back(means[tile]);
        const auto error = film_squared_error(film, ErrorPixels::SCENE, 1, judge);
        seeds.mean_squared += error->mean_squared / SEEDS;
    }
    return seeds;
}

} // namespace

TEST(AdaptiveRender, BeginsWithTheUniformPicture) {
    TestScene scene;
    make_floor(scene);
    scene.options.sampling.spp = 16;
    const Render uniform = scene.render();
    scene.options.sampling.adaptive = ErrorMeasure::MSE;
    const Render adaptive = scene.render();
    EXPECT_TRUE(uniform.film.sums == adaptive.film.sums);
    EXPECT_EQ(film_mean(uniform.film), film_mean(adaptive.film));
    EXPECT_EQ(uniform.counts.rays(), adaptive.counts.rays());
}

TEST(AdaptiveRender, TakesItsSamplesWhereThePictureIsNoisy) {
    TestScene scene;
    make_floor(scene);
    scene.options.sampling.adaptive = ErrorMeasure::MSE;
    const Render rendered = scene.render();
    const std::vector<float> samples = film_pixel_samples(rendered.film);
    const auto [fewest, most] = std::minmax_element(samples.begin(), samples.end());
    const double mean = double(film_all_samples(rendered.film)) / double(samples.size());
    EXPECT_LE(mean, SPP);
    EXPECT_GE(mean, 0.8 * SPP);
    EXPECT_LE(*fewest, SPP);
    EXPECT_GE(*most, 2 * SPP);
    EXPECT_EQ(rendered.counts.primary, film_all_samples(rendered.film));
}

struct Measure {
    ErrorMeasure measure;
    std::uint32_t spp;
    double largest_error; ///< squared, of that of uniform renders
};

struct AdaptiveRenderBy : testing::TestWithParam<Measure> {};

TEST_P(AdaptiveRenderBy, OfManySeedsIsTheUniformPictureWithLessError) {
    const ErrorMeasure measure = GetParam().measure;
    TestScene scene;
    make_floor(scene);
    scene.options.transport.emission_rays = 1; // most of the noise is at the lamp's outline
    scene.options.sampling.spp = GetParam().spp;
    const Seeds uniform = render_seeds(scene, {}, 1000, measure),
                adaptive = render_seeds(scene, measure, 0, measure);
    double worst = 0;
    for (size_t tile = 0; tile < uniform.means.size(); ++tile)
        worst = std::max(
            worst, std::abs(welch_test(moments_of(adaptive.means[tile]), moments_of(uniform.means[tile])).t));
    std::printf("picture %.5f, uniform %.5f, largest t of its tiles %.2f, squared error of adaptive over "
                "uniform %.3f\n",
                moments_of(adaptive.means.back()).mean, moments_of(uniform.means.back()).mean, worst,
                adaptive.mean_squared / uniform.mean_squared);
    EXPECT_LE(worst, LARGEST_T);
    EXPECT_LE(adaptive.mean_squared, GetParam().largest_error * uniform.mean_squared);
}

INSTANTIATE_TEST_SUITE_P(Measures, AdaptiveRenderBy,
                         testing::Values(Measure{ErrorMeasure::MSE, SPP, 0.5},
                                         Measure{ErrorMeasure::RELATIVE, 192, 0.85}),
                         [](const auto& test) { return std::string(name_of(test.param.measure)); });

} // namespace clrt
