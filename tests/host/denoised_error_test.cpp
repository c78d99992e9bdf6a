// SPDX-License-Identifier: Apache-2.0
// The error of a denoised picture: films of a known truth, with independent noise, smoothed by filters that
// blur it.
#include "denoise/denoised_error.h"

#include "denoise/smooth.h"
#include "film/film_error.h"
#include "support/noise_film.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace clrt {

namespace {

constexpr int WIDTH = 40, HEIGHT = 34, TRIALS = 100;

/// A picture with an edge and a slope, one sample in each replicate; noise as deviation of one replicate's
/// mean, bright by chance as rendered noise is.
class NoisyPictures {
public:
    explicit NoisyPictures(int replicates) : film(empty_film(WIDTH, HEIGHT, replicates, 0, replicates)) {
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
                for (int c = 0; c < 3; ++c)
                    truth.push_back((x < 20 ? 4 : 1) + 0.02 * y + 0.1 * c);
    }

    void fill() {
        std::exponential_distribution<double> noise(1);
        for (size_t i = 0; i < film.sums.size(); ++i)
            film.sums[i] =
                std::llround(truth[i % truth.size()] * (0.5 + 0.5 * noise(random_)) / film.scale.quantum);
    }

    void fill_exactly() {
        for (size_t i = 0; i < film.sums.size(); ++i)
            film.sums[i] = std::llround(truth[i % truth.size()] / film.scale.quantum);
    }

    /// The mean of a half's replicates, smoothed: it knows nothing of the other half.
    DenoisedHalf smoothed_half(size_t half, int radius) const {
        const ReplicateMeans replicates(film);
        const size_t of_half = replicates.count() / 2;
        std::vector<double> means(replicates.count());
        Pixels pixels;
        for (size_t i = 0; i < truth.size(); ++i) {
            replicates.read(i, means.data());
            double sum = 0;
            for (size_t k = half * of_half; k < (half + 1) * of_half; ++k)
                sum += means[k] / double(of_half);
            pixels.push_back(float(sum));
        }
        DenoisedHalf result;
        result.radiance = smooth_binomial(pixels, WIDTH, HEIGHT, 3, radius);
        result.expected.assign(truth.size() / 3, 1.0f);
        return result;
    }

    Film film;
    std::vector<double> truth;

private:
    std::mt19937 random_{7};
};

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value / double(values.size());
    return sum;
}

/// The squared error that the mean of two halves has, over the squared mean.
double true_square(const NoisyPictures& pictures, const std::array<DenoisedHalf, 2>& halves) {
    double sum = 0;
    for (size_t i = 0; i < pictures.truth.size(); ++i) {
        const double m = 0.5 * (double(halves[0].radiance[i]) + double(halves[1].radiance[i]));
        sum += (m - pictures.truth[i]) * (m - pictures.truth[i]) / double(pictures.truth.size());
    }
    return sum / (mean_of(pictures.truth) * mean_of(pictures.truth));
}

/// Whether a film's interval holds the error that two halves have.
bool holds(const NoisyPictures& pictures, const std::array<DenoisedHalf, 2>& halves) {
    const DenoisedError error = denoised_errors(pictures.film, halves, ErrorMeasure::MSE)->all;
    const double mean = film_squared_error(pictures.film)->mean_radiance;
    const double own = std::sqrt(true_square(pictures, halves)) * std::abs(mean_of(pictures.truth) / mean);
    return error.low <= own && own <= error.high;
}

/// What a film's estimate says, over many trials.
struct Calibration {
    double true_mean = 0, stated_mean = 0; ///< of squared errors
    double naive_mean = 0;                 ///< |f_A - f_B|^2 / 4
    double held = 0;                       ///< share of the trials whose interval holds the true error
    double scatter = 0;                    ///< standard error of stated_mean - true_mean

    /// Whether what is stated is right on average, as far as the trials tell, which is to 5 %.
    void expect_no_bias() const {
        EXPECT_NEAR(stated_mean, true_mean, 3.5 * scatter);
        EXPECT_LT(scatter, 0.05 * true_mean) << "too few trials to tell";
    }
};

