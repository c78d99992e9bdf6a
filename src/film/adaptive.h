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
// over powers of two. By the relative measure (error_measure.h) noise is weighted, that of each pixel by its
// own mean in the half that decides: whatever it is, it says nothing of the half that is decided on, and
// follows brightness within a tile, which gains 4 to 14 % over the tile's mean on cornell_box and
// spheres_over_plane. Time a sample is left out of it: seconds would not give the same bits twice, and
// pictures gain less than a tenth by them.
//
// What is to be gained is known from the noise v of the tiles: with as many samples the squared error becomes
// mean(v) / mean(sqrt(v))^2 times smaller (somewhat less where a tile's share is bounded). A half whose
// partner expects less than WORTHWHILE_GAIN of it gets its samples everywhere alike. No OpenCL here.
#pragma once

#include "film/error_measure.h"

#include <cstdint>
#include <vector>

namespace clrt {

/// Below this factor of the squared error samples stay the same everywhere.
constexpr double WORTHWHILE_GAIN = 1.1;

/// Noise of one sample in each half and tile.
using TileNoise = std::array<std::vector<double>, 2>;

/// One round: from so many samples a pixel, on average over the picture, to so many.
struct AdaptiveRound {
    ErrorMeasure measure = ErrorMeasure::MSE; ///< the error that samples are to make least, and are judged by
    std::uint64_t first = 0, end = 0;
    TileSamples start, target; ///< what the tiles of both halves have before and after it
    /// Noise as the first p, 2 p, 4 p, ... samples of a half told it, p being those of the first round;
    /// negative where a tile has not had so many before the round.
    std::vector<TileNoise> noise;
    /// What the noise of the first and that of the second half lets expect, as a factor of the squared error;
    /// 0 before the first decision.
    std::array<double, 2> gain{};
};

/// Samples a pixel before the first decision: two in every replicate.
std::uint64_t pilot_samples(int replicates);

/// The first round, in which all tiles are equal.
AdaptiveRound first_round(const Film& film, ErrorMeasure measure = ErrorMeasure::MSE);

/// The round after `last`, which the film has finished; the same films give the same rounds.
AdaptiveRound next_round(const Film& film, const AdaptiveRound& last);

/// The samples of the tiles when a round has come to `samples` a pixel on average: every tile has made the
/// same part of its way, rounded to whole samples of every replicate.
TileSamples samples_within(const AdaptiveRound& round, std::uint64_t samples, int replicates);

/// Noise of one sample in each tile: mean over pixels and channels of the variance of the mean of a half,
/// times its samples; by the relative measure weighted.
std::vector<double> tile_noise(const Film& film, int half, ErrorMeasure measure = ErrorMeasure::MSE);

/// The factor by which samples in proportion to the root of the noise, in tiles of so many pixels, make the
/// squared error smaller than as many that are the same everywhere; 1 without noise.
double expected_gain(const std::vector<double>& noise, const std::vector<std::uint32_t>& pixels);

/// What both halves expect: the mean of their factors.
inline double expected_gain(const AdaptiveRound& round) {
    return 0.5 * (round.gain[0] + round.gain[1]);
}

} // namespace clrt
