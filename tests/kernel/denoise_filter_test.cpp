// SPDX-License-Identifier: Apache-2.0
// kernels/denoise: regression on features, through the filter that launches it.
#include "denoise/feature_filter.h"

#include "support/test_device.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace clrt {

namespace {

constexpr int WIDTH = 45, HEIGHT = 34; ///< not multiples of the models' stride

FeatureFilter& filter() {
    static FeatureFilter instance = [] {
        DenoiseRequest request;
        request.kernels_folder = test_device().kernels_folder();
        return FeatureFilter(test_device(), request);
    }();
    return instance;
}

/// A wall that is seen head-on, of one albedo, without light.
HalfPicture wall() {
    HalfPicture half;
    half.width = WIDTH;
    half.height = HEIGHT;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x) {
            half.albedo.insert(half.albedo.end(), {0.5f, 0.5f, 0.5f});
            half.normal.insert(half.normal.end(), {0, 0, 1});
            half.position.insert(half.position.end(), {0.01f * float(x), 0.01f * float(y), 0});
            half.share.push_back(1);
            half.lit.push_back(0);
        }
    return half;
}

/// Gives every pixel its colour, a function of x, y and channel, and normal noise.
template <class Colour>
void shine(HalfPicture& half, double deviation, Colour&& colour) {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, 1);
    for (Pixels& quarter : half.quarter)
        for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i)
            quarter.push_back(float(colour(i / 3 % WIDTH, i / 3 / WIDTH, i % 3) + deviation * noise(random)));
    half.mean.resize(half.quarter[0].size());
    for (size_t i = 0; i < half.mean.size(); ++i)
        half.mean[i] = 0.5f * (half.quarter[0][i] + half.quarter[1][i]);
}

/// Root of the mean squared difference from a colour.
template <class Colour>
double error_of(const Pixels& pixels, Colour&& colour) {
    double sum = 0;
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i)
        sum += std::pow(double(pixels[size_t(i)]) - colour(i / 3 % WIDTH, i / 3 / WIDTH, i % 3), 2);
    return std::sqrt(sum / (3 * WIDTH * HEIGHT));
}

} // namespace

TEST(DenoiseFilter, LinearColoursPassUnchanged) {
    HalfPicture half = wall();
    for (int i = 0; i < WIDTH * HEIGHT; ++i) // a fine texture
        half.albedo[size_t(3 * i)] = 0.5f + 0.3f * float((i * 7919) % 17) / 17;
    const auto colour = [&](int x, int y, int c) {
        return 1 + 0.05 * x - 0.02 * y + (2 + c) * double(half.albedo[size_t(3 * (y * WIDTH + x))]);
    };
    shine(half, 0, colour);
    for (const DenoiseCandidate& candidate : filter().candidates(half))
        EXPECT_LT(error_of(candidate.half, colour), 0.03) << "colours are 1 to 6";
}

TEST(DenoiseFilter, NoiseOfAWallIsAveraged) {
    HalfPicture half = wall();
    const auto colour = [](int x, int, int) { return 1 + 0.01 * x; };
    shine(half, 0.3, colour);
    for (const DenoiseCandidate& candidate : filter().candidates(half)) {
        EXPECT_LT(error_of(candidate.half, colour), 0.045) << "less than a fifth of 0.3 / sqrt(2)";
        EXPECT_GT(error_of(candidate.quarter[0], colour), error_of(candidate.half, colour));
    }
}

TEST(DenoiseFilter, FeaturesKeepEdges) {
    // Left and right of a faint edge, surfaces differ in one feature each, or in none.
    const auto colour = [](int x, int, int) { return x < 20 ? 1.4 : 1.0; };
    HalfPicture of_nothing = wall(), of_albedo = wall(), of_normal = wall(), of_depth = wall(),
                of_sky = wall();
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        if (i % WIDTH < 20)
            continue;
        of_albedo.albedo[3 * i] = 0.1f;
        of_normal.normal[3 * i] = 1;
        of_normal.normal[3 * i + 2] = 0;
        of_depth.position[3 * i + 2] = -1;
        of_sky.share[i] = 0;
    }
    const auto error = [&](HalfPicture& half) {
        shine(half, 0.3, colour);
        return error_of(filter().candidates(half).back().half, colour);
    };
    const double blurred = error(of_nothing);
    EXPECT_LT(error(of_albedo), 0.7 * blurred);
    EXPECT_LT(error(of_normal), 0.7 * blurred);
    EXPECT_LT(error(of_depth), 0.7 * blurred);
    EXPECT_LT(error(of_sky), 0.7 * blurred);
}

TEST(DenoiseFilter, ColoursKeepTheEdgesOfShadows) {
    HalfPicture half = wall();
    const auto colour = [](int x, int, int) { return x < 20 ? 4.0 : 1.0; };
    shine(half, 0.1, colour);
    EXPECT_LT(error_of(filter().candidates(half)[0].half, colour), 0.2);
}

TEST(DenoiseFilter, BrightNoiseDoesNotSpreadToWhatIsDark) {
    HalfPicture half = wall();
    const auto colour = [](int x, int, int) { return x < 20 ? 3.0 : 1.0; };
    shine(half, 0.01, colour);
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 1.5);
    for (Pixels& quarter : half.quarter)
        for (size_t i = 0; i < quarter.size(); ++i)
            if (i / 3 % WIDTH < 20)
                quarter[i] += float(noise(random));
    const Pixels filtered = filter().candidates(half)[0].half;
    double error = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 20; x < 32; ++x)
            error = std::max(error, std::abs(double(filtered[size_t(3 * (y * WIDTH + x))]) - 1));
    EXPECT_LT(error, 0.05) << "0.12 by the larger noise of two pixels";
}

