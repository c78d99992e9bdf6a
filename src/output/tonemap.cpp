// SPDX-License-Identifier: Apache-2.0
// Radiance -> 8-bit sRGB.
#include "output/tonemap.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

/// Luminance of linear Rec. 709 primaries (ITU-R BT.709-6, item 3.2).
const glm::dvec3 LUMINANCE(0.2126, 0.7152, 0.0722);
/// Above any radiance a picture can hold and small enough to be squared.
constexpr double LARGEST_RADIANCE = 1e100;

double displayable(double radiance) {
    return radiance > 0 ? std::fmin(radiance, LARGEST_RADIANCE) : 0;
}

} // namespace

glm::dvec3 tonemap_curve(const glm::dvec3& x, Tonemap tonemap) {
    switch (tonemap) {
    case Tonemap::REINHARD:
        return x / (1 + glm::dot(LUMINANCE, x));
    case Tonemap::ACES:
        // K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
        return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
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
