// SPDX-License-Identifier: Apache-2.0
// What a half of a picture is, and which version of it each pixel takes.
#include "denoise/choice.h"

#include "denoise/smooth.h"
#include "support/noise_film.h"

#include <gtest/gtest.h>
#include <random>

namespace clrt {

namespace {

constexpr int WIDTH = 64, HEIGHT = 32;

/// Flat on the left; stripes of one pixel on the right, which any smoothing ruins.
double truth(size_t pixel) {
    const size_t x = pixel % WIDTH;
    return x < WIDTH / 2 ? 1 : x % 2 == 0 ? 0.2 : 1.8;
}

HalfPicture noisy_half(double deviation) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, deviation);
    HalfPicture half;
    half.width = WIDTH;
    half.height = HEIGHT;
    half.mean.resize(3 * WIDTH * HEIGHT);
    half.lit.assign(WIDTH * HEIGHT, 0);
    for (Pixels& quarter : half.quarter)
        for (size_t i = 0; i < half.mean.size(); ++i)
            quarter.push_back(float(truth(i / 3) + noise(random)));
    for (size_t i = 0; i < half.mean.size(); ++i)
        half.mean[i] = 0.5f * (half.quarter[0][i] + half.quarter[1][i]);
    return half;
}

DenoiseCandidate smoothed(const HalfPicture& half, int radius) {
    const auto smooth = [&](const Pixels& pixels) {
        return smooth_binomial(pixels, WIDTH, HEIGHT, 3, radius);
    };
    return {{smooth(half.quarter[0]), smooth(half.quarter[1])}, smooth(half.mean)};
}

double share_in(const Pixels& shares, int from, int to) {
    double sum = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = from; x < to; ++x)
            sum += double(shares[size_t(y * WIDTH + x)]) / (HEIGHT * (to - from));
    return sum;
}

} // namespace

TEST(DenoiseChoice, NoisyPixelsStayWhereSmoothingDoesHarm) {
    const HalfPicture half = noisy_half(0.2);
    const DenoisedHalf chosen = choose_candidates(half, {smoothed(half, 1), smoothed(half, 6)});
    EXPECT_LT(share_in(chosen.noisy, 0, WIDTH / 2 - 10), 0.01);
    EXPECT_GT(share_in(chosen.noisy, WIDTH / 2 + 2, WIDTH), 0.99);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = WIDTH / 2 + 4; x < WIDTH; ++x)
            EXPECT_FLOAT_EQ(chosen.radiance[size_t(3 * (y * WIDTH + x))],
                            half.mean[size_t(3 * (y * WIDTH + x))]);
}

TEST(DenoiseChoice, TheStrongerFilterWinsOnWhatIsFlat) {
    const HalfPicture half = noisy_half(0.2);
    const DenoiseCandidate weak = smoothed(half, 1), strong = smoothed(half, 6);
    const DenoisedHalf chosen = choose_candidates(half, {weak, strong});
    size_t strongs = 0;
    for (size_t i = 0; i < 3 * 16; ++i)
        strongs += chosen.radiance[3 * WIDTH * 10 + i] == strong.half[3 * WIDTH * 10 + i];
    EXPECT_GT(strongs, 40u);
}

TEST(DenoiseChoice, WhatIsExpectedIsTheErrorOnFlatParts) {
    const HalfPicture half = noisy_half(0.2);
    const DenoisedHalf chosen = choose_candidates(half, {});
    double mean = 0;
    for (const float expected : chosen.expected)
        mean += double(expected) / double(chosen.expected.size());
    EXPECT_NEAR(mean, 3 * 0.2 * 0.2 / 2, 0.003) << "the variance of the mean of two, in three channels";
}