TEST(DenoiseFilter, LampsDoNotSpread) {
    // Colours tell the faint lamp hardly from the wall, and the bright one would be in what guides the wall.
    const auto is_lamp = [](int x, int y) { return x >= 14 && x < 22 && y >= 8 && y < 16; };
    const auto beside_lamp = [&](double lamp) {
        HalfPicture half = wall();
        shine(half, 0.8, [&](int x, int y, int) { return is_lamp(x, y) ? lamp : 1.0; });
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
            half.lit[size_t(i)] = is_lamp(i % WIDTH, i / WIDTH);
        Pixels others;
        for (const DenoiseCandidate& candidate : filter().candidates(half))
            for (int i = 0; i < WIDTH * HEIGHT; ++i)
                if (!half.lit[size_t(i)])
                    others.push_back(candidate.half[size_t(3 * i)]);
        return others;
    };
    const Pixels expected = beside_lamp(1);
    EXPECT_EQ(beside_lamp(1.6), expected);
    EXPECT_EQ(beside_lamp(300), expected);
}

TEST(DenoiseFilter, SurfacesAtOtherDepthsAreOthers) {
    // Each is darker from left to right, so that one model with a step does not fit both.
    HalfPicture half = wall();
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i)
        half.position[3 * i + 2] = i % WIDTH < 20 ? 0 : -0.5f;
    const auto colour = [](int x, int, int) { return x < 20 ? 2 - 0.05 * x : 1 + 0.05 * (x - 20); };
    shine(half, 0.3, colour);
    EXPECT_LT(error_of(filter().candidates(half)[1].half, colour), 0.03) << "0.038 with one model for both";
}

TEST(DenoiseFilter, AQuarterIsMadeOfItsOwnColours) {
    HalfPicture half = wall();
    shine(half, 0, [](int, int, int) { return 1.0; });
    for (float& value : half.quarter[1])
        value = 2;
    for (const DenoiseCandidate& candidate : filter().candidates(half)) {
        EXPECT_LT(error_of(candidate.quarter[0], [](int, int, int) { return 1.0; }), 1e-3);
        EXPECT_LT(error_of(candidate.quarter[1], [](int, int, int) { return 2.0; }), 1e-3);
    }
}

TEST(DenoiseFilter, NoPixelStaysBrightAloneNorBecomesNegative) {
    HalfPicture half = wall();
    shine(half, 0.05, [](int x, int, int) { return x < 20 ? 0.5 * (20 - x) : 0.0; });
    const size_t speck = size_t(3 * (17 * WIDTH + 35));
    half.quarter[0][speck] = 100;
    for (const DenoiseCandidate& candidate : filter().candidates(half)) {
        EXPECT_GE(*std::min_element(candidate.half.begin(), candidate.half.end()), 0);
        EXPECT_LT(candidate.quarter[0][speck], 4) << "of a hundred, among 289 pixels";
    }
}

TEST(DenoiseFilter, AQuarterIsFilteredByWhatTheOtherLooksLike) {
    // Another first quarter leaves the second one's weights, and so its result, only where its own colours
    // say.
    HalfPicture half = wall();
    shine(half, 0.3, [](int, int, int) { return 1.0; });
    const DenoiseCandidate before = filter().candidates(half)[0];
    for (float& value : half.quarter[0])
        value *= 1.0009765625f;
    const DenoiseCandidate after = filter().candidates(half)[0];
    EXPECT_NE(before.quarter[0], after.quarter[0]);
    double difference = 0;
    for (size_t i = 0; i < before.quarter[1].size(); ++i)
        difference =
            std::max(difference, std::abs(double(before.quarter[1][i]) - double(after.quarter[1][i])));
    EXPECT_LT(difference, 0.01);
    EXPECT_EQ(filter().candidates(half)[0].half, after.half) << "the same bits again";
}

TEST(DenoiseFilter, AQuartersOwnColoursDoNotTellWhichPixelsAreAlike) {
    // A stripe that the first quarter alone has is noise to it: the other quarter shows no edge, and by its
    // own colours the stripe would stay. The other quarter has none to smear, whatever guides it.
    HalfPicture half = wall();
    shine(half, 0, [](int, int, int) { return 1.0; });
    const auto in_stripe = [](int x) { return x >= 20 && x < 23; };
    for (int i = 0; i < WIDTH * HEIGHT; ++i)
        if (in_stripe(i % WIDTH))
            std::fill_n(half.quarter[0].begin() + 3 * i, 3, 3.0f);
    const auto mean_of_stripe = [&](const Pixels& pixels) {
        double sum = 0;
        for (size_t i = 0; i < pixels.size(); ++i)
            sum += in_stripe(int(i / 3 % WIDTH)) ? double(pixels[i]) / (3 * 3 * HEIGHT) : 0;
        return sum;
    };
    for (const DenoiseCandidate& candidate : filter().candidates(half)) {
        std::printf("stripe of 3 after filtering: %.3f\n", mean_of_stripe(candidate.quarter[0]));
        EXPECT_LT(mean_of_stripe(candidate.quarter[0]), 1.9);
        EXPECT_NEAR(mean_of_stripe(candidate.quarter[1]), 1, 1e-3);
    }
}

} // namespace clrt
