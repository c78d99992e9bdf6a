// SPDX-License-Identifier: Apache-2.0
#include "film/error_spread.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace clrt {

namespace {

constexpr size_t TAIL_PART = 1000; ///< the tail is this part of the pixels
constexpr double ALONE = 0.9; ///< of a single event's share: 1 of 200 pixels of normal noise, 8 replicates
constexpr size_t FEWEST_OF_TILE =
    8; ///< a tile's pixels of the scene count as this part of its pixels at least

/// Squared deviations of one pixel, summed over its channels.
struct PixelSquares {
    double sum = 0, largest = 0; ///< over replicates
};

PixelSquares pixel_squares(const ReplicateMeans& replicates, const ErrorWeights& weights, size_t pixel,
                           std::vector<double>& deviations, std::vector<double>& squares) {
    PixelSquares result;
    double sum = 0;
    std::fill(squares.begin(), squares.end(), 0.0);
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
        replicates.read_deviations(i, deviations.data(), sum);
        const double weight = weights.of(i);
        result.sum += weight * sum;
        for (size_t k = 0; k < squares.size(); ++k)
            squares[k] += weight * deviations[k] * deviations[k];
    }
    result.largest = *std::max_element(squares.begin(), squares.end());
    return result;
}

/// Squared errors of the pixels.
struct PixelErrors {
    std::vector<double> variance; ///< of each pixel's mean, summed over channels; 0 beside the scene
    double once = 0;              ///< sum of those that rest on one replicate
    double once_squared = 0;      ///< sum of their squares
};

/// Finds the pixels in which one replicate stands alone: of n deviations it holds nearly (n - 1) / n of the
/// squares, which is what a single event gives. Such a pixel tells of an event that may as well have been
/// missed.
PixelErrors pixel_errors(const Film& film, const PixelChoice& scene, ErrorMeasure measure) {
    const ReplicateMeans replicates(film);
    const ErrorWeights weights(film, scene, measure);
    const double n = double(replicates.count());
    PixelErrors errors;
    if (replicates.count() < 2)
        return errors;
    errors.variance.resize(film_plane(film) / 3);
    std::vector<double> deviations(replicates.count()), squares(replicates.count());
    for (size_t i = 0; i < errors.variance.size(); ++i) {
        if (!scene.has(i))
            continue;
        const PixelSquares found = pixel_squares(replicates, weights, i, deviations, squares);
        const double variance = found.sum / (n * (n - 1));
        errors.variance[i] = variance;
        if (found.largest > ALONE * (n - 1) / n * found.sum) {
            errors.once += variance;
            errors.once_squared += variance * variance;
        }
    }
    return errors;
}

/// Mean over a tile's pixels that show the scene; (x, y) is its top left pixel. Few of them do not make it
/// the worst: an edge alone is noisier than what it belongs to.
double tile_mean(const std::vector<double>& pixels, const Film& film, const PixelChoice& scene, int x,
                 int y) {
    const int end_x = std::min(x + ERROR_TILE_SIZE, film.width),
              end_y = std::min(y + ERROR_TILE_SIZE, film.height);
    double sum = 0;
    size_t count = 0;
    for (int row = y; row < end_y; ++row)
        for (int column = x; column < end_x; ++column) {
            const size_t pixel = size_t(row) * size_t(film.width) + size_t(column);
            sum += pixels[pixel];
            count += scene.has(pixel);
        }
    const double all = double(end_x - x) * double(end_y - y);
    return sum / std::max(double(count), all / FEWEST_OF_TILE);
}

} // namespace

std::optional<ErrorSpread> film_error_spread(const Film& film, ErrorMeasure measure) {
    const PixelChoice scene(film, ErrorPixels::SCENE);
    PixelErrors errors = pixel_errors(film, scene, measure);
    std::vector<double>& pixels = errors.variance;
    double total = 0, radiance = 0;
    for (const double variance : pixels)
        total += variance;
    const size_t scene_pixels = has_backdrop(film) ? *film_shown_pixels(film) : film_plane(film) / 3;
    const std::vector<float> picture = film_mean(film);
    for (size_t i = 0; i < picture.size(); ++i)
        if (scene.has(i / 3))
            radiance += double(picture[i]) / (3 * double(scene_pixels));
    if (!(total > 0) || !(radiance > 0))
        return std::nullopt;

    // Events seen once are as uncertain as a count of one: the variance of their sum is the sum of their
    // squares.
    ErrorSpread spread;
    spread.once_share = errors.once / total;
    spread.once_error = std::sqrt(errors.once_squared) / total;

    // Find the worst tile.
    double worst = -1;
    for (int y = 0; y < film.height; y += ERROR_TILE_SIZE)
        for (int x = 0; x < film.width; x += ERROR_TILE_SIZE)
            if (const double mean = tile_mean(pixels, film, scene, x, y); mean > worst) {
                worst = mean;
                spread.tile_x = x;
                spread.tile_y = y;
            }
    spread.worst_tile = std::sqrt(worst / 3) / radiance;

    // Sum the noisiest pixels.
    spread.tail_pixels = (scene_pixels + TAIL_PART - 1) / TAIL_PART;
    const auto tail_end = pixels.begin() + std::ptrdiff_t(spread.tail_pixels);
    std::nth_element(pixels.begin(), tail_end - 1, pixels.end(), std::greater<>());
    std::sort(pixels.begin(), tail_end); // one order of summation
    for (auto pixel = pixels.begin(); pixel != tail_end; ++pixel)
        spread.tail_share += *pixel / total;
    return spread;
}

} // namespace clrt
