// SPDX-License-Identifier: Apache-2.0
// Weighted means over the surroundings of every pixel.
#pragma once

#include "denoise/half_picture.h"

namespace clrt {

/// Means with the weights of a binomial distribution of 2 `radius` + 1 outcomes in each direction, `channels`
/// values a pixel. What lies outside the picture is left out, the weights of the rest sum to 1. Sums in
/// double in a fixed order: the same bits everywhere.
Pixels smooth_binomial(const Pixels& values, int width, int height, int channels, int radius);

/// The same over the pixels of each one's own kind, 0 or 1.
Pixels smooth_alike(const Pixels& values, const std::vector<char>& kinds, int width, int height, int channels,
                    int radius);

/// The sum of the squares of those weights within the picture: the variance of a mean of independent pixels
/// over that of one.
double binomial_variance(int radius);

} // namespace clrt
