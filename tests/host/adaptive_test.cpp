// SPDX-License-Identifier: Apache-2.0
// Adaptive rounds: where samples go, and that it does not bias the picture.
#include "film/adaptive.h"

#include "probes/statistics.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace clrt {

namespace {

constexpr int REPLICATES = 8;

/// A film before its first round.
Film empty_adaptive_film(int width, int height) {
    Film film;
    film.width = width;
    film.height = height;
    film.replicates = REPLICATES;
    film.scale.quantum = 0x1p-20;
    film.sums.assign(film_plane(film) * REPLICATES, 0);
    film.tile_samples = first_round(film).start;
    return film;
}

/// Adds the samples that lie between a film's tiles and those wanted, each of which is 1 / rate by a chance
/// of `rate` and else 0: the mean is 1, and a tile that has seen no bright sample looks free of noise.
void add_rare_light(Film& film, const TileSamples& wanted, const std::vector<double>& rates,
                    std::mt19937& random) {
    const size_t pixels = size_t(film.width) * size_t(film.height), of_half = REPLICATES / 2;
    for (size_t r = 0; r < REPLICATES; ++r)
        for (size_t pixel = 0; pixel < pixels; ++pixel) {
            const size_t tile = film_tile(film, pixel);
            const std::uint32_t count = wanted[r / of_half][tile] - film.tile_samples[r / of_half][tile];
            std::poisson_distribution<int> bright(rates[tile] * count / double(of_half));
            const auto sum = std::int64_t(bright(random) / (rates[tile] * film.scale.quantum));
            for (size_t channel = 0; channel < 3; ++channel)
                film.sums[(r * pixels + pixel) * 3 + channel] += sum;
        }
    film.tile_samples = wanted;
    std::uint64_t mean = 0;
    for (const auto& half : wanted)
        mean += std::accumulate(half.begin(), half.end(), std::uint64_t(0)) / half.size();
    film.ranges = {{0, mean}};
}

/// The same film with its halves exchanged.
Film exchanged(Film film) {
    const auto middle = film.sums.begin() + std::ptrdiff_t(film.sums.size() / 2);
    std::swap_ranges(film.sums.begin(), middle, middle);
    std::swap(film.tile_samples[0], film.tile_samples[1]);
    return film;
}

/// The fault: a half's own noise decides on its samples.
AdaptiveRound selfish_round(const Film& film, const AdaptiveRound& last) {
    // In the exchanged film, what lies in the other half is one's own.
    return next_round(exchanged(film), last);
}

/// Mean of pictures of rare light after six decisions; their expectation is 1.
Moments mean_radiances(AdaptiveRound (*next)(const Film&, const AdaptiveRound&), ErrorMeasure measure,
                       unsigned runs) {
    const std::vector<double> rates = {0.0016, 0.0016, 0.008, 0.08};
    std::vector<double> means;
    std::mt19937 random(7);
    for (unsigned run = 0; run < runs; ++run) {
        Film film = empty_adaptive_film(32, 8);
        AdaptiveRound round = first_round(film, measure);
        add_rare_light(film, round.target, rates, random);
        for (int i = 0; i < 6; ++i) {
            round = next(film, round);
            add_rare_light(film, round.target, rates, random);
        }
        const std::vector<float> mean = film_mean(film);
        means.push_back(std::accumulate(mean.begin(), mean.end(), 0.0) / double(mean.size()));
    }
    return moments_of(means);
}

/// A film after its first round in which the noise of a tile is as given, in each half.
Film noisy_film(const std::array<std::vector<double>, 2>& sigmas, int width, int height) {
    Film film = empty_adaptive_film(width, height);
    film.tile_samples = first_round(film).target;
    film.ranges = {{0, pilot_samples(REPLICATES)}};
    const size_t pixels = size_t(width) * size_t(height);
    std::mt19937 random(3);
    std::normal_distribution<double> noise;
    for (size_t i = 0; i < film.sums.size(); ++i) {
        const size_t half = i / (film.sums.size() / 2), tile = film_tile(film, i / 3 % pixels);
        film.sums[i] = std::int64_t((100 + sigmas[half][tile] * noise(random)) / film.scale.quantum);
    }
    return film;
}

} // namespace

TEST(Adaptive, TheFirstRoundIsTheSameEverywhere) {
    const AdaptiveRound round = first_round(empty_adaptive_film(24, 12));
    EXPECT_EQ(round.end, 16u);
    ASSERT_EQ(round.target[0].size(), 6u);
    for (const auto& half : round.target)
        EXPECT_EQ(half, std::vector<std::uint32_t>(6, 8));
}