Calibration calibrate(int replicates, int radius) {
    NoisyPictures pictures(replicates);
    Calibration result;
    double squares = 0;
    for (int trial = 0; trial < TRIALS; ++trial) {
        pictures.fill();
        const std::array halves = {pictures.smoothed_half(0, radius), pictures.smoothed_half(1, radius)};
        const DenoisedError error = denoised_errors(pictures.film, halves, ErrorMeasure::MSE)->all;
        const double mean = film_squared_error(pictures.film)->mean_radiance;
        const double square = true_square(pictures, halves) * std::pow(mean_of(pictures.truth) / mean, 2);
        result.true_mean += square / TRIALS;
        result.stated_mean += error.denoised * error.denoised / TRIALS;
        squares += std::pow(error.denoised * error.denoised - square, 2) / TRIALS;
        for (size_t i = 0; i < pictures.truth.size(); ++i)
            result.naive_mean += std::pow((halves[0].radiance[i] - halves[1].radiance[i]) / (2 * mean), 2) /
                                 double(pictures.truth.size() * TRIALS);
        result.held += double(error.low <= std::sqrt(square) && std::sqrt(square) <= error.high) / TRIALS;
    }
    result.scatter = std::sqrt(squares / TRIALS);
    return result;
}

} // namespace

TEST(DenoisedError, IsRightOnAverageWhatEverTheFilterSmears) {
    for (const int replicates : {4, 8})
        for (const int radius : {1, 4}) {
            const Calibration result = calibrate(replicates, radius);
            result.expect_no_bias();
            EXPECT_GE(result.held, 0.93) << replicates << ", " << radius;
        }
}

TEST(DenoisedError, HoldsWhereFewPixelsDecide) {
    // Eight pixels have a hundred times the noise of the others, as the rim of a lamp has.
    NoisyPictures pictures(4);
    std::mt19937 random(5);
    std::exponential_distribution<double> noise(1);
    int held = 0;
    for (int trial = 0; trial < 2 * TRIALS; ++trial) {
        pictures.fill();
        for (size_t i = 0; i < pictures.film.sums.size(); ++i)
            if (const size_t value = i % pictures.truth.size(); value / 3 % 170 == 0)
                pictures.film.sums[i] = std::llround(pictures.truth[value] * (100 * noise(random) - 99) /
                                                     pictures.film.scale.quantum);
        const std::array halves = {pictures.smoothed_half(0, 0), pictures.smoothed_half(1, 0)};
        held += holds(pictures, halves);
    }
    std::printf("held %d of %d\n", held, 2 * TRIALS);
    EXPECT_GE(held, 0.9 * 2 * TRIALS) << "1.96 standard errors hold 0.86";
}

TEST(DenoisedError, HoldsWherePixelsOfABlockHaveOneNoise) {
    // As where paths serve all pixels of a tile; of the larger blocks the picture has four.
    for (const size_t side : {size_t(4), size_t(20)}) {
        NoisyPictures pictures(4);
        pictures.film.block = int(side);
        const size_t plane = pictures.truth.size();
        int held = 0;
        for (int trial = 0; trial < 2 * TRIALS; ++trial) {
            pictures.fill();
            for (size_t i = 0; i < pictures.film.sums.size(); ++i) {
                const size_t value = i % plane, x = value / 3 % WIDTH, y = value / 3 / WIDTH;
                const size_t first = 3 * (y / side * side * WIDTH + x / side * side) + value % 3;
                const double noise = double(pictures.film.sums[i - value + first]) / pictures.truth[first];
                if (value > first)
                    pictures.film.sums[i] = std::llround(noise * pictures.truth[value]);
            }
            const std::array halves = {pictures.smoothed_half(0, 1), pictures.smoothed_half(1, 1)};
            held += holds(pictures, halves);
        }
        std::printf("held %d of %d\n", held, 2 * TRIALS);
        EXPECT_GE(held, 0.92 * 2 * TRIALS);
    }
}

TEST(DenoisedError, TakesPixelsWhereAllAreInOneBlock) {
    NoisyPictures pictures(4);
    pictures.fill();
    const std::array halves = {pictures.smoothed_half(0, 1), pictures.smoothed_half(1, 1)};
    const DenoisedError by_pixel = denoised_errors(pictures.film, halves, ErrorMeasure::MSE)->all;
    pictures.film.block = WIDTH;
    const DenoisedError by_block = denoised_errors(pictures.film, halves, ErrorMeasure::MSE)->all;
    EXPECT_LT(by_pixel.low, by_pixel.high);
    EXPECT_EQ(by_block.low, by_pixel.low);
    EXPECT_EQ(by_block.high, by_pixel.high);
}

