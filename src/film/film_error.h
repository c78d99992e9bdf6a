// SPDX-License-Identifier: Apache-2.0
// How wrong a picture is and what a better one costs. The unit of all statistics is the replicate: the spread
// of the replicates' means holds for every integrator, whatever neighbouring samples or pixels have in
// common.
#pragma once

#include "film/film.h"

#include <optional>

namespace clrt {

/// The pixels that an error is stated over.
enum class ErrorPixels {
    SCENE, ///< those that show the scene; all where that is not known, and where none does
    ALL
};

/// Whether the error over the scene leaves pixels out: those that show nothing but what is behind it.
bool has_backdrop(const Film& film);

/// The squared error of a picture at one moment of its render, as its replicates tell it.
struct SquaredError {
    std::uint64_t samples = 0; ///< a pixel
    double mean_squared = 0;   ///< mean over these pixels and channels of the variance of the mean
    double mean_radiance = 0;  ///< over the same
    std::vector<double>
        without; ///< mean_squared of the pictures that leave out one replicate; empty under four
    /// Of freedom, of the picture's squared error: as many equal pixels of one channel would scatter as it
    /// does. 0 under four replicates and without an error.
    double degrees = 0;
};

/// None when fewer than two replicates have samples. The same film gives the same bits. What is behind the
/// scene has little noise, and is as bright and as much of the picture as its author likes: over all pixels
/// the same rendering of the same objects has any error.
std::optional<SquaredError> film_squared_error(const Film& film, ErrorPixels pixels = ErrorPixels::SCENE);

/// Relative error of the picture: sqrt(mean over pixels and channels of the variance of the mean) / mean
/// radiance, with a 95 % interval for the error that this very picture has, |picture - truth| instead of the
/// variance.
///
/// Let d_k be how far the mean of replicate k of n is off, in all channels of all pixels. The picture's
/// squared error |sum d_k|^2 / n^2 differs from its estimate by the sum over pairs of replicates of d_k.d_l /
/// (n(n-1)), whose variance is 2 / (n (n-1)) times the sum over the pixels, which are independent, of tr(C^2)
/// with the covariance C of a replicate's channels: no fourth moment is in it, whatever the distribution,
/// because bright samples that are rare are in the error as well as in its estimate. With nu degrees of
/// freedom of the sum over the pixels (Satterthwaite 1946) this is the variance of Fisher's F with nu and
/// (n-1) nu degrees, which is the distribution of the ratio where the d_k are normal.
struct FilmError {
    double relative_rmse = 0;
    std::optional<double> low, high; ///< none under four replicates
};

/// None when the picture is black.
std::optional<FilmError> relative_error(const SquaredError& error);

/// None when fewer than two replicates have samples, or the picture is black.
std::optional<FilmError> film_error(const Film& film, ErrorPixels pixels = ErrorPixels::SCENE);

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

/// Where the error sits, over the pixels that show the scene.
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
std::optional<ErrorSpread> film_error_spread(const Film& film);

} // namespace clrt