TEST(Adaptive, NoiseOfASampleIsMeasured) {
    // A sum of two samples with a deviation of 2 each is a number with a deviation of 2 sqrt(2).
    const std::vector<double> sigma(6, 2 * std::sqrt(2.0));
    const Film film = noisy_film({sigma, sigma}, 24, 12);
    for (int half = 0; half < 2; ++half)
        for (const double noise : tile_noise(film, half))
            EXPECT_NEAR(noise, 4, 1.5);
    EXPECT_NEAR(tile_noise(film, 0)[0], 4, 6 * 4 * std::sqrt(2.0 / (3 * 192)));
}

TEST(Adaptive, TheOtherHalfDecides) {
    std::array<std::vector<double>, 2> sigmas;
    sigmas.fill(std::vector<double>(8, 1.0));
    sigmas[0][2] = 50; // noise that only the first half has seen
    sigmas[1][2] = 0.1;
    sigmas[1][5] = 4;
    const Film film = noisy_film(sigmas, 32, 16);
    const AdaptiveRound round = next_round(film, first_round(film));
    EXPECT_EQ(round.first, 16u);
    EXPECT_EQ(round.end, 24u);
    EXPECT_EQ(round.start[0], std::vector<std::uint32_t>(8, 8));
    EXPECT_EQ(round.target[1][2], 16u);
    EXPECT_EQ(round.target[0][2], 8u);
    EXPECT_EQ(std::accumulate(round.target[0].begin(), round.target[0].end(), 0u), 8u * 12u);
}

TEST(Adaptive, RoundsKeepTheirMeanAndTheirBounds) {
    std::array<std::vector<double>, 2> sigmas;
    sigmas.fill({1, 4, 0, 30, 2, 0.1, 100, 0.5, 7});
    Film film = noisy_film(sigmas, 20, 22); // no side is a multiple of 8
    const std::vector<std::uint32_t> pixels = tile_pixel_counts(film);
    EXPECT_EQ(std::accumulate(pixels.begin(), pixels.end(), 0u), 20u * 22u);
    AdaptiveRound round = first_round(film);
    for (int i = 0; i < 6; ++i) {
        const AdaptiveRound last = round;
        round = next_round(film, last);
        film.tile_samples = round.target;
        EXPECT_EQ(round.end, i % 2 == 0 ? last.end / 2 * 3 : last.end / 3 * 4);
        const double mean = 0.5 * double(round.end);
        for (size_t half = 0; half < 2; ++half) {
            double sum = 0;
            for (size_t tile = 0; tile < pixels.size(); ++tile) {
                const std::uint32_t n = round.target[half][tile];
                EXPECT_EQ(n & (n - 1), 0u) << "Sobol points are even over powers of two";
                EXPECT_GE(n, last.target[half][tile]);
                EXPECT_LE(n, 2 * last.target[half][tile]);
                EXPECT_GE(n, 0.5 * mean);
                sum += double(n) * pixels[tile];
            }
            EXPECT_LE(sum, mean * 20 * 22);
            EXPECT_GE(sum, 0.8 * mean * 20 * 22);
        }
    }
    EXPECT_GT(round.target[0][6], round.target[0][0]);
}

TEST(Adaptive, AWholePictureWithoutNoiseStaysUniform) {
    const std::vector<double> none(8, 0.0);
    Film film = noisy_film({none, none}, 32, 16);
    AdaptiveRound round = next_round(film, first_round(film));
    film.tile_samples = round.target;
    round = next_round(film, round);
    for (const auto& half : round.target)
        EXPECT_EQ(half, std::vector<std::uint32_t>(8, 16));
}

TEST(Adaptive, TheGainIsThatOfTheRootOfTheNoise) {
    // Samples 1 : 3 in two tiles instead of 2 : 2 make 1/2 + 9/2 of 1 + 9/3.
    EXPECT_DOUBLE_EQ(expected_gain({1, 9}, {64, 64}), 5.0 / 4);
    EXPECT_DOUBLE_EQ(expected_gain({1, 1, 9}, {32, 32, 64}), 5.0 / 4);
    EXPECT_DOUBLE_EQ(expected_gain({4, 4}, {64, 1}), 1);
    EXPECT_DOUBLE_EQ(expected_gain({0, 0}, {64, 64}), 1);
}

