// SPDX-License-Identifier: Apache-2.0
// The film on the host: fixed-point sums of every replicate, and the pictures and statistics made from them.
#pragma once

#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace clrt {

/// Sums are multiples of `quantum`; a single contribution may reach `largest`.
struct FilmScale {
    double quantum = 1;   ///< radiance; a power of two
    double largest = 1;   ///< radiance
    double sustained = 1; ///< radiance that every sample of a full film may have
};

/// Chooses the scale from the scene alone (same for crop, effects, precision and device). A quantum is 2^-20
/// of the level, the power of two nearest the mean radiance: the emitted power over the bounding sphere's
/// area and pi plus the sky's mean. A contribution may reach `largest` = 2^40 levels; all samples of a full
/// film may reach `sustained` = 2^24 levels, and a sum that grows beyond 2^63 quanta all the same stays there
/// and is reported. The level rises above the mean
/// - where a surface or the sky shines brighter than 2^24 levels, so that pictures of it never fill a sum;
/// - where the disc of a sun shines brighter than 2^36 levels: only pictures that magnify it fill pixels with
///   it, and they hold 2^7 samples a replicate at least.
FilmScale film_scale(const Scene& scene);

/// Samples that a pixel of one replicate can hold at 2^24 levels each: 2^63 / 2^44.
constexpr std::uint64_t FILM_SAMPLES_PER_REPLICATE = std::uint64_t(1) << 19;

/// Sample numbers first .. end - 1 of every pixel.
struct SampleRange {
    std::uint64_t first = 0, end = 0;
    bool operator==(const SampleRange& other) const { return first == other.first && end == other.end; }
};

/// Side of the tiles that an adaptive render gives samples to, pixels.
constexpr int ADAPTIVE_TILE_SIZE = 8;

/// Samples a pixel of each half of the replicates in each tile, row by row.
using TileSamples = std::array<std::vector<std::uint32_t>, 2>;

/// Sums of a window of pixels: [replicate][pixel][rgb].
struct Film {
    int width = 0, height = 0;
    int replicates = 1; ///< kept apart
    int block = 1;      ///< side of the squares of pixels whose errors may go together (film_error.h)
    FilmScale scale;
    std::vector<SampleRange>
        ranges; ///< the samples inside: in order, disjoint, not empty; merged films can have gaps
    TileSamples tile_samples; ///< of an adaptive film, whose range is their mean; empty: all tiles are equal
    std::vector<std::int64_t> sums;
    /// 1 in the pixels that show the scene, where a camera ray of some sample has hit it; 0 in those that
    /// show nothing but what is behind it. Empty: not known, or no sample.
    std::vector<std::uint8_t> shown;
};

/// Sums of one replicate.
inline size_t film_plane(const Film& film) {
    return size_t(film.width) * size_t(film.height) * 3;
}

/// A film of the same samples without their sums, in one replicate.
Film film_layer(const Film& film);

/// Whether tiles have samples of their own.
inline bool is_adaptive(const Film& film) {
    return !film.tile_samples[0].empty();
}

/// Adaptive tiles in a row, and in all.
size_t film_tiles_across(const Film& film);
size_t film_tiles(const Film& film);
/// The adaptive tile of a pixel.
size_t film_tile(const Film& film, size_t pixel);
/// Pixels of each tile: fewer at the right and at the bottom.
std::vector<std::uint32_t> tile_pixel_counts(const Film& film);

/// Samples of a pixel, over all replicates; of an adaptive film the mean that it has come to.
std::uint64_t film_samples(const Film& film);

/// Samples of each pixel.
std::vector<float> film_pixel_samples(const Film& film);

/// Samples of all pixels together.
std::uint64_t film_all_samples(const Film& film);

/// Samples of a pixel that fell into replicate `replicate`: sample s belongs to replicate s mod replicates.
/// For films that are not adaptive.
std::uint64_t film_replicate_samples(const Film& film, int replicate);

/// Samples of a pixel below number `end` that fall into a half of `replicates`: the first or the last of
/// them.
std::uint64_t samples_of_half_below(std::uint64_t end, int replicates, size_t half);

/// Whether any sample fell into the replicate; the sums of one without are all 0.
bool film_has_replicate(const Film& film, int replicate);

/// Means of the replicates that have samples, one value (pixel and channel) after the other.
class ReplicateMeans {
public:
    explicit ReplicateMeans(const Film& film);
    /// Replicates that have samples.
    size_t count() const { return first_.size(); }
    /// Their means of value `i` of a replicate's plane.
    void read(size_t i, double* means) const;
    /// Returns the mean of their means, and how each differs from it, with the sum of the squared
    /// differences.
    double read_deviations(size_t i, double* deviations, double& squares) const;

private:
    const Film& film_;
    std::vector<size_t> first_; ///< where each replicate's plane starts
    std::vector<double>
        factor_; ///< quantum / samples of each; of an adaptive film, for one tile after the other
};

/// Adds the sums of replicates together until `replicates`, a divisor of their number, are kept apart: the
/// picture keeps its bits, the error becomes coarser. Not for adaptive films.
void fold_replicates(Film& film, int replicates);

/// Adds `others` to `sums` one by one. False where one does not fit 64 bits, which takes more samples than
/// FILM_SAMPLES_PER_REPLICATE and contributions near the largest.
bool add_sums(std::vector<std::int64_t>& sums, const std::vector<std::int64_t>& others);

/// Mean radiance, rgb a pixel. Zero samples give black.
std::vector<float> film_mean(const Film& film);

/// Pixels that show the scene; none where that is not known.
std::optional<size_t> film_shown_pixels(const Film& film);

/// Variance of the mean of each pixel and channel, from the spread of the replicates' means; empty when fewer
/// than two replicates have samples.
std::vector<float> film_variance(const Film& film);

} // namespace clrt
