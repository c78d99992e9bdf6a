// SPDX-License-Identifier: Apache-2.0
// Pictures and variances from made-up sums, against direct computation.
#include "film/film_error.h"

#include "probes/statistics.h"
#include "scene/sky_texels.h"
#include "support/noise_film.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace clrt {

namespace {

/// Means of value `i` in the replicates that have samples.
std::vector<double> replicate_means(const Film& film, size_t i) {
    std::vector<double> means;
    const size_t plane = film.sums.size() / size_t(film.replicates);
    for (int r = 0; r < film.replicates; ++r)
        if (const double n = double(film_replicate_samples(film, r)); n > 0)
            means.push_back(double(film.sums[size_t(r) * plane + i]) * film.scale.quantum / n);
    return means;
}

/// A scene that only shines as told.
Scene shining(double sky, double power) {
    Scene scene;
    scene.extent = 1;
    scene.environment.radiance = glm::dvec3(sky);
    scene.emitted_power = power;
    return scene;
}

} // namespace

TEST(Film, EverySampleBelongsToTheReplicateOfItsNumber) {
    for (const std::uint32_t first : {0u, 1u, 7u, 8u, 100u})
        for (const std::uint64_t samples : {0u, 1u, 5u, 8u, 37u}) {
            const Film film = empty_film(1, 1, 8, first, samples);
            std::vector<std::uint64_t> counts(8, 0);
            for (std::uint64_t s = first; s < first + samples; ++s)
                ++counts[s % 8];
            for (int r = 0; r < 8; ++r)
                EXPECT_EQ(film_replicate_samples(film, r), counts[size_t(r)]) << first << ", " << samples;
        }
}

TEST(Film, TheMeanIsTheSumOverAllReplicates) {
    Film film = empty_film(3, 2, 4, 0, 10);
    for (size_t i = 0; i < film.sums.size(); ++i)
        film.sums[i] = std::int64_t(i * i) + 1;
    const std::vector<float> mean = film_mean(film);
    ASSERT_EQ(mean.size(), 18u);
    for (size_t i = 0; i < 18; ++i) {
        std::int64_t sum = 0;
        for (size_t r = 0; r < 4; ++r)
            sum += film.sums[r * 18 + i];
        EXPECT_FLOAT_EQ(mean[i], float(double(sum) / 4096 / 10));
    }
}

TEST(Film, ReplicatesWithoutSamplesAreNotLookedAt) {
    Film film = empty_film(3, 2, 4, 6, 1); // sample 6 belongs to replicate 2
    for (int r = 0; r < 4; ++r)
        EXPECT_EQ(film_has_replicate(film, r), r == 2) << r;
    for (size_t i = 0; i < film.sums.size(); ++i)
        film.sums[i] = i / 18 == 2 ? 4096 : 1;
    EXPECT_EQ(film_mean(film), std::vector<float>(18, 1.0f));
}

TEST(Film, SumsBeyondTheDigitsOfADoubleKeepTheirMean) {
    Film film = empty_film(1, 1, 2, 0, std::uint64_t(1) << 20);
    film.sums = {std::int64_t(1) << 60, 4096, 0, -(std::int64_t(1) << 60), 4096, 0};
    EXPECT_EQ(film_mean(film), (std::vector<float>{0, float(std::ldexp(2.0, -20)), 0}));
}

TEST(Film, TheMeanOfFullReplicatesDoesNotWrapRound) {
    Film film = empty_film(1, 1, 8, 0, 8);
    for (std::int64_t& sum : film.sums)
        sum = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(film_mean(film), std::vector<float>(3, float(std::ldexp(1.0, 63 - 12))));
    for (std::int64_t& sum : film.sums)
        sum = std::numeric_limits<std::int64_t>::min();
    EXPECT_EQ(film_mean(film), std::vector<float>(3, float(-std::ldexp(1.0, 63 - 12))));
}

TEST(Film, WithoutSamplesItIsBlackAndHasNoError) {
    const Film film = empty_film(2, 2, 8, 0, 0);
    EXPECT_EQ(film_mean(film), std::vector<float>(12, 0.0f));
    EXPECT_TRUE(film_variance(film).empty());
    EXPECT_FALSE(film_error(film));
}

TEST(Film, TheVarianceIsThatOfTheMeanOfReplicates) {
    std::mt19937 random(1);
    for (const std::uint64_t samples : {2u, 5u, 64u, 69u}) { // some replicates empty, or one sample ahead
        Film film = empty_film(4, 3, 8, 3, samples);
        fill_with_noise(film, 2, 1, random);
        const std::vector<float> variance = film_variance(film);
        ASSERT_EQ(variance.size(), 36u);
        for (size_t i = 0; i < variance.size(); ++i) {
            const double expected = moments_of(replicate_means(film, i)).variance_of_mean();
            EXPECT_NEAR(variance[i], expected, 1e-6 * expected) << samples;
        }
    }
}

TEST(Film, OneReplicateSaysNothingAboutItsError) {
    std::mt19937 random(2);
    for (const auto& [replicates, samples] : {std::pair{1, 64u}, {8, 1u}}) {
        Film film = empty_film(4, 3, replicates, 0, samples);
        fill_with_noise(film, 2, 1, random);
        EXPECT_TRUE(film_variance(film).empty());
        EXPECT_FALSE(film_error(film));
    }
}

