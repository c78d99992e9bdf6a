// SPDX-License-Identifier: Apache-2.0
#include "denoise/half_picture.h"

#include "colour.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// Part of a pixel's luminance from which on what its primary hits emit is most of it.
constexpr double LIT_SHARE = 0.5;

/// The mean of replicates [begin, end).
float mean_of(const std::vector<double>& replicates, size_t begin, size_t end) {
    double sum = 0;
    for (size_t k = begin; k < end; ++k)
        sum += replicates[k];
    return float(sum / double(end - begin));
}

void read_radiance(const Film& film, size_t half, HalfPicture& picture) {
    const ReplicateMeans replicates(film);
    const size_t of_half = replicates.count() / 2, begin = half * of_half, end = begin + of_half;
    const size_t middle = begin + of_half / 2, plane = film_plane(film);
    for (Pixels* pixels : {&picture.mean, &picture.quarter[0], &picture.quarter[1]})
        pixels->resize(plane);
    tbb::parallel_for(size_t(0), size_t(film.height), [&](size_t row) {
        std::vector<double> means(replicates.count());
        for (size_t i = row * plane / size_t(film.height); i < (row + 1) * plane / size_t(film.height); ++i) {
            replicates.read(i, means.data());
            picture.mean[i] = mean_of(means, begin, end);
            picture.quarter[0][i] = mean_of(means, begin, middle);
            picture.quarter[1][i] = mean_of(means, middle, end);
        }
    });
}

void read_features(const Film& film, const HitSums& hits, size_t half, HalfPicture& picture) {
    const size_t pixels = film_plane(film) / 3;
    for (Pixels* of_three : {&picture.albedo, &picture.normal, &picture.position})
        of_three->resize(3 * pixels);
    picture.share.resize(pixels);
    picture.lit.resize(pixels);
    tbb::parallel_for(size_t(0), pixels, [&](size_t pixel) {
        const PixelHits seen = pixel_hits_of_half(hits, film, half, pixel);
        const glm::dvec3 albedo = seen.share * seen.mean(AOV_ALBEDO);
        const glm::dvec3 normal = seen.share * seen.mean(AOV_NORMAL);
        const glm::dvec3 position = seen.mean(AOV_POSITION);
        for (int c = 0; c < 3; ++c) {
            picture.albedo[3 * pixel + size_t(c)] = float(albedo[c]);
            picture.normal[3 * pixel + size_t(c)] = float(normal[c]);
            picture.position[3 * pixel + size_t(c)] = float(position[c]);
        }
        picture.share[pixel] = float(seen.share);
        const double emitted = seen.share * seen.means[AOV_EMISSION] * AOV_EMISSION_UNIT;
        const float* mean = &picture.mean[3 * pixel];
        picture.lit[pixel] = emitted > 0 && emitted >= LIT_SHARE * luminance({mean[0], mean[1], mean[2]});
    });
}

} // namespace

std::optional<std::string> denoise_obstacle(const Film& film, const HitSums& hits) {
    const size_t with_samples = ReplicateMeans(film).count();
    if (film.replicates < FEWEST_DENOISED_REPLICATES || film.replicates % 2 != 0)
        return fmt::format("its film keeps {} replicates apart, and it takes an even number from {}",
                           film.replicates, FEWEST_DENOISED_REPLICATES);
    if (with_samples != size_t(film.replicates))
        return fmt::format("only {} of its {} replicates have samples; it takes {} samples a pixel or more",
                           with_samples, film.replicates, film.replicates);
    if (hits.halves() != 2 || !has_all_samples(hits, film))
        return "what its samples see first is not known of all of them";
    return std::nullopt;
}

HalfPicture half_picture(const Film& film, const HitSums& hits, size_t half) {
    HalfPicture picture;
    picture.width = film.width;
    picture.height = film.height;
    read_radiance(film, half, picture);
    read_features(film, hits, half, picture);
    return picture;
}

} // namespace clrt
