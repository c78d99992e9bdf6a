// SPDX-License-Identifier: Apache-2.0
#include "film/film_error.h"

#include "film/f_distribution.h"
#include "kernels/shared/render_types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace clrt {

namespace {

/// Of the pixels, those with the least noise: caustics and rims of lamps are in the others.
constexpr double TRIMMED_SHARE = 0.99;
constexpr size_t FEWEST_FOR_INTERVAL = 4; ///< replicates
constexpr size_t PIXELS_AT_ONCE =
    1u << 13;                     ///< of a parallel sum: its order, and so its bits, follow from this
constexpr int CHAIN_BLOCK = 8;    ///< pixels; a chain's steps stay nearer than this, most of them
constexpr double OUTSIDE = 0.025; ///< probability on either side of an interval of 95 %
constexpr double NORMAL_SQUARED = 3.841458820694124; ///< square of the normal distribution's quantile there
/// The width of 0.5 % that it leaves to an interval is less than what a reader makes of it.
constexpr double MOST_DEGREES = 1e5;

/// Sums over groups of pixels of their estimates of tr(C^2), C being the covariance of a replicate's values
/// in the group, and of the squares of these.
struct PairSums {
    double covariances = 0, squares = 0;

    void add_group(double covariance) {
        covariances += covariance;
        squares += covariance * covariance;
    }
    void add(const PairSums& other) {
        covariances += other.covariances;
        squares += other.squares;
    }
};

/// Sums over pixels of their squared error and mean, with and without each replicate.
struct ErrorSums {
    size_t pixels = 0;
    double squared = 0, mean = 0;
    PairSums pairs;
    std::vector<double> without;