TEST(Film, FoldedReplicatesKeepThePicture) {
    std::mt19937 random(4);
    Film film = empty_film(3, 2, 8, 0, 24);
    fill_with_noise(film, 2, 1, random);
    Film folded = film;
    fold_replicates(folded, 2);
    EXPECT_EQ(folded.sums.size(), 2 * film_plane(film));
    EXPECT_EQ(film_mean(folded), film_mean(film));
    EXPECT_EQ(film_replicate_samples(folded, 1), 12u);
    for (size_t i = 0; i < film_plane(film); ++i) {
        std::int64_t odd = 0;
        for (size_t r = 1; r < 8; r += 2)
            odd += film.sums[r * film_plane(film) + i];
        EXPECT_EQ(folded.sums[film_plane(film) + i], odd);
    }
}

TEST(Film, FullSumsStayFullWhenReplicatesAreFolded) {
    Film film = empty_film(1, 1, 2, 0, 2);
    film.sums = {INT64_MAX, 5, INT64_MAX - 3, 1, 6, 3};
    fold_replicates(film, 1);
    EXPECT_EQ(film.sums, (std::vector<std::int64_t>{INT64_MAX, 11, INT64_MAX}));
}

TEST(Film, RangesWithAGapCountTheirSamples) {
    Film film = empty_film(1, 1, 4, 0, 6);
    film.ranges.push_back({9, 12});
    EXPECT_EQ(film_samples(film), 9u);
    const std::vector<std::uint64_t> expected = {2, 3, 2, 2}; // 0 4, 1 5 9, 2 10, 3 11
    for (int r = 0; r < 4; ++r)
        EXPECT_EQ(film_replicate_samples(film, r), expected[size_t(r)]);
}

TEST(FilmScale, TheQuantumIsAMillionthOfTheMeanLevel) {
    EXPECT_EQ(film_scale(shining(1, 0)).quantum, std::ldexp(1.0, -20));
    EXPECT_EQ(film_scale(shining(1, 0)).largest, std::ldexp(1.0, 40));
    EXPECT_EQ(film_scale(shining(1, 0)).sustained, std::ldexp(1.0, 24));
    EXPECT_EQ(film_scale(shining(1.4, 0)).quantum, std::ldexp(1.0, -20)) << "the power of two nearest to it";
    EXPECT_EQ(film_scale(shining(1.5, 0)).quantum, std::ldexp(1.0, -19));
    // Power over the bounding sphere's area (radius sqrt(3)) and pi.
    const double pi = 3.14159265358979323846;
    EXPECT_EQ(film_scale(shining(0, 12 * pi * pi)).quantum, std::ldexp(1.0, -20));
    EXPECT_EQ(film_scale(shining(0, 0)).quantum, std::ldexp(1.0, -20)) << "black scenes have some scale";
}

TEST(FilmScale, ItFollowsTheLightByPowersOfTwo) {
    for (int k = -40; k <= 40; k += 8) {
        const double factor = std::ldexp(1.0, k);
        EXPECT_EQ(film_scale(shining(0.3 * factor, 5 * factor)).quantum,
                  film_scale(shining(0.3, 5)).quantum * factor);
    }
}

TEST(FilmScale, AFullFilmHoldsTheBrightestSurfaceAndTheBrightestTexel) {
    Scene scene = shining(0, 1e-6);
    scene.triangles.resize(1);
    scene.triangles[0].material = 1;
    scene.emitters.resize(1);
    scene.emitted = {{glm::dvec3(1e20), glm::dvec3(1e20)}, {glm::dvec3(1e-3), {3, 1e9, 2}}};
    const FilmScale scale = film_scale(scene);
    EXPECT_GT(scale.sustained, 1e9) << "what no triangle has does not count";
    EXPECT_LE(scale.sustained, 2e9) << "no coarser than needed";
    EXPECT_LE(scale.sustained / scale.quantum * double(FILM_SAMPLES_PER_REPLICATE), 0x1p63);
    scene.emitted[1].largest = glm::dvec3(0x1p30);
    EXPECT_GT(film_scale(scene).sustained, 0x1p30) << "all samples of it are less than 2^63";

    scene = shining(2, 0);
    store_sky_texels({2, 1, {glm::vec3(0), glm::vec3(0, 5e8f, 0)}}, scene.environment);
    scene.environment.mean_radiance = 1e-3;
    EXPECT_GE(film_scale(scene).sustained, 1e9) << "the map's factor counts";
}

TEST(FilmScale, DiscsOfSunsFitAndLeaveTheQuantumFine) {
    Scene scene = shining(0, 1);
    Light sun{};
    sun.kind = LIGHT_SUN;
    for (const float radiance : {1e3f, 1e9f, 1e15f}) {
        sun.emission = {radiance, 1, 1, 0};
        scene.lights = {sun};
        const FilmScale scale = film_scale(scene);
        EXPECT_GE(scale.largest, 16 * double(radiance));
        EXPECT_LE(double(radiance) / scale.quantum * 127, 0x1p63) << "127 samples of the disc alone";
        EXPECT_LE(scale.quantum, std::max(film_scale(shining(0, 1)).quantum, double(radiance) * 0x1p-55));
    }
}

TEST(FilmScale, ItsNumbersAreFloatsWhateverTheLight) {
    for (const double radiance : {1e-44, 1e-35, 1e-30, 1e30, 3e38}) {
        const FilmScale scale = film_scale(shining(radiance, 0));
        EXPECT_TRUE(std::isnormal(float(scale.quantum))) << radiance;
        EXPECT_TRUE(std::isnormal(float(1 / scale.quantum))) << radiance;
    }
}

} // namespace clrt