TEST(DenoiseChoice, LampsDecideForNoOtherPixel) {
    HalfPicture half = noisy_half(0.2);
    const DenoiseCandidate wall = smoothed(half, 6);
    const size_t lamp = 16 * WIDTH + 8; // on the flat part
    half.lit[lamp] = 1;
    for (size_t i = 3 * lamp; i < 3 * lamp + 3; ++i)
        half.quarter[0][i] = 900, half.quarter[1][i] = 1100, half.mean[i] = 1000;
    const DenoisedHalf chosen = choose_candidates(half, {wall});
    EXPECT_EQ(chosen.radiance[3 * lamp], 1000);
    EXPECT_EQ(chosen.noisy[lamp], 1);
    for (const size_t beside : {lamp - 1, lamp + 1, lamp - WIDTH, lamp + WIDTH}) {
        EXPECT_EQ(chosen.noisy[beside], 0);
        EXPECT_FLOAT_EQ(chosen.radiance[3 * beside], wall.half[3 * beside]);
    }
}

TEST(SmoothBinomial, MixesNoKinds) {
    Pixels values(WIDTH * HEIGHT, 2.5f);
    std::vector<char> kinds(values.size(), 0);
    for (const size_t pixel : {size_t(0), size_t(10 * WIDTH + 20), size_t(10 * WIDTH + 21)})
        values[pixel] = 1e6f, kinds[pixel] = 1;
    const Pixels smooth = smooth_alike(values, kinds, WIDTH, HEIGHT, 1, 2);
    for (size_t pixel = 0; pixel < smooth.size(); ++pixel)
        EXPECT_FLOAT_EQ(smooth[pixel], values[pixel]);
    kinds.assign(values.size(), 0);
    EXPECT_EQ(smooth_alike(values, kinds, WIDTH, HEIGHT, 1, 2), smooth_binomial(values, WIDTH, HEIGHT, 1, 2));
}

TEST(SmoothBinomial, KeepsConstantsAndLowersVarianceAsItSays) {
    for (const float value : smooth_binomial(Pixels(3 * WIDTH * HEIGHT, 2.5f), WIDTH, HEIGHT, 3, 3))
        EXPECT_FLOAT_EQ(value, 2.5f);
    Pixels point(WIDTH * HEIGHT, 0.0f);
    point[10 * WIDTH + 20] = 1;
    double squares = 0, sum = 0;
    for (const float value : smooth_binomial(point, WIDTH, HEIGHT, 1, 2)) {
        sum += double(value);
        squares += double(value) * double(value);
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_NEAR(squares, binomial_variance(2), 1e-6);
    EXPECT_NEAR(binomial_variance(1), 0.140625, 1e-12);
}

TEST(HalfSamples, AreThoseOfTheFirstAndOfTheLastReplicates) {
    for (const int replicates : {4, 6})
        for (std::uint64_t end = 0; end < 40; ++end) {
            std::uint64_t counts[2] = {};
            for (std::uint64_t s = 0; s < end; ++s)
                ++counts[s % std::uint64_t(replicates) >= std::uint64_t(replicates / 2)];
            for (size_t half = 0; half < 2; ++half)
                EXPECT_EQ(samples_of_half_below(end, replicates, half), counts[half]) << end;
        }
}

TEST(HalfPicture, FilmsThatCannotBeJudgedAreNamed) {
    HitSums hits;
    hits.values[0].resize(1);
    hits.values[1].resize(1);
    const auto obstacle = [&](int replicates, std::uint64_t samples) {
        hits.samples = samples;
        return denoise_obstacle(empty_film(2, 2, replicates, 0, samples), hits).value_or("none");
    };
    EXPECT_EQ(obstacle(4, 4), "none");
    EXPECT_EQ(obstacle(8, 64), "none");
    EXPECT_NE(obstacle(2, 64).find("keeps 2 replicates"), std::string::npos);
    EXPECT_NE(obstacle(5, 64).find("an even number"), std::string::npos);
    EXPECT_NE(obstacle(8, 7).find("only 7 of its 8"), std::string::npos);
    hits.values[1].clear();
    EXPECT_NE(obstacle(8, 64).find("what its samples see first"), std::string::npos);
}

} // namespace clrt
