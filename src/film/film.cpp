// SPDX-License-Identifier: Apache-2.0
#include "film/film.h"

#include "colour.h"
#include "kernels/shared/path_types.h"
#include "scene/brightness.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

constexpr int QUANTUM_BITS = 20;   ///< the quantum is 2^-20 levels
constexpr int SUSTAINED_BITS = 24; ///< every sample of a full film may have 2^24 levels
/// A contribution is at most 2^40 levels: a point light lights matte surfaces by that at 1e-6 of the scene's
/// size, and the weights of paths have room above the brightest light.
constexpr int LARGEST_BITS = 40;
constexpr int DISC_BITS = 36;         ///< the disc of a sun has at most 2^36 levels
constexpr int SMALLEST_LEVEL = -100;  ///< 1 / quantum stays finite in a float
constexpr double NOTHING = 0x1p-1000; ///< no light; has a logarithm

/// Largest radiance component of the discs of suns.
double brightest_disc(const Scene& scene) {
    double brightest = 0;
    for (const Light& light : scene.lights)
        if (light.kind == LIGHT_SUN)
            brightest = std::max(brightest,
                                 largest_component({light.emission.x, light.emission.y, light.emission.z}));
    return brightest;
}

/// The smallest exponent of a level of which a radiance is less than 2^bits.
int level_below(double radiance, int bits) {
    return std::ilogb(std::max(radiance, NOTHING)) + 1 - bits;
}

FilmScale scale_of_level(int exponent) {
    return {std::ldexp(1.0, exponent - QUANTUM_BITS), std::ldexp(1.0, exponent + LARGEST_BITS),
            std::ldexp(1.0, exponent + SUSTAINED_BITS)};
}

/// Where the sums of the replicates [begin, end) start, of those that have samples.
std::vector<const std::int64_t*> planes_of(const Film& film, int begin, int end) {
    std::vector<const std::int64_t*> planes;
    for (int r = begin; r < end; ++r)
        if (film_has_replicate(film, r))
            planes.push_back(film.sums.data() + size_t(r) * film_plane(film));
    return planes;
}

/// The sum of value `i` over planes, rounded once. Full replicates take 64 bits each, so the halves of the
/// words are added apart.
double sum_over_planes(const std::vector<const std::int64_t*>& planes, size_t i) {
    std::int64_t high = 0, low = 0;
    for (const std::int64_t* const plane : planes) {
        const std::int64_t sum = plane[i];
        high += sum >> 32;
        low += sum & 0xffffffff;
    }
    return std::ldexp(double(high), 32) + double(low);
}

/// Mean radiance of an adaptive film: the halves' means, each by weight 1/2.
std::vector<float> mean_of_halves(const Film& film) {
    const int of_half = film.replicates / 2;
    const std::array planes = {planes_of(film, 0, of_half), planes_of(film, of_half, 2 * of_half)};
    std::vector<float> mean(film_plane(film));
    tbb::parallel_for(size_t(0), mean.size(), [&](size_t i) {
        double value = 0;
        for (size_t half = 0; half < 2; ++half)
            value += 0.5 * sum_over_planes(planes[half], i) * film.scale.quantum /
                     double(film.tile_samples[half][film_tile(film, i / 3)]);
        mean[i] = float(value);
    });
    return mean;
}

} // namespace

FilmScale film_scale(const Scene& scene) {
    const double radius = std::sqrt(3.0) * std::max(double(scene.extent), 1e-30);
    const glm::dvec3& sky = scene.environment.radiance;
    const double sky_mean =
        scene.environment.texels.empty() ? luminance(sky) : scene.environment.mean_radiance;
    const double mean = scene.emitted_power / (4 * PI * radius * radius * PI) + sky_mean;
    const double disc = brightest_disc(scene);
    const double surface = std::max(largest_radiance(scene, KIND_AREA | KIND_SKY), // what can fill pictures
                                    scene.background ? largest_component(*scene.background) : 0.0);
    if (!(std::max({mean, disc, surface}) > 0))
        return scale_of_level(0);
    return scale_of_level(
        std::max({int(std::lround(std::log2(std::max(mean, NOTHING)))), level_below(surface, SUSTAINED_BITS),
                  level_below(disc, DISC_BITS), SMALLEST_LEVEL}));
}

Film film_layer(const Film& film) {
    Film layer;
    layer.width = film.width;
    layer.height = film.height;
    layer.scale = film.scale;
    layer.ranges = film.ranges;
    return layer;
}

size_t film_tiles_across(const Film& film) {
    return (size_t(film.width) + ADAPTIVE_TILE_SIZE - 1) / ADAPTIVE_TILE_SIZE;
}

size_t film_tiles(const Film& film) {
    return film_tiles_across(film) * ((size_t(film.height) + ADAPTIVE_TILE_SIZE - 1) / ADAPTIVE_TILE_SIZE);
}

size_t film_tile(const Film& film, size_t pixel) {
    const size_t x = pixel % size_t(film.width), y = pixel / size_t(film.width);
    return y / ADAPTIVE_TILE_SIZE * film_tiles_across(film) + x / ADAPTIVE_TILE_SIZE;
}

std::vector<std::uint32_t> tile_pixel_counts(const Film& film) {
    std::vector<std::uint32_t> counts(film_tiles(film), 0);
    for (size_t pixel = 0; pixel < size_t(film.width) * size_t(film.height); ++pixel)
        ++counts[film_tile(film, pixel)];
    return counts;
}

