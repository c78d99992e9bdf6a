// SPDX-License-Identifier: Apache-2.0
// What an error is relative to. By the measure MSE the squared error of a picture is
//
//     mean of (x - truth)^2 / m^2,
//
// m being the picture's mean radiance, and by the relative measure
//
//     mean of (x - truth)^2 / (r^2 + (RELATIVE_FLOOR m)^2)
//
// over pixels and channels, r being the radiance of the pixel's channel. The floor keeps what is nearly black
// from deciding. Since 1 / r^2 of a noisy pixel says more of its noise than of its brightness, and is small
// where the pixel is bright by chance, r is taken from the tile around it: of ERROR_BLOCK_SIZE x
// ERROR_BLOCK_SIZE pixels of the picture. What bright samples add to it takes some of their weight: an error
// of 15 % is told right, one of 36 % 4 % too low (rooms of error_bar_test). The error is the root of this.
#pragma once

#include "film/error_pixels.h"
#include "options/sampling_options.h"

namespace clrt {

/// Of the picture's mean radiance: what is darker counts as if it were nearly as bright.
constexpr double RELATIVE_FLOOR = 0.1;

/// Side of the tiles over which brightness is averaged, pixels: 192 values.
constexpr int ERROR_BLOCK_SIZE = 8;

/// What a squared error weighs by the relative measure where the radiance is `radiance`, beside one by the
/// measure MSE; `mean` is that of the picture, not 0.
inline double relative_weight(double radiance, double mean) {
    const double floor = RELATIVE_FLOOR * mean;
    return mean * mean / (radiance * radiance + floor * floor);
}

/// What squared errors weigh in a picture: 1 by the measure MSE.
class ErrorWeights {
public:
    /// Averages over the pixels that `choice` has.
    ErrorWeights(const Film& film, const PixelChoice& choice, ErrorMeasure measure);
    /// Of value `i` (pixel and channel) of a plane.
    double of(size_t i) const { return weights_.empty() ? 1 : weights_[3 * block(i / 3) + i % 3]; }

private:
    size_t block(size_t pixel) const {
        return pixel / width_ / ERROR_BLOCK_SIZE * across_ + pixel % width_ / ERROR_BLOCK_SIZE;
    }

    size_t width_, across_;
    std::vector<double> weights_; ///< of a block's channels, block by block; empty: all are 1
};

} // namespace clrt
