// SPDX-License-Identifier: Apache-2.0
// Radiance -> the 8-bit sRGB values of PNG and its kind.
#pragma once

#include "options/output_options.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

namespace clrt {

/// The luminance of a card that reflects 18 % of what makes white, the middle of the tones.
constexpr double MIDDLE_GREY = 0.18;

/// The curve on linear RGB from 0; the result is from 0 and still linear, and may exceed 1, which is white.
/// NONE: as it is. REINHARD: x / (1 + x) on the luminance, so that hues stay (Reinhard et al. 2002, equation
/// 3). ACES: the fit of the ACES filmic curve by Narkowicz (2015), per channel. FILMIC: Hable's curve
/// (2010), a long shoulder, per channel, white at 5.6. AGX: output/agx.h.
glm::dvec3 tonemap_curve(const glm::dvec3& linear, Tonemap tonemap);

/// The exact sRGB transfer function (IEC 61966-2-1): linear 0..1 -> encoded 0..1.
double srgb_encode(double linear);

/// Radiance times 2^exposure, tone-mapped, clamped to 0..1, sRGB-encoded and rounded to the nearest of
/// 0..255. NaN and negative values become 0, infinity the largest value.
std::array<std::uint8_t, 3> display_colour(const glm::dvec3& radiance, double exposure_factor,
                                           Tonemap tonemap);

} // namespace clrt
