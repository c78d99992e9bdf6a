// SPDX-License-Identifier: Apache-2.0
#include "film/hit_sums.h"

#include <algorithm>
#include <cmath>

namespace clrt {

std::uint64_t wanted_hit_samples(const HitSums& hits, const Film& film) {
    return std::min(film_samples(film), hits.most_samples);
}

TileSamples wanted_hit_tiles(const HitSums& hits, const Film& film) {
    TileSamples wanted = film.tile_samples;
    for (std::vector<u32>& half : wanted)
        for (u32& samples : half)
            samples = u32(std::min<std::uint64_t>(samples, hits.most_samples / 2));
    return wanted;
}

bool has_all_samples(const HitSums& hits, const Film& film) {
    return is_adaptive(film) ? hits.tile_samples == wanted_hit_tiles(hits, film)
                             : hits.samples == wanted_hit_samples(hits, film);
}

namespace {

/// Adds the means over all samples of a half, hits or not.
void add_half(const HitSums& hits, const Film& film, size_t half, size_t pixel, double weight,
              PixelHits& result) {
    const double samples = hits.half_samples(film, half, pixel);
    const u32* words = &hits.words[half][AOV_WORDS * pixel];
    if (words[AOV_HITS] == 0)
        return;
    if (result.share == 0)
        std::copy_n(words, AOV_WORDS, result.first.begin());
    result.share += weight * (words[AOV_HITS] / samples);
    for (size_t i = 0; i < AOV_SUMS; ++i)
        result.means[i] += weight * (double(hits.values[half][AOV_SUMS * pixel + i]) / samples);
}

/// From means over all samples to those over hits.
PixelHits over_hits(PixelHits result) {
    if (result.share != 0)
        for (double& mean : result.means)
            mean = std::ldexp(mean / result.share, -AOV_BITS);
    return result;
}

} // namespace

PixelHits pixel_hits(const HitSums& hits, const Film& film, size_t pixel) {
    PixelHits result;
    for (size_t half = 0; half < hits.halves(); ++half)
        add_half(hits, film, half, pixel, hits.half_weight(half), result);
    return over_hits(result);
}

PixelHits pixel_hits_of_half(const HitSums& hits, const Film& film, size_t half, size_t pixel) {
    PixelHits result;
    add_half(hits, film, half, pixel, 1, result);
    return over_hits(result);
}

} // namespace clrt
