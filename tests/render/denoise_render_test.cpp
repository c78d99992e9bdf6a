// SPDX-License-Identifier: Apache-2.0
// Denoised renders: the film keeps its bits, both halves see what they sampled, and the stated error is the
// error of the picture.
#include "render/denoised_target.h"

#include "support/render_scene.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr int SEEDS = 16;
constexpr std::uint32_t SPP = 32, REFERENCE_SPP = 1024, REFERENCE_SEED = 1000;

/// A room with a lamp in view, a block, and a mirror.
class DenoiseRender : public testing::Test {
protected:
    DenoiseRender() {
        scene_.build.material("white", "Kd 0.7 0.7 0.7").material("red", "Kd 0.6 0.1 0.1");
        scene_.build.material("mirror", "Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nillum 3")
            .material("lamp", "Kd 0 0 0\nKe 8 7 5");
        scene_.build.use("white").box({-1, 0, -1}, {1, 2, 1}, Facing::INWARD);
        scene_.build.use("lamp").polygon(
            {{-0.4, 1.9, -0.4}, {0.4, 1.9, -0.4}, {0.4, 1.9, 0.4}, {-0.4, 1.9, 0.4}});
        scene_.build.use("red").box({-0.6, 0.01, -0.5}, {0, 0.8, 0.1});
        scene_.build.use("mirror").box({0.2, 0.01, -0.7}, {0.7, 1.1, -0.2});
        scene_.look({0.2, 1, 0.9}, {0, 0.9, -1}, 90);
        scene_.options.film.size = {40, 32};
        scene_.options.sampling.replicates = 4; // the default
        scene_.options.effects.all = false;     // many samples: the small program is the fast one
        scene_.options.output.files = {"a.exr"};
        loaded_ = scene_.load();
    }

    Render render(std::uint32_t seed, std::uint32_t spp, std::optional<Denoiser> denoiser) {
        scene_.options.sampling.seed = seed;
        scene_.options.sampling.spp = spp;
        scene_.options.denoise.denoiser = denoiser;
        return render_loaded(loaded_, scene_.options);
    }
    Denoised denoised(const Render& render) const {
        const DenoiseRequest request{{Denoiser::FILTER, "", PngFrom::RAW},
                                     scene_.options.sampling.measure(),
                                     test_device().kernels_folder(),
                                     "",
                                     {}};
        return FilmDenoiser(test_device(), request).denoise(render.film, render.hits);
    }

    TestScene scene_;
    Scene loaded_;
};

} // namespace

TEST_F(DenoiseRender, LeavesFilmAndLayersAsTheyAre) {
    scene_.options.sampling.first_sample = 3;
    scene_.options.output.aovs = {{"albedo"}}; // layers that are asked for have all samples
    const Render without = render(1, 21, std::nullopt), with = render(1, 21, Denoiser::FILTER);
    EXPECT_EQ(with.film.sums, without.film.sums);
    ASSERT_EQ(without.hits.halves(), 1u);
    ASSERT_EQ(with.hits.halves(), 2u);
    EXPECT_EQ(with.hits.samples_of_half[0] + with.hits.samples_of_half[1], 21u);
    for (size_t i = 0; i < without.hits.values[0].size(); ++i)
        ASSERT_EQ(with.hits.values[0][i] + with.hits.values[1][i], without.hits.values[0][i]);
    for (size_t pixel = 0; pixel < film_plane(with.film) / 3; ++pixel) {
        const PixelHits a = pixel_hits(with.hits, with.film, pixel),
                        b = pixel_hits(without.hits, without.film, pixel);
        ASSERT_NEAR(a.share, b.share, 1e-12);
        ASSERT_NEAR(a.mean(AOV_ALBEDO).x, b.mean(AOV_ALBEDO).x, 1e-12);
    }
    EXPECT_FALSE(denoise_obstacle(with.film, with.hits));
    EXPECT_TRUE(denoise_obstacle(without.film, without.hits));
}

TEST_F(DenoiseRender, IsAFunctionOfFilmAndHits) {
    const Render render = this->render(1, SPP, Denoiser::FILTER);
    const Denoised a = denoised(render), b = denoised(render);
    EXPECT_EQ(a.radiance, b.radiance);
    EXPECT_EQ(a.errors->all.denoised, b.errors->all.denoised);
    EXPECT_EQ(a.errors->tiles, b.errors->tiles);
}

TEST_F(DenoiseRender, AnAdaptiveFilmIsDenoisedToo) {
    scene_.options.sampling.adaptive = ErrorMeasure::RELATIVE;
    const Render render = this->render(1, 64, Denoiser::FILTER);
    ASSERT_TRUE(is_adaptive(render.film));
    const Denoised result = denoised(render);
    EXPECT_NEAR(result.errors->all.raw, render.error->relative_rmse, 1e-9);
    EXPECT_LT(result.errors->all.high, result.errors->all.raw);
}

