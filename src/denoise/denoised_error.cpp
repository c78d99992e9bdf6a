// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoised_error.h"

#include "denoise/smooth.h"
#include "film/error_spread.h"
#include "film/f_distribution.h"
#include "film/film_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// More effective pixels change the interval no more.
constexpr double MOST_DEGREES = 1e5;
/// Pixels around each one by which it is told whether it is among the worst.
constexpr int RANKING_RADIUS = 3;

/// Squared errors of the pixels over which the error is stated, summed over channels, weighted.
struct SquaredErrors {
    std::vector<size_t> pixels; ///< in order
    std::vector<double> raw, denoised;
    std::vector<double> expected; ///< by which the worst are told: larger is worse
    std::vector<size_t> blocks;   ///< of the film's squares of pixels, that which each one is in
    size_t block_count = 0;
};

/// The mean of (f - x_k)(f - x_l) over pairs k != l of `count` values.
double mean_of_pairs(double f, const double* x, size_t count) {
    double sum = 0, squares = 0;
    for (size_t k = 0; k < count; ++k) {
        sum += f - x[k];
        squares += (f - x[k]) * (f - x[k]);
    }
    return (sum * sum - squares) / double(count * (count - 1));
}

/// Of value `i` of a film: the raw picture's, and that of the mean of the denoised halves.
std::array<double, 2> squared_errors(const ReplicateMeans& replicates, size_t i, float f_a, float f_b,
                                     std::vector<double>& means) {
    const size_t count = replicates.count(), of_half = count / 2;
    const double difference = double(f_a) - double(f_b);
    replicates.read(i, means.data());
    const double of_a = mean_of_pairs(f_a, &means[of_half], of_half),
                 of_b = mean_of_pairs(f_b, means.data(), of_half);
    double squares = 0;
    replicates.read_deviations(i, means.data(), squares);
    return {squares / double(count * (count - 1)), 0.5 * (of_a + of_b) - 0.25 * difference * difference};
}

/// What the halves expect of their errors, and how far they differ, smoothed over a few pixels: where
/// features are as noisy as colours, as at the rim of a lamp, a half by itself does not see the noise.
Pixels expected_errors(const Film& film, const std::array<DenoisedHalf, 2>& halves) {
    Pixels differences(film_plane(film) / 3, 0.0f);
    for (size_t i = 0; i < film_plane(film); ++i) {
        const float difference = halves[0].radiance[i] - halves[1].radiance[i];
        differences[i / 3] += 0.25f * difference * difference;
    }
    Pixels expected = smooth_binomial(differences, film.width, film.height, 1, RANKING_RADIUS);
    for (const DenoisedHalf& half : halves)
        for (size_t pixel = 0; pixel < expected.size(); ++pixel)
            expected[pixel] += 0.5f * half.expected[pixel];
    return expected;
}

/// Finds which of the film's blocks each pixel is in.
void find_blocks(const Film& film, SquaredErrors& errors) {
    const size_t side = size_t(std::max(film.block, 1)), width = size_t(film.width);
    const size_t across = (width + side - 1) / side;
    errors.block_count = across * ((size_t(film.height) + side - 1) / side);
    for (const size_t pixel : errors.pixels)
        errors.blocks.push_back(pixel / width / side * across + pixel % width / side);
}

SquaredErrors measure_pixels(const Film& film, const std::array<DenoisedHalf, 2>& halves,
                             const PixelChoice& choice, const ErrorWeights& weights) {
    const ReplicateMeans replicates(film);
    const Pixels expected = expected_errors(film, halves);
    SquaredErrors errors;
    for (size_t pixel = 0; pixel < film_plane(film) / 3; ++pixel)
        if (choice.has(pixel))
            errors.pixels.push_back(pixel);
    find_blocks(film, errors);
    for (std::vector<double>* values : {&errors.raw, &errors.denoised, &errors.expected})
        values->resize(errors.pixels.size());
    tbb::parallel_for(size_t(0), errors.pixels.size(), [&](size_t n) {
        thread_local std::vector<double> means;
        means.resize(replicates.count());
        double raw = 0, denoised = 0, weight = 0;
        for (size_t i = 3 * errors.pixels[n]; i < 3 * errors.pixels[n] + 3; ++i) {
            const auto [of_raw, of_denoised] =
                squared_errors(replicates, i, halves[0].radiance[i], halves[1].radiance[i], means);
            raw += weights.of(i) * of_raw;
            denoised += weights.of(i) * of_denoised;
            weight += weights.of(i) / 3;
        }
        errors.raw[n] = raw;
        errors.denoised[n] = denoised;
        errors.expected[n] = weight * double(expected[errors.pixels[n]]);
    });
    return errors;
}

/// sqrt(sum / values) / mean, where the sum of squares is positive.
double relative_root(double sum, double values, double mean) {
    return std::sqrt(std::max(sum / values, 0.0)) / mean;
}

