// SPDX-License-Identifier: Apache-2.0
// Floats as the words that files and device buffers hold.
#pragma once

#include <cstdint>
#include <cstring>

namespace clrt {

/// The 32 bits of a float.
inline std::uint32_t float_bits(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// The float of 32 bits.
inline float float_of_bits(std::uint32_t bits) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

} // namespace clrt