TEST(Adaptive, WithoutAGainTheSamplesStayTheSameEverywhere) {
    const std::vector<double> alike(8, 1.0);
    std::vector<double> noisy = alike;
    noisy[3] = 9;
    Film film = noisy_film({alike, alike}, 32, 16);
    AdaptiveRound round = next_round(film, first_round(film));
    EXPECT_GT(expected_gain(round), 1);
    EXPECT_LT(expected_gain(round), WORTHWHILE_GAIN);
    for (const auto& half : round.target)
        EXPECT_EQ(half, std::vector<std::uint32_t>(8, 12));
    // What one half has seen among its first 16 samples decides for the other one as soon as these are what
    // all tiles must have, at a power of two.
    film = noisy_film({noisy, alike}, 32, 16);
    for (const std::uint32_t mean : {16, 24, 32}) {
        film.tile_samples = round.target;
        round = next_round(film, round);
        for (const auto& half : round.target)
            EXPECT_EQ(half, std::vector<std::uint32_t>(8, mean));
    }
    film.tile_samples = round.target;
    round = next_round(film, round);
    EXPECT_LT(round.gain[1], WORTHWHILE_GAIN);
    EXPECT_GT(round.gain[0], WORTHWHILE_GAIN);
    EXPECT_EQ(round.target[0], std::vector<std::uint32_t>(8, 48));
    EXPECT_EQ(round.target[1][3], 64u);
}

TEST(Adaptive, RelativeNoiseIsThatOfABrightnessOfOne) {
    // Half of the tiles are a hundredth as bright, and their noise is too.
    Film film = noisy_film({std::vector<double>(8, 10.0), std::vector<double>(8, 10.0)}, 32, 16);
    for (size_t i = 0; i < film.sums.size(); ++i)
        if (film_tile(film, i / 3 % 512) >= 4)
            film.sums[i] /= 100;
    const double mean = 0.5 * (50 + 0.5), bright = 50, dark = 0.5; // of a sample; a sum holds two
    const double of_bright = 50 * mean * mean / (bright * bright + 0.01 * mean * mean);
    const double of_dark = 0.005 * mean * mean / (dark * dark + 0.01 * mean * mean);
    const std::vector<double> noise = tile_noise(film, 1, ErrorMeasure::RELATIVE);
    for (size_t tile = 0; tile < 8; ++tile) {
        const double expected = tile < 4 ? of_bright : of_dark;
        EXPECT_NEAR(noise[tile], expected, 0.3 * expected) << tile;
    }
}

TEST(Adaptive, TilesGoTheirWaysTogether) {
    AdaptiveRound round;
    round.first = 16;
    round.end = 32;
    round.start.fill({8, 8, 8});
    round.target.fill({8, 16, 64});
    EXPECT_EQ(samples_within(round, 16, REPLICATES)[1], (std::vector<std::uint32_t>{8, 8, 8}));
    EXPECT_EQ(samples_within(round, 24, REPLICATES)[0], (std::vector<std::uint32_t>{8, 12, 36}));
    EXPECT_EQ(samples_within(round, 32, REPLICATES)[0], (std::vector<std::uint32_t>{8, 16, 64}));
    std::uint32_t last = 0;
    for (std::uint64_t samples = 16; samples <= 32; ++samples) {
        const std::uint32_t now = samples_within(round, samples, REPLICATES)[0][2];
        EXPECT_GE(now, last);
        EXPECT_EQ(now % 4, 0u) << "whole samples of every replicate";
        last = now;
    }
}

TEST(Adaptive, HalvesWeighTheSameWhateverTheirSamples) {
    Film film = empty_adaptive_film(8, 8);
    film.tile_samples = {std::vector<std::uint32_t>{8}, std::vector<std::uint32_t>{64}};
    film.ranges = {{0, 72}};
    for (size_t i = 0; i < film.sums.size(); ++i) // means of 1 and 3
        film.sums[i] = std::int64_t((i < film.sums.size() / 2 ? 2.0 : 3 * 16.0) / film.scale.quantum);
    EXPECT_EQ(film_mean(film), std::vector<float>(192, 2.0f));
    EXPECT_EQ(film_pixel_samples(film), std::vector<float>(64, 72.0f));
    EXPECT_EQ(film_all_samples(film), 72u * 64u);
    double means[REPLICATES];
    ReplicateMeans(film).read(5, means);
    EXPECT_EQ(means[0], 1);
    EXPECT_EQ(means[7], 3);
}

// The promise: which samples are taken says nothing about what they are. Where a half's own noise decides,
// tiles that have seen no bright sample stay as they are, and the picture is too dark.
TEST(Adaptive, PicturesOfRareLightAreUnbiased) {
    for (const ErrorMeasure measure : {ErrorMeasure::MSE, ErrorMeasure::RELATIVE}) {
        const Moments fair = mean_radiances(next_round, measure, 3000);
        const Moments selfish = mean_radiances(selfish_round, measure, 2500);
        std::printf("%s: mean of pictures %.4f +- %.4f, where a half's own noise decides %.4f +- %.4f\n",
                    name_of(measure), fair.mean, std::sqrt(fair.variance_of_mean()), selfish.mean,
                    std::sqrt(selfish.variance_of_mean()));
        EXPECT_LE(std::abs(z_of_mean(fair, 1)), 4);
        EXPECT_LE(z_of_mean(selfish, 1), -6) << "the test has lost its power";
    }
}

} // namespace clrt
