// SPDX-License-Identifier: Apache-2.0
// Floats of 16 bits (IEEE 754 binary16) that are not negative, as the device's buffers hold them.
#pragma once

#include "float_bits.h"

#include <cmath>

namespace clrt {

constexpr float LARGEST_HALF = 65504;

/// The exponents of a half lie so much lower than those of a float, and its mantissa is so much shorter.
constexpr std::uint32_t HALF_EXPONENT = 112, HALF_SHORTER = 13;

/// The float of a half, which is finite and not negative.
inline float from_half(std::uint32_t half) {
    return half < 1u << 10 ? std::ldexp(float(half), -24)
                           : float_of_bits((half + (HALF_EXPONENT << 10)) << HALF_SHORTER);
}

/// The nearest half of a number from 0 to LARGEST_HALF; the even one of two.
inline std::uint32_t to_half(float value) {
    if (value < 0x1p-14f)
        return std::uint32_t(std::nearbyint(value * 0x1p24f));
    const std::uint32_t bits = float_bits(value), even = bits >> HALF_SHORTER & 1;
    return ((bits + (1u << (HALF_SHORTER - 1)) - 1 + even) >> HALF_SHORTER) - (HALF_EXPONENT << 10);
}

} // namespace clrt
