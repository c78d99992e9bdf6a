// SPDX-License-Identifier: Apache-2.0
// Linear RGB with Rec. 709 primaries (ITU-R BT.709) and the sRGB curve (IEC 61966-2-1).
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace clrt {

/// Relative luminance of a linear colour; the weights sum to 1.
inline double luminance(const glm::dvec3& colour) {
    return 0.2126 * colour.x + 0.7152 * colour.y + 0.0722 * colour.z;
}

/// The largest of the three components.
inline double largest_component(const glm::dvec3& colour) {
    return std::fmax(colour.x, std::fmax(colour.y, colour.z));
}

/// Decodes an sRGB value in [0,1].
inline double srgb_to_linear(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

} // namespace clrt