TEST_F(DenoiseRender, LooksAreRareAndFollowFromSamplesAlone) {
    const std::uint64_t enough = DenoisedTarget::RAYS_BEFORE_LOOKS * 4; // of four pixels
    scene_.options.sampling.denoised_error = 0.05;
    scene_.options.denoise.denoiser = Denoiser::FILTER;
    const auto is_due = [&](std::uint64_t samples, std::uint64_t rays, double high = 1) {
        DenoisedTarget target(scene_.options);
        Film film;
        film.width = film.height = 2;
        film.ranges = {{0, samples}};
        return target.is_due(film, FilmError{0.9 * high, 0.8 * high, high}, [&] { return rays; });
    };
    EXPECT_TRUE(is_due(64, enough));
    EXPECT_FALSE(is_due(64, enough - 1)) << "denoising would cost more than a tenth";
    EXPECT_FALSE(is_due(80, 10 * enough)) << "samples are not even";
    EXPECT_TRUE(is_due(8, 0, 0.05)) << "as rendered it is good enough";
    EXPECT_FALSE(is_due(8, 0, 0.051));
    EXPECT_FALSE(is_due(4, 0, 0.05)) << "one sample in every replicate";
}

TEST_F(DenoiseRender, EndsWhereTheDenoisedErrorIsReachedAndIsHonest) {
    scene_.options.film.size = {80, 64};
    const std::vector<float> a = film_mean(render(REFERENCE_SEED, REFERENCE_SPP, std::nullopt).film),
                             b = film_mean(render(REFERENCE_SEED + 1, REFERENCE_SPP, std::nullopt).film);
    constexpr double TARGET = 0.03;
    scene_.options.sampling.denoised_error = TARGET;
    int early = 0;
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        const Render picture = render(seed, 1024, Denoiser::FILTER);
        ASSERT_EQ(picture.stop, StopRule::DENOISED_ERROR);
        ASSERT_TRUE(picture.denoised);
        EXPECT_EQ(picture.denoised->samples, film_samples(picture.film));
        ASSERT_FALSE(picture.looks.empty());
        EXPECT_LE(picture.looks.back().error.high, TARGET);
        double square = 0, mean = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            square += (double(picture.denoised->radiance[i]) - double(a[i])) *
                      (double(picture.denoised->radiance[i]) - double(b[i])) / double(a.size());
            mean += double(a[i]) / double(a.size());
        }
        std::printf("%llu spp, %zu looks, stated %.4f to %.4f, true %.4f\n",
                    (unsigned long long)picture.denoised->samples, picture.looks.size(),
                    picture.looks.back().error.denoised, picture.looks.back().error.high,
                    std::sqrt(square) / mean);
        early += std::sqrt(square) / mean > TARGET;
        EXPECT_EQ(denoised(picture).radiance, picture.denoised->radiance) << "of the film that is left";
    }
    EXPECT_EQ(early, 0);
}

TEST_F(DenoiseRender, LampsStayAsTheyWereRendered) {
    const Render render = this->render(1, SPP, Denoiser::FILTER);
    const std::vector<char> first = half_picture(render.film, render.hits, 0).lit,
                            second = half_picture(render.film, render.hits, 1).lit;
    const std::vector<float> raw = film_mean(render.film);
    const Pixels smooth = denoised(render).radiance;
    size_t lit = 0, smoothed = 0;
    for (size_t pixel = 0; pixel < first.size(); ++pixel) {
        if (first[pixel] && second[pixel]) {
            ++lit;
            EXPECT_NEAR(smooth[3 * pixel], raw[3 * pixel], 1e-5 * double(raw[3 * pixel])) << pixel;
            EXPECT_GT(raw[3 * pixel], 0.5) << pixel;
        } else
            smoothed += smooth[3 * pixel] != raw[3 * pixel];
    }
    EXPECT_GT(lit, first.size() / 100);
    EXPECT_LT(lit, first.size() / 4);
    EXPECT_GT(smoothed, first.size() / 2);
}

TEST_F(DenoiseRender, StatesItsError) {
    const std::vector<float> a = film_mean(render(REFERENCE_SEED, REFERENCE_SPP, std::nullopt).film),
                             b = film_mean(render(REFERENCE_SEED + 1, REFERENCE_SPP, std::nullopt).film);
    double mean = 0;
    for (const float value : a)
        mean += double(value) / double(a.size());
    double stated = 0, truth = 0, raw = 0, trimmed = 0, scatter = 0;
    int held = 0;
    for (std::uint32_t seed = 0; seed < SEEDS; ++seed) {
        const Denoised picture = denoised(render(seed, SPP, Denoiser::FILTER));
        // Without the noise of the two references, which are independent of each other.
        double square = 0;
        for (size_t i = 0; i < a.size(); ++i)
            square += (double(picture.radiance[i]) - double(a[i])) *
                      (double(picture.radiance[i]) - double(b[i])) / double(a.size());
        square /= mean * mean;
        const DenoisedError& error = picture.errors->all;
        stated += error.denoised * error.denoised / SEEDS;
        truth += square / SEEDS;
        scatter += std::pow(error.denoised * error.denoised - square, 2) / (SEEDS * SEEDS);
        raw += error.raw * error.raw / SEEDS;
        trimmed += std::pow(picture.errors->without_worst.denoised, 2) / SEEDS;
        held += error.low <= std::sqrt(square) && std::sqrt(square) <= error.high;
    }
    std::printf("raw %.4f, denoised %.4f, stated %.4f, without the worst %.4f, held %d of %d\n",
                std::sqrt(raw), std::sqrt(truth), std::sqrt(stated), std::sqrt(trimmed), held, SEEDS);
    EXPECT_LT(truth, 0.5 * raw) << "it does not denoise";
    EXPECT_NEAR(stated, truth, 3.5 * std::sqrt(scatter));
    EXPECT_LT(std::sqrt(scatter), 0.2 * truth) << "too few seeds to tell";
    EXPECT_LT(trimmed, stated);
    EXPECT_GE(held, SEEDS - 3);
}

} // namespace clrt
