// SPDX-License-Identifier: Apache-2.0
// Adaptive sampling without bias. The replicates are two halves, and the picture is the mean of both halves'
// means, each by weight 1/2. How many samples a half takes in a tile is decided by the noise of the *other*
// half: a tile that is dark by bad luck looks less noisy than it is, and whoever stopped there by its own
// noise would keep the bad luck. For the same reason that noise is taken from samples of a number that
// nothing has decided, the first ones, which every tile has by then: else a half would decide, through the
// number of its partner's samples, on its own. So a half's numbers are a function of the other half's samples
// alone, and its means are unbiased whatever they are.
//
// Two rounds double the mean number of samples a pixel. The number in a tile is the root of the noise of one
// sample, which makes the mean squared error least, rounded to a power of two, because Sobol points are even
// over powers of two. Time a sample is left out of it: seconds would not give the same bits twice, and
// pictures gain less than a tenth by them. No OpenCL here.
#pragma once

#include "film/film.h"

#include <cstdint>
#include <vector>

namespace clrt {

/// Noise of one sample in each half and tile.
using TileNoise = std::array<std::vector<double>, 2>;

/// One round: from so many samples a pixel, on average over the picture, to so many.
struct AdaptiveRound {
    std::uint64_t first = 0, end = 0;
    TileSamples start, target; ///< what the tiles of both halves have before and after it
    /// Noise as the first p, 2 p, 4 p, ... samples of a half told it, p being those of the first round;
    /// negative where a tile has not had so many before the round.
    std::vector<TileNoise> noise;
};

/// Samples a pixel before the first decision: two in every replicate.
std::uint64_t pilot_samples(int replicates);

/// The first round, in which all tiles are equal.
AdaptiveRound first_round(const Film& film);

/// The round after `last`, which the film has finished; the same films give the same rounds.
AdaptiveRound next_round(const Film& film, const AdaptiveRound& last);

/// The samples of the tiles when a round has come to `samples` a pixel on average: every tile has made the
/// same part of its way, rounded to whole samples of every replicate.
TileSamples samples_within(const AdaptiveRound& round, std::uint64_t samples, int replicates);

/// Noise of one sample in each tile: mean over pixels and channels of the variance of the mean of a half,
/// times its samples.
std::vector<double> tile_noise(const Film& film, int half);

} // namespace clrt
