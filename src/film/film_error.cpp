// SPDX-License-Identifier: Apache-2.0
#include "film/film_error.h"

#include "film/f_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace clrt {

namespace {

constexpr size_t FEWEST_FOR_INTERVAL = 4; ///< replicates
constexpr size_t FEWEST_FOR_SLOPE = 5;    ///< errors
constexpr double OCTAVES_FOR_SLOPE = 16;  ///< last over first samples: four octaves
constexpr size_t TAIL_PART = 1000;        ///< the tail is this part of the pixels
constexpr double ALONE = 0.9; ///< of a single event's share: 1 of 200 pixels of normal noise, 8 replicates
constexpr size_t PIXELS_AT_ONCE =
    1u << 13; ///< of a parallel sum: its order, and so its bits, follow from this
constexpr size_t FEWEST_OF_TILE =
    8;                            ///< a tile's pixels of the scene count as this part of its pixels at least
constexpr double OUTSIDE = 0.025; ///< probability on either side of an interval of 95 %
/// The width of 0.5 % that it leaves to an interval is less than what a reader makes of it.
constexpr double MOST_DEGREES = 1e5;

/// Tells whether an error is stated over a pixel.
class PixelChoice {
public:
    PixelChoice(const Film& film, ErrorPixels pixels)
        : shown_(pixels == ErrorPixels::SCENE && has_backdrop(film) ? film.shown.data() : nullptr) {}
    bool has(size_t pixel) const { return !shown_ || shown_[pixel]; }

private:
    const std::uint8_t* shown_;
};

/// Sums over pixels of their squared error and mean, with and without each replicate.
struct ErrorSums {
    size_t pixels = 0;
    double squared = 0, mean = 0;
    double covariances = 0; ///< estimates of tr(C^2), C being the covariance of a replicate's channels
    std::vector<double> without;

