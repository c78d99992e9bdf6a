// SPDX-License-Identifier: Apache-2.0
// Films as a renderer would fill them whose samples are independent and normal.
#pragma once

#include "film/film.h"

#include <cmath>
#include <random>

namespace clrt {

/// A film of empty sums with room for `samples` samples from `first`.
inline Film empty_film(int width, int height, int replicates, std::uint32_t first, std::uint64_t samples) {
    Film film;
    film.width = width;
    film.height = height;
    film.replicates = replicates;
    film.scale = {std::ldexp(1.0, -12), std::ldexp(1.0, 20)};
    if (samples > 0)
        film.ranges = {{first, first + samples}};
    film.sums.assign(size_t(replicates) * size_t(width) * size_t(height) * 3, 0);
    return film;
}

/// Continues a film that starts at sample 0 up to `samples` samples of these moments.
inline void add_noise(Film& film, std::uint64_t samples, double mean, double deviation,
                      std::mt19937& random) {
    Film before = film;
    film.ranges = {{0, samples}};
    for (int r = 0; r < film.replicates; ++r) {
        const double n = double(film_replicate_samples(film, r) - film_replicate_samples(before, r));
        std::normal_distribution<double> sum(n * mean, std::sqrt(n) * deviation);
        for (size_t i = 0; i < film_plane(film); ++i)
            film.sums[size_t(r) * film_plane(film) + i] += std::llround(sum(random) / film.scale.quantum);
    }
}

/// Fills a film with samples of these moments.
inline void fill_with_noise(Film& film, double mean, double deviation, std::mt19937& random) {
    for (int r = 0; r < film.replicates; ++r) {
        const double n = double(film_replicate_samples(film, r));
        std::normal_distribution<double> sum(n * mean, std::sqrt(n) * deviation);
        for (size_t i = 0; i < film_plane(film); ++i)
            film.sums[size_t(r) * film_plane(film) + i] = std::llround(sum(random) / film.scale.quantum);
    }
}

} // namespace clrt
