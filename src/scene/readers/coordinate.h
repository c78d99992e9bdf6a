// SPDX-License-Identifier: Apache-2.0
// What a number of a file is worth as a coordinate.
#pragma once

#include <cmath>
#include <limits>

namespace clrt {

/// Beyond the range of float a coordinate is infinite or zero: squares of sizes stay in the range of double.
inline double as_coordinate(double x) {
    const double size = std::fabs(x);
    if (size > double(std::numeric_limits<float>::max()))
        return std::copysign(std::numeric_limits<double>::infinity(), x);
    return size < double(std::numeric_limits<float>::denorm_min()) ? 0 : x;
}

} // namespace clrt