    explicit ErrorSums(size_t replicates) : without(replicates, 0.0) {}
    void add(const ErrorSums& other) {
        pixels += other.pixels;
        squared += other.squared;
        mean += other.mean;
        covariances += other.covariances;
        for (size_t k = 0; k < without.size(); ++k)
            without[k] += other.without[k];
    }
};

/// Estimates tr(C^2) of a pixel from the deviations of its n replicates, channel by channel: the variance of
/// the products d_k.d_l over pairs of replicates, whose squares are those of all products, which are tr((sum
/// d_k d_k^T)^2), without the |d_k|^4, and whose sum is that of -d_k.d_k. What the mean of the replicates
/// instead of the truth makes of it is taken back as for normal ones, of which the mean square is (1 - 1/n)^2
/// tr(C^2) + (tr(C)^2 + tr(C^2)) / n^2.
double squared_covariance(const std::vector<double>& deviations, size_t replicates) {
    const double n = double(replicates);
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
    const double pairs = n * (n - 1), mean = trace / pairs;
    return (squares / pairs - mean * mean) / ((1 - 1 / n) * (1 - 1 / n) + (1 - 2 / (n - 1)) / (n * n));
}

/// Adds the chosen pixels of a range. With deviations d_k from the mean of n replicates and S = sum d_k^2,
/// leaving out k leaves S - d_k^2 n / (n - 1).
void add_pixels(const ReplicateMeans& replicates, const PixelChoice& choice, size_t begin, size_t end,
                ErrorSums& sums) {
    const size_t count = replicates.count();
    const double n = double(count);
    std::vector<double> deviations(3 * count);
    double squares = 0;
    for (size_t pixel = begin; pixel < end; ++pixel) {
        if (!choice.has(pixel))
            continue;
        ++sums.pixels;
        for (size_t c = 0; c < 3; ++c) {
            double* of_channel = &deviations[c * count];
            sums.mean += replicates.read_deviations(3 * pixel + c, of_channel, squares);
            sums.squared += squares / (n * (n - 1));
            for (size_t k = 0; k < sums.without.size(); ++k)
                sums.without[k] +=
                    (squares - of_channel[k] * of_channel[k] * n / (n - 1)) / ((n - 1) * (n - 2));
        }
        if (!sums.without.empty())
            sums.covariances += squared_covariance(deviations, count);
    }
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

/// 97.5 % quantile of Student's t for 1 to 63 degrees of freedom (Abramowitz and Stegun, table 26.10, by
/// their expansion 26.7.5 beyond 7).
double student_quantile(size_t degrees) {
    static const double SMALL[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365};
    if (degrees <= 7)
        return SMALL[degrees - 1];
    const double z = 1.959964, n = double(degrees);
    return z + (z * z * z + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

/// Half the length of the 95 % interval of a number that takes these values when one replicate is left out.
double jackknife_reach(const std::vector<double>& values) {
    const double n = double(values.size());
    double mean = 0, spread = 0;
    for (const double value : values)
        mean += value / n;
    for (const double value : values)
        spread += (value - mean) * (value - mean);
    return student_quantile(values.size() - 1) * std::sqrt(spread * (n - 1) / n);
}

/// Slope of the line of least squares.
double line_slope(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = double(x.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / n;
        mean_y += y[i] / n;
    }
    for (size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return xy / xx;
}

/// Squared deviations of one pixel, summed over its channels.
struct PixelSquares {
    double sum = 0, largest = 0; ///< over replicates
};

PixelSquares pixel_squares(const ReplicateMeans& replicates, size_t pixel, std::vector<double>& deviations,
                           std::vector<double>& squares) {
    PixelSquares result;
    double sum = 0;
    std::fill(squares.begin(), squares.end(), 0.0);
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
        replicates.read_deviations(i, deviations.data(), sum);
        result.sum += sum;
        for (size_t k = 0; k < squares.size(); ++k)
            squares[k] += deviations[k] * deviations[k];
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
PixelErrors pixel_errors(const Film& film, const PixelChoice& scene) {
    const ReplicateMeans replicates(film);
    const double n = double(replicates.count());
    PixelErrors errors;
    if (replicates.count() < 2)
        return errors;
    errors.variance.resize(film_plane(film) / 3);
    std::vector<double> deviations(replicates.count()), squares(replicates.count());
    for (size_t i = 0; i < errors.variance.size(); ++i) {
        if (!scene.has(i))
            continue;
        const PixelSquares found = pixel_squares(replicates, i, deviations, squares);
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

bool has_backdrop(const Film& film) {
    const std::optional<size_t> shown = film_shown_pixels(film);
    return shown && *shown > 0 && *shown < film.shown.size();
}

std::optional<SquaredError> film_squared_error(const Film& film, ErrorPixels pixels) {
    const ReplicateMeans replicates(film);
    const size_t count = replicates.count();
    if (count < 2)
        return std::nullopt;
    const PixelChoice choice(film, pixels);
    const ErrorSums none(count >= FEWEST_FOR_INTERVAL ? count : 0);
    const ErrorSums sums = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(0, film_plane(film) / 3, PIXELS_AT_ONCE), none,
        [&](const tbb::blocked_range<size_t>& range, ErrorSums part) {
            add_pixels(replicates, choice, range.begin(), range.end(), part);
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
    if (!sums.without.empty())
        error.degrees = degrees_of(sums.squared, sums.covariances, double(count));
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
    const double below = degrees * (double(squared.without.size()) - 1);
    error.low = error.relative_rmse * std::sqrt(f_quantile(OUTSIDE, degrees, below));
    error.high = error.relative_rmse * std::sqrt(f_quantile(1 - OUTSIDE, degrees, below));
    return error;
}

std::optional<FilmError> film_error(const Film& film, ErrorPixels pixels) {
    const std::optional<SquaredError> squared = film_squared_error(film, pixels);
    return squared ? relative_error(*squared) : std::nullopt;
}

std::optional<ErrorSlope> error_slope(const std::vector<SquaredError>& history) {
    if (history.size() < FEWEST_FOR_SLOPE ||
        double(history.back().samples) < OCTAVES_FOR_SLOPE * double(history.front().samples))
        return std::nullopt;
    return fit_error_slope(history);
}

std::optional<ErrorSlope> fit_error_slope(const std::vector<SquaredError>& history) {
    if (history.size() < 2)
        return std::nullopt;
    const size_t replicates = history.back().without.size();
    for (const SquaredError& error : history)
        if (error.without.size() != replicates || replicates == 0 || !(error.mean_squared > 0))
            return std::nullopt;
    // Fit the errors, then those that leave out one replicate: what they share by being nested is inside the
    // spread.
    std::vector<double> x, y, without;
    for (const SquaredError& error : history) {
        x.push_back(std::log(double(error.samples)));
        y.push_back(0.5 * std::log(error.mean_squared));
    }
    ErrorSlope result{line_slope(x, y), 0, history.front().samples, history.back().samples};
    for (size_t k = 0; k < replicates; ++k) {
        for (size_t i = 0; i < history.size(); ++i)
            y[i] = 0.5 * std::log(history[i].without[k]);
        without.push_back(line_slope(x, y));
    }
    result.reach = jackknife_reach(without);
    return result;
}

std::optional<ErrorSpread> film_error_spread(const Film& film) {
    const PixelChoice scene(film, ErrorPixels::SCENE);
    PixelErrors errors = pixel_errors(film, scene);
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
