// SPDX-License-Identifier: Apache-2.0
// Radiance -> 8-bit sRGB.
#include "output/tonemap.h"

#include "colour.h"
#include "output/agx.h"

#include <cmath>
#include <glm/common.hpp>

namespace clrt {

namespace {

/// Above any radiance a picture can hold and small enough to be squared.
constexpr double LARGEST_RADIANCE = 1e100;

double displayable(double radiance) {
    return radiance > 0 ? std::fmin(radiance, LARGEST_RADIANCE) : 0;
}

/// J. Hable, "Uncharted 2: HDR Lighting", Game Developers Conference 2010: the slopes of toe, middle and
/// shoulder as a quotient of two parabolas, less its value at 0.
glm::dvec3 hable_quotient(const glm::dvec3& x) {
    constexpr double SHOULDER = 0.15, LINEAR = 0.50, LINEAR_ANGLE = 0.10, TOE = 0.20, TOE_NUMERATOR = 0.02,
                     TOE_DENOMINATOR = 0.30;
    return (x * (SHOULDER * x + LINEAR_ANGLE * LINEAR) + TOE * TOE_NUMERATOR) /
               (x * (SHOULDER * x + LINEAR) + TOE * TOE_DENOMINATOR) -
           TOE_NUMERATOR / TOE_DENOMINATOR;
}

/// The curve with the talk's exposure bias and its white. Beyond white it is 1: the parabolas of large
/// numbers are infinite.
glm::dvec3 hable(const glm::dvec3& linear) {
    constexpr double EXPOSURE_BIAS = 2, WHITE = 11.2;
    return hable_quotient(glm::min(EXPOSURE_BIAS * linear, WHITE)) / hable_quotient(glm::dvec3(WHITE));
}

} // namespace

glm::dvec3 tonemap_curve(const glm::dvec3& x, Tonemap tonemap) {
    switch (tonemap) {
    case Tonemap::REINHARD:
        return x / (1 + luminance(x));
    case Tonemap::ACES:
        // K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
        return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
    case Tonemap::FILMIC:
        return hable(x);
    case Tonemap::AGX:
        return agx(x);
    case Tonemap::NONE:
        break;
    }
    return x;
}

double srgb_encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<std::uint8_t, 3> display_colour(const glm::dvec3& radiance, double exposure_factor,
                                           Tonemap tonemap) {
    const glm::dvec3 exposed = radiance * exposure_factor;
    const glm::dvec3 mapped =
        tonemap_curve({displayable(exposed.x), displayable(exposed.y), displayable(exposed.z)}, tonemap);
    std::array<std::uint8_t, 3> bytes{};
    for (int i = 0; i < 3; ++i)
        bytes[static_cast<size_t>(i)] =
            static_cast<std::uint8_t>(std::lround(255 * srgb_encode(std::fmin(mapped[i], 1))));
    return bytes;
}

} // namespace clrt
