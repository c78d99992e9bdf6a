// SPDX-License-Identifier: Apache-2.0
// The film on the host: fixed-point sums of every replicate, and the pictures and statistics made from them.
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace clrt {

/// Sums are multiples of `quantum`; a single contribution may reach `largest`.
struct FilmScale {
    double quantum = 1;  ///< radiance; a power of two
    double largest = 1;  ///< radiance
};

/// Chooses the scale from the scene alone (same for crop, effects, precision and device): 2^-20 of the power of two
/// nearest the mean radiance level, which is the emitted power over the bounding sphere's area and pi plus the sky's
/// mean, raised to 2^-20 of the brightest light so that a light in view stays below `largest` = 2^24 levels.
FilmScale film_scale(const Scene& scene);

/// Most samples that a pixel of one replicate can hold: 2^63 / 2^44 contributions.
constexpr std::uint64_t FILM_SAMPLES_PER_REPLICATE = std::uint64_t(1) << 19;

/// Sums of a window of pixels: [replicate][pixel][rgb].
struct Film {
    int width = 0, height = 0;
    int replicates = 1;              ///< kept apart
    FilmScale scale;
    std::uint32_t first_sample = 0;
    std::uint64_t samples = 0;       ///< a pixel, over all replicates
    std::vector<std::int64_t> sums;
};

/// Samples of a pixel that fell into replicate `replicate`: sample s belongs to replicate s mod replicates.
std::uint64_t film_replicate_samples(const Film& film, int replicate);

/// Mean radiance, rgb a pixel. Zero samples give black.
std::vector<float> film_mean(const Film& film);

/// Variance of the mean of each pixel and channel, from the spread of the replicates' means; empty when fewer than two
/// replicates have samples.
std::vector<float> film_variance(const Film& film);

/// Relative error of the picture: sqrt(mean over pixels and channels of the variance of the mean) / mean radiance, with a
/// 95 % interval by the jackknife over replicates (on the logarithm, Student's t).
struct FilmError {
    double relative_rmse = 0;
    std::optional<double> low, high; ///< none under four replicates
};

/// None when fewer than two replicates have samples, or the picture is black.
std::optional<FilmError> film_error(const Film& film);

} // namespace clrt
