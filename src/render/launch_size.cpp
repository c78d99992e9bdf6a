// SPDX-License-Identifier: Apache-2.0
#include "render/launch_size.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// Below this a clock tells nothing, seconds.
constexpr double SHORTEST_TIME = 1e-6;

/// Samples of a launch stay in 32 bits.
constexpr double MOST_SAMPLES = 1 << 20;

} // namespace

LaunchSize::LaunchSize(unsigned compute_units) : largest_work_(std::max(compute_units, 1u)) {}

u32 LaunchSize::tiles(double samples, u32 left) const {
    const double fitting = std::max(std::floor(largest_work_ / samples), 1.0);
    const double launches = std::ceil(left / fitting);
    return u32(std::ceil(left / launches));
}

u32 LaunchSize::samples(u32 tiles) const {
    return u32(std::clamp(largest_work_ / tiles, 1.0, MOST_SAMPLES));
}

void LaunchSize::took(u32 tiles, double samples, double seconds) {
    const double work = tiles * samples;
    largest_work_ = work * std::min(LAUNCH_SECONDS / std::max(seconds, SHORTEST_TIME), LARGEST_LAUNCH_GROWTH);
}

} // namespace clrt
