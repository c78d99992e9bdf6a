// SPDX-License-Identifier: Apache-2.0
// What the primary hits of the film's samples are, summed up pixel by pixel: the source of the layers alpha,
// albedo, N, Z, P, objectId and materialId. No OpenCL here.
#pragma once

#include "film/film.h"
#include "film/matte_sums.h"
#include "kernels/shared/aov_types.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

namespace clrt {

/// Sums over the primary hits of a window: of each half of the replicates, the first of which are one half,
/// where tiles have samples of their own or the picture is denoised, else in the first place only. Fixed
/// point (kernels/shared/aov_types.h): launches of any size give the
/// same bits.
struct HitSums {
    std::array<std::vector<std::int64_t>, 2> values; ///< AOV_SUMS a pixel
    std::array<std::vector<u32>, 2> words;           ///< AOV_WORDS a pixel
    MatteSlots mattes;
    /// Samples of a pixel that are enough; of an adaptive film half of them in each half.
    std::uint64_t most_samples = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t samples = 0;                         ///< a pixel, of a film that is not adaptive,
    std::array<std::uint64_t, 2> samples_of_half = {}; ///< and of each half where there are two
    TileSamples tile_samples;                          ///< of an adaptive film
    bool empty() const { return values[0].empty(); }
    /// How many halves there are sums of.
    size_t halves() const { return values[1].empty() ? 1 : 2; }
    /// How many samples of a pixel those of a half are.
    double half_samples(const Film& film, size_t half, size_t pixel) const {
        if (!tile_samples[0].empty())
            return tile_samples[half][film_tile(film, pixel)];
        return double(halves() == 2 ? samples_of_half[half] : samples);
    }
    /// What the mean of a half weighs in that of both: as much as in the film's picture.
    double half_weight(size_t half) const {
        if (!tile_samples[0].empty())
            return 0.5;
        return halves() == 2 ? double(samples_of_half[half]) / double(samples) : 1;
    }
};

/// How many samples of an equally sampled film they are to have.
std::uint64_t wanted_hit_samples(const HitSums& hits, const Film& film);

/// How many samples of each tile of an adaptive film they are to have.
TileSamples wanted_hit_tiles(const HitSums& hits, const Film& film);

/// Whether they have all samples of the film that they are to have.
bool has_all_samples(const HitSums& hits, const Film& film);

/// What the samples of a pixel see first, on average over those that hit something.
struct PixelHits {
    double share = 0;                        ///< of the samples that hit something
    std::array<double, AOV_SUMS> means = {}; ///< in the order of the sums
    std::array<u32, AOV_WORDS> first = {};   ///< words of the first hit
    /// The mean of a vector such as AOV_NORMAL.
    glm::dvec3 mean(size_t vector) const { return {means[vector], means[vector + 1], means[vector + 2]}; }
};

/// The averages of a pixel; each half weighs as much as it does in the film's picture.
PixelHits pixel_hits(const HitSums& hits, const Film& film, size_t pixel);

/// Those over the samples of one of two halves.
PixelHits pixel_hits_of_half(const HitSums& hits, const Film& film, size_t half, size_t pixel);

} // namespace clrt