    explicit ErrorSums(size_t replicates) : without(replicates, 0.0) {}
    void add(const ErrorSums& other) {
        pixels += other.pixels;
        squared += other.squared;
        mean += other.mean;
        pairs.add(other.pairs);
        for (size_t k = 0; k < without.size(); ++k)
            without[k] += other.without[k];
    }
};

/// Estimates tr(C^2) of a group of values, C being the covariance of a replicate's values, from the
/// deviations d_k of n replicates: the variance of the products d_k.d_l over pairs of replicates. `trace` is
/// the sum of d_k.d_k, which is minus that of the products, `squares` the sum of their squares over pairs k
/// != l. What the mean of the replicates instead of the truth makes of it is taken back as for normal ones,
/// of which the mean square is (1 - 1/n)^2 tr(C^2) + (tr(C)^2 + tr(C^2)) / n^2.
double squared_covariance(double trace, double squares, double n) {
    const double pairs = n * (n - 1), mean = trace / pairs;
    return (squares / pairs - mean * mean) / ((1 - 1 / n) * (1 - 1 / n) + (1 - 2 / (n - 1)) / (n * n));
}

/// That of a pixel, from its deviations channel by channel: the squares of all products are tr((sum d_k
/// d_k^T)^2), the |d_k|^4 among them.
double pixel_covariance(const std::vector<double>& deviations, size_t replicates) {
    std::array<double, 6> products{};
    double trace = 0, fourth = 0;
    for (size_t k = 0; k < replicates; ++k) {
        const double r = deviations[k], g = deviations[replicates + k], b = deviations[2 * replicates + k];
        const double square = r * r + g * g + b * b;
        const double of_replicate[] = {r * r, g * g, b * b, r * g, r * b, g * b};
        for (size_t i = 0; i < products.size(); ++i)
            products[i] += of_replicate[i];
        trace += square;
        fourth += square * square;
    }
    double squares = -fourth;
    for (size_t i = 0; i < products.size(); ++i)
        squares += (i < 3 ? 1 : 2) * products[i] * products[i];
    return squared_covariance(trace, squares, double(replicates));
}

/// Deviations of one value's replicates from their mean, times the root of its weight, with the sum of their
/// squares; returns the mean.
double read_weighted(const ReplicateMeans& replicates, const ErrorWeights& weights, size_t value,
                     double* deviations, double& squares) {
    const double mean = replicates.read_deviations(value, deviations, squares);
    if (const double weight = weights.of(value); weight != 1) {
        for (size_t k = 0; k < replicates.count(); ++k)
            deviations[k] *= std::sqrt(weight);
        squares *= weight;
    }
    return mean;
}

/// Adds the chosen pixels of a range. With deviations d_k from the mean of n replicates and S = sum d_k^2,
/// leaving out k leaves S - d_k^2 n / (n - 1).
void add_pixels(const ReplicateMeans& replicates, const PixelChoice& choice, const ErrorWeights& weights,
                const tbb::blocked_range<size_t>& range, ErrorSums& sums) {
    const size_t count = replicates.count();
    const double n = double(count);
    std::vector<double> deviations(3 * count);
    double squares = 0;
    for (size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
        if (!choice.has(pixel))
            continue;
        ++sums.pixels;
        for (size_t c = 0; c < 3; ++c) {
            double* of_channel = &deviations[c * count];
            sums.mean += read_weighted(replicates, weights, 3 * pixel + c, of_channel, squares);
            sums.squared += squares / (n * (n - 1));
            for (size_t k = 0; k < sums.without.size(); ++k)
                sums.without[k] +=
                    (squares - of_channel[k] * of_channel[k] * n / (n - 1)) / ((n - 1) * (n - 2));
        }
        if (!sums.without.empty())
            sums.pairs.add_group(pixel_covariance(deviations, count));
    }
}

/// That of the chosen pixels of a block, from all products d_k.d_l.
double block_covariance(const ReplicateMeans& replicates, const ErrorWeights& weights,
                        const std::vector<size_t>& pixels) {
    const size_t count = replicates.count();
    std::vector<double> deviations(count), products(count * count, 0.0);
    double unused = 0;
    for (const size_t pixel : pixels)
        for (size_t c = 0; c < 3; ++c) {
            read_weighted(replicates, weights, 3 * pixel + c, deviations.data(), unused);
            for (size_t k = 0; k < count; ++k)
                for (size_t l = k; l < count; ++l)
                    products[k * count + l] += deviations[k] * deviations[l];
        }
    double trace = 0, squares = 0;
    for (size_t k = 0; k < count; ++k) {
        trace += products[k * count + k];
        for (size_t l = k + 1; l < count; ++l)
            squares += 2 * products[k * count + l] * products[k * count + l];
    }
    return squared_covariance(trace, squares, double(count));
}

/// The sums over blocks of `side` x `side` pixels.
PairSums block_covariances(const Film& film, const ReplicateMeans& replicates, const PixelChoice& choice,
                           const ErrorWeights& weights, int side) {
    PairSums sums;
    std::vector<size_t> pixels;
    for (int top = 0; top < film.height; top += side)
        for (int left = 0; left < film.width; left += side) {
            pixels.clear();
            for (int y = top; y < std::min(top + side, film.height); ++y)
                for (int x = left; x < std::min(left + side, film.width); ++x)
                    if (const size_t pixel = size_t(y) * size_t(film.width) + size_t(x); choice.has(pixel))
                        pixels.push_back(pixel);
            sums.add_group(block_covariance(replicates, weights, pixels));
        }
    return sums;
}

/// Degrees of freedom of the sum of the pixels' squared errors (Satterthwaite 1946): (sum tr C)^2 over
/// sum tr C^2. `squared` is the sum of estimates of tr C / n; the square of the estimate is larger than that
/// of what it estimates by its variance.
double degrees_of(double squared, double covariances, double n) {
    if (!(squared > 0))
        return 0;
    const double trace = squared * n;
    const double ratio = covariances > 0 ? trace * trace / covariances : MOST_DEGREES;
    return std::max(ratio - 2 / (n - 1), 1.0);
}

/// Degrees of freedom of the sum of the estimates of tr(C^2): 2 over its relative variance. The variance of a
/// term is told by its square, of which it is the part `spread` where the noise is normal and of one
/// direction: for s^2 with m degrees of freedom E s^8 / (E s^4)^2 = (m + 4) (m + 6) / (m (m + 2)).
double degrees_of_pairs(const PairSums& sums, double n) {
    if (!(sums.covariances > 0))
        return 1;
    const double m = n - 1, spread = 1 - m * (m + 2) / ((m + 4) * (m + 6));
    return std::max(2 * sums.covariances * sums.covariances / (spread * sums.squares), 1.0);
}

/// Degrees of freedom whose distribution reaches as far above as that with `degrees` which are known from a
/// variance with `of_pairs` degrees: as Student's quantile instead of the normal one.
double degrees_above(double degrees, double of_pairs) {
    const double student = f_quantile(1 - 2 * OUTSIDE, 1, std::min(of_pairs, MOST_DEGREES));
    return std::max(degrees * std::min(NORMAL_SQUARED / student, 1.0), 1.0);
}

} // namespace

