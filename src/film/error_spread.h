// SPDX-License-Identifier: Apache-2.0
// Where in a picture its error sits.
#pragma once

#include "film/error_measure.h"

#include <optional>

namespace clrt {

/// Where the error sits, over the pixels that show the scene; by the relative measure, in weighted squares.
struct ErrorSpread {
    double worst_tile = 0; ///< sqrt(mean squared error of a tile's pixels) / mean radiance of all of them
    int tile_x = 0, tile_y = 0; ///< top left pixel of that tile within the window
    size_t tail_pixels = 0;     ///< the noisiest thousandth of the pixels
    double tail_share = 0;      ///< their share of the sum of squared errors
    double once_share = 0;      ///< share of the pixels in which one replicate alone saw something
    double once_error = 0;      ///< relative standard error of the squared error, from what was seen once
    /// Whether the error can be believed.
    bool usable() const { return once_error <= LARGEST_ONCE_ERROR; }

    /// Three standard errors then move the squared error by 1.2^2 - 1, and so the error itself by a fifth.
    static constexpr double LARGEST_ONCE_ERROR = (1.2 * 1.2 - 1) / 3;
};

/// Side of the tiles that are compared, pixels.
constexpr int ERROR_TILE_SIZE = 32;

/// None when there is no error or it is 0.
std::optional<ErrorSpread> film_error_spread(const Film& film, ErrorMeasure measure = ErrorMeasure::MSE);

} // namespace clrt
