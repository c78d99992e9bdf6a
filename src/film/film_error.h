// SPDX-License-Identifier: Apache-2.0
// How wrong a picture is and what a better one costs. The unit of all statistics is the replicate: the spread
// of the replicates' means holds for every integrator, whatever neighbouring samples or pixels have in
// common.
#pragma once

#include "film/error_measure.h"
#include "options/integrators.h"

#include <optional>

namespace clrt {

/// The squared error of a picture at one moment of its render, as its replicates tell it.
struct SquaredError {
    std::uint64_t samples = 0; ///< a pixel
    double mean_squared = 0;   ///< mean over these pixels and channels of the variance of the mean, weighted
    double mean_radiance = 0;  ///< over the same, not weighted
    std::vector<double>
        without; ///< mean_squared of the pictures that leave out one replicate; empty under four
    /// Of freedom, of the picture's squared error: as many equal pixels of one channel would scatter as it
    /// does. 0 under four replicates and without an error.
    double degrees = 0;
    /// Of freedom, of the variance that `degrees` follow from: some for each pixel that decides it.
    double pair_degrees = 0;
};

/// None when fewer than two replicates have samples. The same film gives the same bits. What is behind the
/// scene has little noise, and is as bright and as much of the picture as its author likes: over all pixels
/// the same rendering of the same objects has any error. Only the degrees depend on the film's `block` or,
/// where that is larger, this one: the side of the squares of pixels that are taken to be independent of each
/// other (FilmError): 1 where every sample belongs to one pixel, and where paths splat to neighbours, several
/// times as far as these are apart.
std::optional<SquaredError> film_squared_error(const Film& film, ErrorPixels pixels = ErrorPixels::SCENE,
                                               int block = 1, ErrorMeasure measure = ErrorMeasure::MSE);

/// Film::block of an integrator's films. Chains walk from pixel to pixel, and their steps splat what hardly
/// differs: taking pixels as independent, intervals held 81 % of the errors of 128 pictures of eight scenes.
/// Where paths are reused (kernels/integrators/path_reuse.h), they serve the pixels of a tile.
int error_block(Integrator integrator, bool reuses_paths);

/// Error of the picture by a measure (error_measure.h): for MSE, sqrt(mean over pixels and channels of the
/// variance of the mean) / mean radiance, with a 95 % interval for the error that this very picture has,
/// |picture - truth| instead of the variance.
///
/// Let d_k be how far the mean of replicate k of n is off, in all channels of all pixels. The picture's
/// squared error |sum d_k|^2 / n^2 differs from its estimate by the sum over pairs of replicates of d_k.d_l /
/// (n(n-1)), whose variance is 2 / (n (n-1)) times the sum over blocks of pixels, taken as independent, of
/// tr(C^2) with the covariance C of a replicate's channels in a block: no fourth moment is in it, whatever
/// the distribution, because bright samples that are rare are in the error as well as in its estimate. With
/// nu degrees of freedom of the sum over the blocks (Satterthwaite 1946) this is the variance of Fisher's F
/// with nu and (n-1) nu degrees, which is the distribution of the ratio where the d_k are normal.
///
/// nu itself is an estimate, and where few pixels decide, of few: the relative variance of the sum of the
/// blocks' tr(C^2) is about the sum of their squares over the square of their sum, and 2 over it are its
/// degrees of freedom, m. A picture that has missed a bright sample tells a smaller error and more degrees
/// than there are, so that it is the upper end that comes out too low. That end takes nu z^2 / t_m^2 degrees,
/// z and t_m being the quantiles of the normal distribution and of Student's (1908), and one at least, which
/// is what a single pixel has.
///
/// The estimate itself assumes only that replicates are independent. The interval assumes besides that pixels
/// are, or blocks of them (error_block), which holds where each gathers its own samples. Splats of one path to
/// pixels that are nearer than a block make it too narrow (where four pixels are always equal, half as wide as
/// it should be: it holds 64 % of the errors); those that lie anywhere in the picture are few in any two pixels
/// and do not.
struct FilmError {
    double relative_rmse = 0;
    std::optional<double> low, high; ///< none under four replicates
};

/// None when the picture is black.
std::optional<FilmError> relative_error(const SquaredError& error);

/// None when fewer than two replicates have samples, or the picture is black.
std::optional<FilmError> film_error(const Film& film, ErrorPixels pixels = ErrorPixels::SCENE,
                                    ErrorMeasure measure = ErrorMeasure::MSE);

/// Squared relative error of one sample a pixel, as if noise fell by their number; 0 where none can be told.
double sample_error(const Film& film, ErrorMeasure measure);

/// The same by the relative measure without the noisiest hundredth of the pixels that show the scene: of what
/// most of the picture is like, where a few bright samples decide the mean. Nothing is left out where most
/// pixels have no noise: they may not have seen the light yet.
double trimmed_sample_error(const Film& film);

} // namespace clrt