int error_block(Integrator integrator, bool reuses_paths) {
    if (walks_chains(integrator))
        return CHAIN_BLOCK;
    return reuses_paths ? TILE_SIZE : 1;
}

std::optional<SquaredError> film_squared_error(const Film& film, ErrorPixels pixels, int block,
                                               ErrorMeasure measure) {
    const ReplicateMeans replicates(film);
    const size_t count = replicates.count();
    if (count < 2)
        return std::nullopt;
    const PixelChoice choice(film, pixels);
    const ErrorWeights weights(film, choice, measure);
    const ErrorSums none(count >= FEWEST_FOR_INTERVAL ? count : 0);
    const ErrorSums sums = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(0, film_plane(film) / 3, PIXELS_AT_ONCE), none,
        [&](const tbb::blocked_range<size_t>& range, ErrorSums part) {
            add_pixels(replicates, choice, weights, range, part);
            return part;
        },
        [](ErrorSums a, const ErrorSums& b) {
            a.add(b);
            return a;
        });
    const double values = 3 * double(sums.pixels);
    SquaredError error{film_samples(film), sums.squared / values, sums.mean / values, sums.without};
    for (double& squared : error.without)
        squared /= values;
    const int side = std::max(block, film.block);
    if (sums.without.empty())
        return error;
    const PairSums pairs = side > 1 ? block_covariances(film, replicates, choice, weights, side) : sums.pairs;
    error.degrees = degrees_of(sums.squared, pairs.covariances, double(count));
    error.pair_degrees = degrees_of_pairs(pairs, double(count));
    return error;
}

std::optional<FilmError> relative_error(const SquaredError& squared) {
    if (!(squared.mean_radiance > 0))
        return std::nullopt;
    FilmError error;
    error.relative_rmse = std::sqrt(squared.mean_squared) / squared.mean_radiance;
    if (!(squared.degrees > 0))
        return error;
    const double degrees = std::min(squared.degrees, MOST_DEGREES);
    const double above = degrees_above(degrees, squared.pair_degrees);
    const double others = double(squared.without.size()) - 1;
    error.low = error.relative_rmse * std::sqrt(f_quantile(OUTSIDE, degrees, degrees * others));
    error.high = error.relative_rmse * std::sqrt(f_quantile(1 - OUTSIDE, above, above * others));
    return error;
}

std::optional<FilmError> film_error(const Film& film, ErrorPixels pixels, ErrorMeasure measure) {
    const std::optional<SquaredError> squared = film_squared_error(film, pixels, 1, measure);
    return squared ? relative_error(*squared) : std::nullopt;
}

double sample_error(const Film& film, ErrorMeasure measure) {
    const auto error = film_error(film, ErrorPixels::SCENE, measure);
    return error ? error->relative_rmse * error->relative_rmse * double(film_samples(film)) : 0;
}

double trimmed_sample_error(const Film& film) {
    const ReplicateMeans replicates(film);
    const size_t count = replicates.count();
    const PixelChoice choice(film, ErrorPixels::SCENE);
    const ErrorWeights weights(film, choice, ErrorMeasure::RELATIVE);
    std::vector<double> deviations(count), errors; // of pixels, squared
    double mean = 0;
    for (size_t pixel = 0; count > 1 && pixel < film_plane(film) / 3; ++pixel) {
        if (!choice.has(pixel))
            continue;
        errors.push_back(0);
        for (size_t c = 0; c < 3; ++c) {
            double squares = 0;
            mean += read_weighted(replicates, weights, 3 * pixel + c, deviations.data(), squares);
            errors.back() += squares / double(count * (count - 1));
        }
    }
    if (!(mean > 0))
        return 0;
    // Light that few samples find is in few pixels yet, and there is nothing to trim.
    const auto middle = errors.begin() + std::ptrdiff_t(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    if (*middle == 0)
        return sample_error(film, ErrorMeasure::RELATIVE);
    mean /= double(errors.size());
    const auto kept = errors.begin() + std::ptrdiff_t(std::ceil(TRIMMED_SHARE * double(errors.size())));
    std::nth_element(errors.begin(), kept - 1, errors.end());
    const double sum = std::accumulate(errors.begin(), kept, 0.0);
    return 3 * sum / (double(kept - errors.begin()) * mean * mean) * double(film_samples(film));
}

} // namespace clrt