TEST(DenoisedError, IsNeverNoneByNoiseAlone) {
    // Replicates of a half that lie on both sides of what the other half says make its squared error
    // negative.
    NoisyPictures pictures(4);
    pictures.fill();
    const size_t plane = pictures.truth.size();
    for (size_t i = 0; i < plane; ++i)
        for (const size_t half : {0, 1}) {
            std::int64_t* const sums = &pictures.film.sums[2 * half * plane + i];
            const std::int64_t off = std::abs(sums[0] - sums[plane]) + 1,
                               middle = std::llround(pictures.truth[i] / pictures.film.scale.quantum);
            sums[0] = middle - off;
            sums[plane] = middle + off;
        }
    const std::array halves = {pictures.smoothed_half(0, 0), pictures.smoothed_half(1, 0)};
    const DenoisedError error = denoised_errors(pictures.film, halves, ErrorMeasure::MSE)->all;
    EXPECT_EQ(error.denoised, 0);
    EXPECT_EQ(error.low, 0);
    EXPECT_GT(error.high, 0) << "how little there is of it is not known";
}

TEST(DenoisedError, TheHalvesDifferenceAloneSeesNoSmear) {
    const Calibration result = calibrate(8, 6);
    EXPECT_LT(result.naive_mean, 0.5 * result.true_mean) << "else the scene does not show the difference";
    result.expect_no_bias();
}

TEST(DenoisedError, IsThatOfTheRawPictureWhereNothingIsSmoothed) {
    NoisyPictures pictures(8);
    double stated = 0, raw = 0;
    for (int trial = 0; trial < 20; ++trial) {
        pictures.fill();
        const std::array halves = {pictures.smoothed_half(0, 0), pictures.smoothed_half(1, 0)};
        const DenoisedError error = denoised_errors(pictures.film, halves, ErrorMeasure::MSE)->all;
        EXPECT_NEAR(error.raw, film_error(pictures.film)->relative_rmse, 1e-9);
        stated += error.denoised;
        raw += error.raw;
    }
    EXPECT_NEAR(stated / raw, 1, 0.03);
}

TEST(DenoisedError, FollowsTheMeasure) {
    NoisyPictures pictures(8);
    pictures.fill();
    const std::array halves = {pictures.smoothed_half(0, 2), pictures.smoothed_half(1, 2)};
    const auto errors = denoised_errors(pictures.film, halves, ErrorMeasure::RELATIVE);
    EXPECT_NEAR(errors->all.raw,
                film_error(pictures.film, ErrorPixels::SCENE, ErrorMeasure::RELATIVE)->relative_rmse, 1e-9);
    EXPECT_NE(errors->all.denoised, denoised_errors(pictures.film, halves, ErrorMeasure::MSE)->all.denoised);
}

TEST(DenoisedError, TheWorstPixelsAreThoseOfWhichTheHalvesExpectIt) {
    NoisyPictures pictures(8);
    pictures.fill();
    std::array halves = {pictures.smoothed_half(0, 3), pictures.smoothed_half(1, 3)};
    for (DenoisedHalf& half : halves)
        for (int y = 10; y < 24; ++y)
            half.expected[size_t(y * WIDTH + 20)] = 5; // at the edge
    const DenoisedErrors errors = *denoised_errors(pictures.film, halves, ErrorMeasure::MSE);
    EXPECT_EQ(errors.worst.size(), size_t(std::ceil(0.01 * WIDTH * HEIGHT)));
    EXPECT_LT(errors.without_worst.denoised, errors.all.denoised);
    for (const size_t pixel : errors.worst)
        EXPECT_EQ(pixel % WIDTH, 20u);
}

TEST(DenoisedError, TilesAddUp) {
    NoisyPictures pictures(8);
    pictures.fill_exactly(); // so that no tile's estimate is negative
    const std::array halves = {pictures.smoothed_half(0, 3), pictures.smoothed_half(1, 3)};
    const DenoisedErrors errors = *denoised_errors(pictures.film, halves, ErrorMeasure::MSE);
    ASSERT_GT(errors.all.denoised, 0.01);
    EXPECT_LT(errors.all.raw, 1e-3);
    double sum = 0;
    for (const float tile : errors.tiles)
        sum += double(tile) * double(tile) / double(errors.tiles.size());
    EXPECT_NEAR(std::sqrt(sum), errors.all.denoised, 1e-6);
    EXPECT_EQ(errors.tiles[0], errors.tiles[31]);
    EXPECT_NE(errors.tiles[31], errors.tiles[32]);
}

TEST(DenoisedError, ABlackPictureHasNone) {
    const NoisyPictures pictures(4);
    const std::array halves = {pictures.smoothed_half(0, 1), pictures.smoothed_half(1, 1)};
    EXPECT_FALSE(denoised_errors(pictures.film, halves, ErrorMeasure::MSE));
}

} // namespace clrt
