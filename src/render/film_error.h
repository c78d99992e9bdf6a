// SPDX-License-Identifier: Apache-2.0
// How wrong a picture is and what a better one costs. The unit of all statistics is the replicate: the spread
// of the replicates' means holds for every integrator, whatever neighbouring samples or pixels have in
// common.
#pragma once

#include "render/film.h"

#include <optional>

namespace clrt {

/// The squared error of a picture at one moment of its render, as its replicates tell it.
struct SquaredError {
    std::uint64_t samples = 0; ///< a pixel
    double mean_squared = 0;   ///< mean over pixels and channels of the variance of the mean
    double mean_radiance = 0;  ///< over pixels and channels
    std::vector<double>
        without; ///< mean_squared of the pictures that leave out one replicate; empty under four
};

/// None when fewer than two replicates have samples. The same film gives the same bits.
std::optional<SquaredError> film_squared_error(const Film& film);

/// Relative error of the picture: sqrt(mean over pixels and channels of the variance of the mean) / mean
/// radiance, with a 95 % interval by the jackknife over replicates (on the logarithm, Student's t).
struct FilmError {
    double relative_rmse = 0;
    std::optional<double> low, high; ///< none under four replicates
};

/// None when the picture is black.
std::optional<FilmError> relative_error(const SquaredError& error);

/// None when fewer than two replicates have samples, or the picture is black.
std::optional<FilmError> film_error(const Film& film);

/// How the error falls: d log(error) / d log(samples), -0.5 for independent samples.
struct ErrorSlope {
    double slope = 0;
    double reach = 0; ///< half the length of its 95 % interval, by the jackknife over replicates
    std::uint64_t first_samples = 0, last_samples = 0;
};

/// The line of least squares through a render's errors. None under four octaves of samples, five errors or
/// four replicates, or where an error is 0.
std::optional<ErrorSlope> error_slope(const std::vector<SquaredError>& history);

/// The same through as few as two errors.
std::optional<ErrorSlope> fit_error_slope(const std::vector<SquaredError>& history);

/// Where the error sits.
struct ErrorSpread {
    double worst_tile = 0;      ///< sqrt(mean squared error of a tile) / mean radiance of the picture
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
std::optional<ErrorSpread> film_error_spread(const Film& film);

} // namespace clrt
