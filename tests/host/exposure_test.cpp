// SPDX-License-Identifier: Apache-2.0
// Exposure by the picture's tones.
#include "output/exposure.h"

#include "output/tonemap.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace clrt {

namespace {

/// Grey pixels of these luminances.
std::vector<float> greys(const std::vector<double>& luminances) {
    std::vector<float> rgb;
    for (const double y : luminances)
        rgb.insert(rgb.end(), 3, float(y));
    return rgb;
}

/// Luminances whose logarithms are even between so many stops.
std::vector<double> even_tones(double lowest, double highest, int count = 1000) {
    std::vector<double> tones;
    for (int i = 0; i < count; ++i)
        tones.push_back(std::exp2(lowest + (highest - lowest) * (i + 0.5) / count));
    return tones;
}

} // namespace

TEST(AutoExposure, OneToneBecomesMiddleGrey) {
    for (const double y : {1e-6, 0.18, 1.0, 3e5})
        EXPECT_NEAR(auto_exposure_ev(greys({y, y, y})), std::log2(MIDDLE_GREY / y), 0.0051) << y;
    EXPECT_EQ(auto_exposure_ev(greys({0.18})), 0);
}

TEST(AutoExposure, EvenTonesPutTheirMiddleAtMiddleGrey) {
    EXPECT_NEAR(auto_exposure_ev(greys(even_tones(-8, 4))), std::log2(MIDDLE_GREY) + 2, 0.0051);
}

// Reinhard 2002: key = 0.18 * 4^((2 mean - darkest - brightest) / (brightest - darkest)), in log2; not below
// 0.18.
TEST(AutoExposure, PicturesOfBrightTonesStayBrighterAndThoseOfDarkOnesAreSeen) {
    std::vector<double> bright(900, 1.0), dark(900, std::exp2(-8));
    bright.insert(bright.end(), 100, std::exp2(-8));
    dark.insert(dark.end(), 100, 1.0);
    EXPECT_NEAR(auto_exposure_ev(greys(bright)), std::log2(MIDDLE_GREY) + 2 * 0.8 + 0.8, 0.0051);
    EXPECT_NEAR(auto_exposure_ev(greys(dark)), std::log2(MIDDLE_GREY) + 7.2, 0.0051);
}

TEST(AutoExposure, TwiceTheLightIsOneStopLess) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> tone(0, 2);
    std::vector<double> tones(5000);
    std::generate(tones.begin(), tones.end(), [&] { return tone(random); });
    const double ev = auto_exposure_ev(greys(tones));
    for (const double stops : {-10.0, 1.0, 7.0}) {
        std::vector<double> scaled = tones;
        for (double& y : scaled)
            y *= std::exp2(stops);
        EXPECT_NEAR(auto_exposure_ev(greys(scaled)), ev - stops, 0.011);
    }
}

TEST(AutoExposure, BlackBackdropsFirefliesAndOddNumbersCountForNothing) {
    const std::vector<double> tones = even_tones(-5, 1);
    const double ev = auto_exposure_ev(greys(tones));
    std::vector<double> odd = tones;
    odd.insert(odd.end(), 4000, 0.0);
    odd.insert(odd.end(), {double(INFINITY), -3.0, std::numeric_limits<double>::quiet_NaN()});
    EXPECT_EQ(auto_exposure_ev(greys(odd)), ev);
    std::vector<double> fireflies = tones;
    std::fill_n(fireflies.end() - 5, 5, 1e30);
    EXPECT_NEAR(auto_exposure_ev(greys(fireflies)), ev, 0.02);
    EXPECT_EQ(auto_exposure_ev(greys({0, 0})), 0);
    EXPECT_EQ(auto_exposure_ev({}), 0);
}

TEST(AutoExposure, AHintSaysWhereLittleIsSeen) {
    OutputOptions options;
    const auto hint = [&](const std::vector<double>& tones) { return exposure_hint(options, greys(tones)); };
    EXPECT_EQ(hint({0.18}), "");
    EXPECT_EQ(hint({0.18 / 7}), "") << "a dim room is one";
    EXPECT_EQ(hint({0.18 * 7}), "");
    EXPECT_EQ(hint({0, 0}), "") << "that it is black is said elsewhere";
    EXPECT_EQ(hint({17, 0, 0}), "") << "a lamp before nothing";
    const std::string dark =
        "8-bit pictures come out dark: --exposure auto would show this one with +4 stops";
    EXPECT_EQ(hint({0.18 / 16}), dark);
    EXPECT_EQ(hint({0.18 * 32}),
              "8-bit pictures come out bright: --exposure auto would show this one with -5 stops");
    options.tonemap = Tonemap::AGX;
    EXPECT_EQ(hint({0.18 * 32}), "");
    EXPECT_EQ(hint({0.18 / 16}), dark);
}

TEST(AutoExposure, ItIsAWholeNumberOfHundredthsToWhichStopsAreAdded) {
    const std::vector<float> rgb = greys(even_tones(-6.1234, 2));
    OutputOptions options;
    options.exposure_ev = 0.5;
    EXPECT_EQ(chosen_exposure_ev(options, rgb), 0.5);
    options.auto_exposure = true;
    const double ev = chosen_exposure_ev(options, rgb);
    EXPECT_NEAR(ev, auto_exposure_ev(rgb) + 0.5, 1e-9);
    EXPECT_EQ(exposure_notice(ev), "exposure by the picture's tones: --exposure 0.09");
    EXPECT_EQ(ev, 0.09);
}

} // namespace clrt
