// SPDX-License-Identifier: Apache-2.0
// How large the small pictures are that tell, before a picture, how it is rendered best.
#pragma once

#include "options/options.h"

#include <cstdint>
#include <optional>

namespace clrt {

/// Of a render's work, what pilots may take.
constexpr double PILOT_SHARE = 0.05;

/// Size of a pilot's picture, and samples a pixel.
struct PilotSize {
    int width = 0, height = 0;
    std::uint32_t spp = 0;
    /// So many pixels square lie side by side as in the picture: a power of two up to TILE_SIZE.
    int patch = 1;
    std::uint64_t samples() const { return std::uint64_t(width) * std::uint64_t(height) * spp; }
};

/// Samples of all pixels that a render takes at least, as far as its options tell.
double expected_samples(const Options& options);

/// The same with whole tiles, each of pixels that lie side by side as in the picture.
PilotSize in_tiles(PilotSize size);

/// Size of pilots of which a sample each takes the work of so many samples of the picture, all of one size
/// and at most PILOT_SHARE of its work; none where so small ones tell nothing.
std::optional<PilotSize> size_of_pilots(double work, const Options& options);

/// Size of a pilot of the window with so many samples of all its pixels, and so many of each: its pixels may
/// be smaller than the picture's.
PilotSize scaled_pilot(const Options& options, double samples, std::uint32_t spp);

/// Size of the pilots that compare ways to sample the sky; none for frames that are not worth one. Nets of
/// eight samples, and pixels that are not too large, whose own contents would count as noise of all ways.
std::optional<PilotSize> sky_pilot_size(const Options& options);

} // namespace clrt