/// How far a sum reaches to either side with 95 %, given how far its terms are off their mean: Student's
/// quantile of as many degrees of freedom as terms decide (Satterthwaite 1946).
double reach_of(const std::vector<double>& deviations) {
    double squares = 0, fourths = 0;
    for (const double deviation : deviations) {
        const double square = deviation * deviation;
        squares += square;
        fourths += square * square;
    }
    const double free = double(deviations.size()) - 1; // one is lost to the mean
    if (!(squares > 0) || free < 1)
        return 0;
    const double degrees = std::clamp(squares * squares / fourths, 1.0, std::min(free, MOST_DEGREES));
    return std::sqrt(f_quantile(0.95, 1, degrees) * squares * (free + 1) / free);
}

/// How far the sums over blocks are off what the mean over all pixels makes them. Where all pixels are in one
/// block they are taken one by one: nothing tells what they have in common.
std::vector<double> deviations_of(const SquaredErrors& errors, const std::vector<size_t>& chosen,
                                  double mean) {
    std::vector<double> sums(errors.block_count, 0.0), pixels;
    std::vector<char> has_any(errors.block_count, 0);
    for (const size_t n : chosen) {
        pixels.push_back(errors.denoised[n] - mean);
        sums[errors.blocks[n]] += pixels.back();
        has_any[errors.blocks[n]] = 1;
    }
    std::vector<double> blocks;
    for (size_t block = 0; block < sums.size(); ++block)
        if (has_any[block])
            blocks.push_back(sums[block]);
    return blocks.size() > 1 ? blocks : pixels;
}

/// The errors over the pixels of `chosen`, places in the lists of `errors`.
DenoisedError errors_over(const SquaredErrors& errors, const std::vector<size_t>& chosen, double mean) {
    double raw = 0, sum = 0;
    for (const size_t n : chosen) {
        raw += errors.raw[n];
        sum += errors.denoised[n];
    }
    const double count = double(chosen.size()), values = 3 * count;
    // Noise may make the sum negative; the errors of which it is the sum are not.
    const double reach = reach_of(deviations_of(errors, chosen, sum / count));
    const double high = std::max(sum, 0.0) + reach;
    return {relative_root(raw, values, mean), relative_root(sum, values, mean),
            relative_root(sum - reach, values, mean), relative_root(high, values, mean)};
}

/// The places of the worst pixels and of all others, each in order. Which these are is told by their
/// surroundings, so that the noise that judges a pixel hardly decides whether it is left out.
struct Parted {
    std::vector<size_t> worst, others;
};

Parted part_worst(const SquaredErrors& errors) {
    const size_t count = errors.pixels.size(), worst = size_t(std::ceil(WORST_SHARE * double(count)));
    std::vector<size_t> places(count);
    std::iota(places.begin(), places.end(), size_t(0));
    const auto middle = places.begin() + std::ptrdiff_t(worst);
    std::nth_element(places.begin(), middle, places.end(), [&](size_t a, size_t b) {
        return errors.expected[a] > errors.expected[b] || (errors.expected[a] == errors.expected[b] && a < b);
    });
    std::sort(places.begin(), middle); // a fixed order of summation
    std::sort(middle, places.end());
    return {{places.begin(), middle}, {middle, places.end()}};
}

Pixels tile_errors(const Film& film, const SquaredErrors& errors, double mean) {
    const size_t width = size_t(film.width), across = (width + ERROR_TILE_SIZE - 1) / ERROR_TILE_SIZE;
    const auto tile_of = [&](size_t pixel) {
        return pixel / width / ERROR_TILE_SIZE * across + pixel % width / ERROR_TILE_SIZE;
    };
    const size_t pixels = film_plane(film) / 3;
    std::vector<double> sums(tile_of(pixels - 1) + across, 0.0), values(sums.size(), 0.0);
    for (size_t n = 0; n < errors.pixels.size(); ++n) {
        sums[tile_of(errors.pixels[n])] += errors.denoised[n];
        values[tile_of(errors.pixels[n])] += 3;
    }
    Pixels result(pixels);
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        const size_t tile = tile_of(pixel);
        result[pixel] = values[tile] > 0 ? float(relative_root(sums[tile], values[tile], mean)) : 0.0f;
    }
    return result;
}

} // namespace

std::optional<DenoisedErrors> denoised_errors(const Film& film, const std::array<DenoisedHalf, 2>& halves,
                                              ErrorMeasure measure) {
    const std::optional<SquaredError> squared = film_squared_error(film, ErrorPixels::SCENE, 1, measure);
    if (!squared || !(squared->mean_radiance > 0))
        return std::nullopt;
    const PixelChoice choice(film, ErrorPixels::SCENE);
    const SquaredErrors errors = measure_pixels(film, halves, choice, ErrorWeights(film, choice, measure));
    const double mean = squared->mean_radiance;
    std::vector<size_t> all(errors.pixels.size());
    std::iota(all.begin(), all.end(), size_t(0));
    const Parted parted = part_worst(errors);
    DenoisedErrors result{errors_over(errors, all, mean),
                          errors_over(errors, parted.others, mean),
                          {},
                          tile_errors(film, errors, mean)};
    for (const size_t place : parted.worst)
        result.worst.push_back(errors.pixels[place]);
    return result;
}

} // namespace clrt
