// SPDX-License-Identifier: Apache-2.0
// The AgX-like curve: what it does to greys, and that saturated light pales without changing its hue.
#include "output/agx.h"

#include "output/tonemap.h"

#include <cmath>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <vector>

namespace clrt {

namespace {

constexpr double DEGREES = 180 / 3.14159265358979323846;

/// Hue and chroma of Oklab (B. Ottosson, "A perceptual color space for image processing", 2020).
struct Hue {
    double degrees, chroma;
};

Hue oklab_hue(const glm::dvec3& c) {
    const double l = std::cbrt(0.4122214708 * c.x + 0.5363325363 * c.y + 0.0514459929 * c.z);
    const double m = std::cbrt(0.2119034982 * c.x + 0.6806995451 * c.y + 0.1073969566 * c.z);
    const double s = std::cbrt(0.0883024619 * c.x + 0.2817188376 * c.y + 0.6299787005 * c.z);
    const double a = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
    const double b = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
    return {std::atan2(b, a) * DEGREES, std::hypot(a, b)};
}

const std::vector<glm::dvec3> COLOURS = {{1, 0.02, 0.02}, {0.02, 1, 0.02}, {0.02, 0.02, 1}, {1, 0.3, 0.02},
                                         {1, 1, 0.02},    {0.02, 1, 1},    {1, 0.02, 1},    {0.3, 0.02, 1},
                                         {0.2, 0.5, 1},   {1, 0.3, 0.5}};

/// Root mean square of the hue's turn in degrees, weighted by chroma, from 4 stops below to 8.5 above.
double hue_turn(Tonemap tonemap) {
    double sum = 0;
    int count = 0;
    for (const glm::dvec3& colour : COLOURS)
        for (double ev = -4; ev <= 8.5; ev += 0.5, ++count) {
            const Hue shown = oklab_hue(glm::min(tonemap_curve(colour * std::exp2(ev), tonemap), 1.0));
            const double turn = std::remainder(shown.degrees - oklab_hue(colour).degrees, 360);
            sum += std::pow(turn * shown.chroma / 0.1, 2); // 0.1: the chroma of a plainly coloured paint
        }
    return std::sqrt(sum / count);
}

} // namespace

TEST(Agx, MiddleGreyStaysAndTheFourStopsAboutItStayFourStops) {
    EXPECT_NEAR(agx_curve(MIDDLE_GREY), MIDDLE_GREY, 1e-12);
    EXPECT_NEAR(std::log2(agx_curve(MIDDLE_GREY * 4) / agx_curve(MIDDLE_GREY / 4)), 4, 0.02);
    const double below =
        std::log2(agx_curve(MIDDLE_GREY) / agx_curve(MIDDLE_GREY * 0.999)) / std::log2(1 / 0.999);
    const double above =
        std::log2(agx_curve(MIDDLE_GREY * 1.001) / agx_curve(MIDDLE_GREY)) / std::log2(1.001);
    EXPECT_NEAR(above / below, 1, 1e-3); // no kink
}

TEST(Agx, TheCurveRisesFromBlackTenStopsBelowToWhiteSixAndAHalfAbove) {
    EXPECT_EQ(agx_curve(0), 0);
    EXPECT_NEAR(agx_curve(MIDDLE_GREY * std::exp2(-10)), 0, 1e-12);
    EXPECT_NEAR(agx_curve(MIDDLE_GREY * std::exp2(6.5)), 1, 1e-12);
    EXPECT_NEAR(agx_curve(1e100), 1, 1e-12);
    for (double stop = -10; stop < 6.5; stop += 0.125)
        EXPECT_LT(agx_curve(MIDDLE_GREY * std::exp2(stop)), agx_curve(MIDDLE_GREY * std::exp2(stop + 0.125)))
            << stop;
}

TEST(Agx, GreyStaysGrey) {
    for (double x = 1e-5; x < 1e4; x *= 1.7) {
        const glm::dvec3 shown = agx(glm::dvec3(x));
        EXPECT_NEAR(shown.x, agx_curve(x), 1e-12);
        EXPECT_NEAR(shown.y, shown.x, 1e-12);
        EXPECT_NEAR(shown.z, shown.x, 1e-12);
    }
}

TEST(Agx, EveryColourIsShownWithinTheDisplaysRange) {
    for (const double r : {0.0, 1e-3, 0.2, 1.0, 30.0, 1e9})
        for (const double g : {0.0, 1e-3, 0.2, 1.0, 30.0, 1e9})
            for (const double b : {0.0, 1e-3, 0.2, 1.0, 30.0, 1e9})
                for (int c = 0; c < 3; ++c) {
                    EXPECT_GE(agx({r, g, b})[c], 0);
                    EXPECT_LE(agx({r, g, b})[c], 1);
                }
}

TEST(Agx, SaturatedLightEndsInWhite) {
    for (const glm::dvec3& colour : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
        const glm::dvec3 shown = agx(colour * MIDDLE_GREY * std::exp2(10));
        for (int c = 0; c < 3; ++c)
            EXPECT_GT(shown[c], 0.99);
    }
}

TEST(Agx, ColoursPaleWithoutTurningTheirHue) {
    const double turn = hue_turn(Tonemap::AGX);
    EXPECT_LT(turn, 4.7);
    for (const Tonemap other : {Tonemap::NONE, Tonemap::ACES, Tonemap::FILMIC})
        EXPECT_LT(turn, 0.35 * hue_turn(other));
}

TEST(Agx, ColoursAroundMiddleGreyStayWhatTheyAre) {
    for (const glm::dvec3& colour : {glm::dvec3(0.25, 0.15, 0.12), glm::dvec3(0.12, 0.2, 0.15)})
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(agx(colour)[c], colour[c], 0.09 * colour[c]);
}

} // namespace clrt
