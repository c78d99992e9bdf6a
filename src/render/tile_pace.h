// SPDX-License-Identifier: Apache-2.0
// How much of the picture fits one launch, by how long the last one took.
#pragma once

#include "kernels/shared/types.h"

namespace clrt {

/// Launches aim at this long: short enough for progress, Ctrl-C and the watchdogs of display drivers.
constexpr double LAUNCH_SECONDS = 0.5;

/// The time of one kernel's launches.
class TilePace {
public:
    explicit TilePace(u32 tile_count) : tile_count_(tile_count) {}

    /// Tiles that a launch of `samples` a pixel takes; a cautious first share while no launch has been timed.
    u32 tiles(double samples) const;
    /// Samples a pixel that all tiles can have in one launch, at least 1; 1 while none has been timed.
    u32 samples() const;
    /// Notes that a launch took so long.
    void note(double seconds, double samples, u32 tiles);

private:
    u32 tile_count_;
    double pass_seconds_ = 0; ///< of one sample a pixel, by the last launch
};

} // namespace clrt