std::vector<float> film_pixel_samples(const Film& film) {
    std::vector<float> samples(size_t(film.width) * size_t(film.height), float(film_samples(film)));
    if (is_adaptive(film))
        for (size_t pixel = 0; pixel < samples.size(); ++pixel) {
            const size_t tile = film_tile(film, pixel);
            samples[pixel] = float(film.tile_samples[0][tile] + film.tile_samples[1][tile]);
        }
    return samples;
}

std::uint64_t film_all_samples(const Film& film) {
    if (!is_adaptive(film))
        return film_samples(film) * std::uint64_t(film.width) * std::uint64_t(film.height);
    const std::vector<std::uint32_t> pixels = tile_pixel_counts(film);
    std::uint64_t samples = 0;
    for (const std::vector<std::uint32_t>& half : film.tile_samples)
        for (size_t tile = 0; tile < pixels.size(); ++tile)
            samples += std::uint64_t(half[tile]) * pixels[tile];
    return samples;
}

std::uint64_t film_samples(const Film& film) {
    std::uint64_t samples = 0;
    for (const SampleRange& range : film.ranges)
        samples += range.end - range.first;
    return samples;
}

std::uint64_t film_replicate_samples(const Film& film, int replicate) {
    const std::uint64_t count = std::uint64_t(film.replicates);
    const auto below = [&](std::uint64_t end) {
        return (end + count - 1 - std::uint64_t(replicate)) / count;
    };
    std::uint64_t samples = 0;
    for (const SampleRange& range : film.ranges)
        samples += below(range.end) - below(range.first);
    return samples;
}

std::uint64_t samples_of_half_below(std::uint64_t end, int replicates, size_t half) {
    const std::uint64_t count = std::uint64_t(replicates), of_half = count / 2, rest = end % count;
    const std::uint64_t begin = half * of_half;
    return end / count * of_half + (rest > begin ? std::min(rest - begin, of_half) : 0);
}

bool film_has_replicate(const Film& film, int replicate) {
    return is_adaptive(film) || film_replicate_samples(film, replicate) > 0;
}

ReplicateMeans::ReplicateMeans(const Film& film) : film_(film) {
    if (is_adaptive(film)) {
        const int of_half = film.replicates / 2;
        for (int r = 0; r < film.replicates; ++r)
            first_.push_back(size_t(r) * film_plane(film));
        for (size_t tile = 0; tile < film_tiles(film); ++tile)
            for (int r = 0; r < film.replicates; ++r)
                factor_.push_back(film.scale.quantum * double(of_half) /
                                  double(film.tile_samples[size_t(r / of_half)][tile]));
        return;
    }
    for (int r = 0; r < film.replicates; ++r) {
        const std::uint64_t n = film_replicate_samples(film, r);
        if (n == 0)
            continue;
        first_.push_back(size_t(r) * film_plane(film));
        factor_.push_back(film.scale.quantum / double(n));
    }
}

void ReplicateMeans::read(size_t i, double* means) const {
    const double* factor = &factor_[is_adaptive(film_) ? film_tile(film_, i / 3) * count() : 0];
    for (size_t k = 0; k < count(); ++k)
        means[k] = double(film_.sums[first_[k] + i]) * factor[k];
}

double ReplicateMeans::read_deviations(size_t i, double* deviations, double& squares) const {
    read(i, deviations);
    double mean = 0;
    for (size_t k = 0; k < count(); ++k)
        mean += deviations[k] / double(count());
    squares = 0;
    for (size_t k = 0; k < count(); ++k) {
        deviations[k] -= mean;
        squares += deviations[k] * deviations[k];
    }
    return mean;
}

void fold_replicates(Film& film, int replicates) {
    const size_t plane = film_plane(film), kept = size_t(replicates) * plane;
    for (size_t i = kept; i < film.sums.size(); ++i)
        if (__builtin_add_overflow(film.sums[i % kept], film.sums[i], &film.sums[i % kept]))
            film.sums[i % kept] = INT64_MAX; // as on the device
    film.sums.resize(kept);
    film.replicates = replicates;
}

bool add_sums(std::vector<std::int64_t>& sums, const std::vector<std::int64_t>& others) {
    bool fits = true;
    for (size_t i = 0; i < sums.size(); ++i)
        fits &= !__builtin_add_overflow(sums[i], others[i], &sums[i]);
    return fits;
}

std::vector<float> film_mean(const Film& film) {
    const std::uint64_t samples = film_samples(film);
    std::vector<float> mean(film_plane(film), 0.0f);
    if (samples == 0)
        return mean;
    if (is_adaptive(film))
        return mean_of_halves(film);
    const std::vector<const std::int64_t*> planes = planes_of(film, 0, film.replicates);
    tbb::parallel_for(size_t(0), mean.size(), [&](size_t i) {
        mean[i] = float(sum_over_planes(planes, i) * film.scale.quantum / double(samples));
    });
    return mean;
}

std::optional<size_t> film_shown_pixels(const Film& film) {
    if (film.shown.empty())
        return std::nullopt;
    return size_t(std::count(film.shown.begin(), film.shown.end(), 1));
}

std::vector<float> film_variance(const Film& film) {
    const ReplicateMeans replicates(film);
    const double n = double(replicates.count());
    if (replicates.count() < 2)
        return {};
    std::vector<float> variance(film_plane(film));
    std::vector<double> deviations(replicates.count());
    double squares = 0;
    for (size_t i = 0; i < variance.size(); ++i) {
        replicates.read_deviations(i, deviations.data(), squares);
        variance[i] = float(squares / (n * (n - 1)));
    }
    return variance;
}

} // namespace clrt
