// SPDX-License-Identifier: Apache-2.0
// How much of a picture one launch renders, so that no launch takes long: paths of one scene can be a
// thousand times longer than those of another, and nobody knows before the first ones are traced. No OpenCL
// here.
#pragma once

#include "kernels/shared/types.h"

namespace clrt {

/// Launches aim at this long: short enough for progress, Ctrl-C and the watchdogs of display drivers.
constexpr double LAUNCH_SECONDS = 0.5;

/// A launch does at most this many times the work of the one before. Consecutive tiles are spread over the
/// picture (kernels/film/tile.h), so that so many more cost about what was measured.
constexpr double LARGEST_LAUNCH_GROWTH = 4;

/// Chooses the tiles of each launch by the time that the last one took.
class LaunchSize {
public:
    /// The first launch gives every compute unit of the device one tile.
    explicit LaunchSize(unsigned compute_units);

    /// Tiles of the next launch of `samples` samples a pixel, of `left` tiles; at least one. What is left is
    /// dealt out evenly, so that no last launch is too small to time.
    u32 tiles(double samples, u32 left) const;

    /// Samples a pixel that the next launch can give to so many tiles at once; at least one.
    u32 samples(u32 tiles) const;

    /// The launch took this long.
    void took(u32 tiles, double samples, double seconds);

private:
    double largest_work_; ///< tiles times samples of the next launch
};

} // namespace clrt
