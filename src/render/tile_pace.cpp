// SPDX-License-Identifier: Apache-2.0
#include "render/tile_pace.h"

#include <algorithm>

namespace clrt {

namespace {

/// Samples of a launch stay in 32 bits.
constexpr double MOST_SAMPLES = 1 << 20;

} // namespace

u32 TilePace::tiles(double samples) const {
    if (pass_seconds_ <= 0)
        return std::max(tile_count_ / 16, std::min(tile_count_, 64u));
    const double share = LAUNCH_SECONDS / (pass_seconds_ * samples);
    return share >= 1 ? tile_count_ : std::max(u32(share * tile_count_), 1u);
}

u32 TilePace::samples() const {
    return pass_seconds_ > 0 ? u32(std::clamp(LAUNCH_SECONDS / pass_seconds_, 1.0, MOST_SAMPLES)) : 1;
}

void TilePace::note(double seconds, double samples, u32 tiles) {
    pass_seconds_ = seconds / samples * tile_count_ / tiles;
}

} // namespace clrt
