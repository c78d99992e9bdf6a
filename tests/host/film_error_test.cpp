// SPDX-License-Identifier: Apache-2.0
// Errors, intervals, slopes and prices from made-up sums, against direct computation and the truth.
#include "film/film_error.h"

#include "film/error_slope.h"
#include "film/error_spread.h"
#include "film/f_distribution.h"
#include "probes/statistics.h"
#include "support/noise_film.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace clrt {

namespace {

/// Means of value `i` in the replicates that have samples.
std::vector<double> replicate_means(const Film& film, size_t i) {
    std::vector<double> means;
    const size_t plane = film.sums.size() / size_t(film.replicates);
    for (int r = 0; r < film.replicates; ++r)
        if (const double n = double(film_replicate_samples(film, r)); n > 0)
            means.push_back(double(film.sums[size_t(r) * plane + i]) * film.scale.quantum / n);
    return means;
}

/// Mean squared error by the spread of the replicates, without one of them (none: -1).
double mean_squared_error(const Film& film, int without) {
    const size_t plane = film.sums.size() / size_t(film.replicates);
    double sum = 0;
    for (size_t i = 0; i < plane; ++i) {
        std::vector<double> means = replicate_means(film, i);
        if (without >= 0)
            means.erase(means.begin() + without);
        sum += moments_of(means).variance_of_mean();
    }
    return sum / double(plane);
}

/// A film of 8 replicates whose first pixels have grey noise.
Film grey_film(int side, size_t noisy, std::mt19937& random) {
    std::normal_distribution<double> normal;
    Film film = empty_film(side, side, 8, 0, 8);
    fill_with_noise(film, 10, 0, random);
    for (size_t r = 0; r < 8; ++r)
        for (size_t pixel = 0; pixel < noisy; ++pixel) {
            const auto off = std::llround(normal(random) / film.scale.quantum);
            for (size_t c = 0; c < 3; ++c)
                film.sums[r * film_plane(film) + 3 * pixel + c] += off;
        }
    return film;
}

/// Errors of a render whose mean squared error is `first` at 8 samples and falls by `power`.
std::vector<SquaredError> falling_errors(double first, double power, int octaves) {
    std::vector<SquaredError> history;
    for (int k = 0; k <= octaves; ++k) {
        const double squared = first * std::exp2(power * k);
        history.push_back({std::uint64_t(8) << k, squared, 2, std::vector<double>(8, squared)});
    }
    return history;
}

} // namespace

TEST(FilmError, RelativeErrorsAreWeighedByTheBrightnessOfTiles) {
    std::mt19937 random(3);
    Film film = empty_film(20, 8, 8, 0, 80); // tiles of 8, 8 and 4 pixels a row
    fill_with_noise(film, 10, 1, random);
    const double shades[] = {1, 0.1, 0.001};
    for (size_t i = 0; i < film.sums.size(); ++i)
        film.sums[i] = std::llround(double(film.sums[i]) * shades[i / 3 % 20 / 8]);
    // In double, tile by tile.
    double means[3] = {}, mean = 0, expected = 0, without = 0;
    for (size_t i = 0; i < film_plane(film); ++i) {
        const size_t tile = i / 3 % 20 / 8;
        const Moments moments = moments_of(replicate_means(film, i));
        means[tile] += moments.mean / (tile < 2 ? 192 : 96);
        mean += moments.mean / 480;
    }
    for (size_t i = 0; i < film_plane(film); ++i) { // channels are as bright as each other, nearly
        const size_t tile = i / 3 % 20 / 8;
        std::vector<double> values = replicate_means(film, i);
        const double reference = means[tile] * means[tile] + 0.01 * mean * mean;
        expected += moments_of(values).variance_of_mean() / reference / 480;
        values.erase(values.begin() + 5);
        without += moments_of(values).variance_of_mean() / reference / 480;
    }
    const auto squared = film_squared_error(film, ErrorPixels::SCENE, 1, ErrorMeasure::RELATIVE);
    ASSERT_TRUE(squared);
    EXPECT_NEAR(relative_error(*squared)->relative_rmse / std::sqrt(expected), 1, 1e-3);
    EXPECT_NEAR(squared->without[5] / squared->mean_squared, without / expected, 1e-3);
    EXPECT_NEAR(squared->mean_radiance, mean, 1e-9);
    EXPECT_NEAR(film_error(film, ErrorPixels::SCENE, ErrorMeasure::RELATIVE)->relative_rmse,
                std::sqrt(expected), 1e-3 * std::sqrt(expected));
}

TEST(FilmError, TheErrorIsRootMeanSquareOverTheMean) {
    std::mt19937 random(3);
    Film film = empty_film(6, 5, 8, 0, 80);
    fill_with_noise(film, 2, 1, random);
    double mean = 0;
    for (const float value : film_mean(film))
        mean += double(value) / 90;
    const auto error = film_error(film);
    ASSERT_TRUE(error);
    EXPECT_NEAR(error->relative_rmse, std::sqrt(mean_squared_error(film, -1)) / mean, 1e-6);
    EXPECT_NEAR(error->relative_rmse, 1 / std::sqrt(80.0) / 2, 0.01);

    // 90 values of equal noise have 90 degrees of freedom, known by seven times as many.
    const double degrees = film_squared_error(film)->degrees;
    EXPECT_NEAR(degrees, 90, 15);
    ASSERT_TRUE(error->low && error->high);
    const auto probability_of = [&](double bound, double degrees_of_bound) {
        return f_probability(std::pow(bound / error->relative_rmse, 2), degrees_of_bound,
                             7 * degrees_of_bound);
    };
    EXPECT_NEAR(probability_of(*error->low, degrees), 0.025, 1e-7);
    // The upper end has fewer, as Student's quantile is larger than the normal one.
    const double student = f_quantile(0.95, 1, film_squared_error(film)->pair_degrees);
    EXPECT_NEAR(probability_of(*error->high, degrees * 3.8414588 / student), 0.975, 1e-6);
    EXPECT_GT(probability_of(*error->high, degrees), 0.9755);
}

TEST(FilmError, TheTrimmedErrorIsThatOfMostPixels) {
    std::mt19937 random(7);
    Film film = empty_film(40, 40, 8, 0, 64);
    fill_with_noise(film, 10, 1, random);
    const double clean = sample_error(film, ErrorMeasure::RELATIVE);
    EXPECT_NEAR(trimmed_sample_error(film), clean, 0.05 * clean);
    EXPECT_LT(trimmed_sample_error(film), clean);
    std::normal_distribution<double> noise(0, 640 / film.scale.quantum);
    for (size_t pixel = 0; pixel < 1600; pixel += 110) // 15 of 1600
        for (size_t r = 0; r < 8; ++r)
            film.sums[r * film_plane(film) + 3 * pixel] += std::llround(noise(random));
    EXPECT_GT(sample_error(film, ErrorMeasure::RELATIVE), 10 * clean);
    EXPECT_NEAR(trimmed_sample_error(film), clean, 0.05 * clean);
    Film rare = empty_film(40, 40, 8, 0, 64);
    for (size_t pixel = 0; pixel < 1600; pixel += 110)
        rare.sums[3 * pixel] = std::llround(100 / film.scale.quantum);
    EXPECT_GT(sample_error(rare, ErrorMeasure::RELATIVE), 10);
    EXPECT_EQ(trimmed_sample_error(rare), sample_error(rare, ErrorMeasure::RELATIVE));
    EXPECT_EQ(trimmed_sample_error(empty_film(8, 8, 8, 0, 64)), 0);
}

TEST(FilmError, DegreesOfFreedomCountPixelsAndChannelsThatGoTogetherOnce) {
    std::mt19937 random(12);
    double degrees = 0;
    constexpr int TRIALS = 200;
    for (int trial = 0; trial < TRIALS; ++trial)
        degrees += film_squared_error(grey_film(10, 25, random))->degrees / TRIALS;
    EXPECT_NEAR(degrees, 25, 1);
}

TEST(FilmError, DegreesOfPairsCountThePixelsThatDecide) {
    // Of s^2 with 7 degrees of freedom, s^4 has the relative variance 11 * 13 / (7 * 9) - 1.
    const double variance = 11 * 13 / (7 * 9.0) - 1;
    std::mt19937 random(12);
    EXPECT_NEAR(film_squared_error(grey_film(10, 1, random))->pair_degrees, 2 * (1 + variance) / variance,
                1e-9);
    double degrees = 0;
    constexpr int TRIALS = 20;
    for (int trial = 0; trial < TRIALS; ++trial)
        degrees += film_squared_error(grey_film(30, 900, random))->pair_degrees / TRIALS;
    EXPECT_NEAR(degrees, 2 * 900 / variance, 0.1 * degrees);
}

TEST(FilmError, UnderFourReplicatesThereIsNoInterval) {
    std::mt19937 random(4);
    Film film = empty_film(6, 5, 3, 0, 9);
    fill_with_noise(film, 2, 1, random);
    const auto error = film_error(film);
    ASSERT_TRUE(error);
    EXPECT_GT(error->relative_rmse, 0);
    EXPECT_FALSE(error->low || error->high);
}

TEST(FilmError, APictureWithoutNoiseHasErrorZeroAndABlackOneNone) {
    Film film = empty_film(2, 2, 8, 0, 16);
    film.sums.assign(film.sums.size(), 4096);
    const auto error = film_error(film);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->relative_rmse, 0);
    film.sums.assign(film.sums.size(), 0);
    EXPECT_FALSE(film_error(film));
}

// A white backdrop without noise in the upper half of a picture.
TEST(FilmError, TheErrorIsThatOfThePixelsThatShowTheScene) {
    std::mt19937 random(13);
    Film scene = empty_film(40, 20, 8, 0, 64), film = empty_film(40, 40, 8, 0, 64);
    fill_with_noise(scene, 2, 1, random);
    fill_with_noise(film, 50, 0, random);
    for (size_t r = 0; r < 8; ++r)
        std::copy_n(&scene.sums[r * film_plane(scene)], film_plane(scene),
                    &film.sums[r * film_plane(film) + film_plane(scene)]);
    const FilmError whole = *film_error(film), alone = *film_error(scene);
    EXPECT_LT(whole.relative_rmse, alone.relative_rmse / 10);

    const auto expect_same = [](const FilmError& a, const FilmError& b) {
        EXPECT_DOUBLE_EQ(a.relative_rmse, b.relative_rmse);
        EXPECT_NEAR(*a.low, *b.low, 1e-9);
        EXPECT_NEAR(*a.high, *b.high, 1e-9);
    };
    film.shown.assign(800, 0);
    film.shown.resize(1600, 1);
    EXPECT_TRUE(has_backdrop(film));
    expect_same(*film_error(film), alone);
    expect_same(*film_error(film, ErrorPixels::ALL), whole);
    EXPECT_NEAR(film_error_spread(film)->worst_tile, alone.relative_rmse, 0.1 * alone.relative_rmse);
    EXPECT_EQ(film_error_spread(film)->tail_pixels, 1u) << "of 800";

    // Pictures full of it, without it, and of which that is not known.
    for (const std::vector<std::uint8_t>& shown :
         {std::vector<std::uint8_t>(1600, 1), std::vector<std::uint8_t>(1600, 0),
          std::vector<std::uint8_t>()}) {
        film.shown = shown;
        EXPECT_FALSE(has_backdrop(film));
        expect_same(*film_error(film), whole);
    }
}

TEST(FilmError, AFewPixelsOfTheSceneInATileDoNotMakeItTheWorst) {
    std::mt19937 random(14);
    Film film = empty_film(64, 32, 8, 0, 64); // two tiles
    fill_with_noise(film, 10, 1, random);
    film.shown.assign(64 * 32, 0);
    for (size_t i = 0; i < film.shown.size(); ++i)
        film.shown[i] = i % 64 < 32 || i == 63;
    std::normal_distribution<double> noise(0,
                                           8 * 2); // of that one pixel: nearly six times that of the others
    for (size_t r = 0; r < 8; ++r)
        for (size_t c = 0; c < 3; ++c)
            film.sums[r * film_plane(film) + 3 * 63 + c] += std::llround(noise(random) / film.scale.quantum);
    EXPECT_EQ(film_error_spread(film)->tile_x, 0);
}

TEST(FilmError, TheSlopeIsThatOfTheLine) {
    const auto slope = error_slope(falling_errors(0.5, -1.4, 4));
    ASSERT_TRUE(slope);
    EXPECT_NEAR(slope->slope, -0.7, 1e-12) << "of the error, not of its square";
    EXPECT_NEAR(slope->reach, 0, 1e-12);
    EXPECT_EQ(slope->first_samples, 8u);
    EXPECT_EQ(slope->last_samples, 128u);
}

TEST(FilmError, ThereIsNoSlopeUnderFourOctavesOrWithoutError) {
    EXPECT_FALSE(error_slope({}));
    EXPECT_FALSE(error_slope(falling_errors(0.5, -1, 3)));
    auto history = falling_errors(0.5, -1, 3);
    history.push_back(history.back()); // five errors, three octaves
    history.back().samples += 8;
    EXPECT_FALSE(error_slope(history));
    history = falling_errors(0.5, -1, 4);
    history.back().mean_squared = 0;
    EXPECT_FALSE(error_slope(history));
    history = falling_errors(0.5, -1, 4);
    history[2].without.clear();
    EXPECT_FALSE(error_slope(history));
}

TEST(FilmError, TheSlopeOfIndependentSamplesIsInItsInterval) {
    std::mt19937 random(6);
    int covered = 0;
    double sum = 0;
    const int trials = 200;
    for (int trial = 0; trial < trials; ++trial) {
        Film film = empty_film(8, 8, 8, 0, 0);
        std::vector<SquaredError> history;
        for (std::uint64_t samples = 8; samples <= 256; samples *= 2) {
            add_noise(film, samples, 10, 1, random);
            history.push_back(*film_squared_error(film));
        }
        const auto slope = error_slope(history);
        ASSERT_TRUE(slope);
        sum += slope->slope / trials;
        covered += std::abs(slope->slope + 0.5) <= slope->reach;
    }
    EXPECT_NEAR(sum, -0.5, 0.01);
    EXPECT_GE(covered, 178) << "of 190 expected; the standard deviation is 3.1";
}

TEST(FilmError, TheWorstTileIsFound) {
    std::mt19937 random(7);
    Film film = empty_film(70, 40, 8, 0, 64);
    fill_with_noise(film, 10, 1, random);
    const size_t plane = film_plane(film);
    // Noise in the tile at 64,32, which is cut off by the picture's edges: 6 x 8 pixels.
    std::normal_distribution<double> noise(0, 8 * 20);
    for (size_t r = 0; r < 8; ++r)
        for (size_t y = 32; y < 40; ++y)
            for (size_t x = 64; x < 70; ++x)
                for (size_t c = 0; c < 3; ++c)
                    film.sums[r * plane + 3 * (y * 70 + x) + c] +=
                        std::llround(noise(random) / film.scale.quantum);
    const auto spread = film_error_spread(film);
    ASSERT_TRUE(spread);
    EXPECT_EQ(spread->tile_x, 64);
    EXPECT_EQ(spread->tile_y, 32);
    EXPECT_NEAR(spread->worst_tile, 20 / std::sqrt(8.0) / 10, 0.05) << "over the picture's mean";
    EXPECT_TRUE(spread->usable());
}

TEST(FilmError, NoiseInFewPixelsThatAllReplicatesSawIsBelieved) {
    std::mt19937 random(8);
    Film film = empty_film(50, 40, 8, 0, 64); // two pixels are a thousandth
    fill_with_noise(film, 10, 1, random);
    auto spread = film_error_spread(film);
    ASSERT_TRUE(spread);
    EXPECT_EQ(spread->tail_pixels, 2u);
    EXPECT_LT(spread->tail_share, 0.01);
    EXPECT_LT(spread->once_share, 0.02);
    EXPECT_LT(spread->once_error, 0.005);

    // The edge of a lamp: two of 2000 pixels with 80 % of the error.
    std::normal_distribution<double> noise(0, 8 * 60);
    for (size_t r = 0; r < 8; ++r)
        for (size_t i = 900; i < 906; ++i)
            film.sums[r * film_plane(film) + i] += std::llround(noise(random) / film.scale.quantum);
    spread = film_error_spread(film);
    ASSERT_TRUE(spread);
    EXPECT_GT(spread->tail_share, 0.7);
    EXPECT_LT(spread->once_error, 0.01);
    EXPECT_TRUE(spread->usable());
}

TEST(FilmError, ARareBrightEventMakesItUnusable) {
    std::mt19937 random(8);
    Film film = empty_film(50, 40, 8, 0, 64);
    fill_with_noise(film, 10, 1, random);
    // One replicate saw something in one pixel that brings its own 10 to 166.
    film.sums[3 * film_plane(film) + 300] += std::llround(8 * 1250 / film.scale.quantum);
    const auto spread = film_error_spread(film);
    ASSERT_TRUE(spread);
    EXPECT_GT(spread->tail_share, 0.9);
    EXPECT_GT(spread->once_share, 0.9);
    EXPECT_NEAR(spread->once_error, spread->once_share, 0.01)
        << "the square of a single event is uncertain by itself";
    EXPECT_FALSE(spread->usable());
}

TEST(FilmError, ManyEventsSeenOnceMakeItUsable) {
    std::mt19937 random(8);
    // Every pixel's noise is one event in one of the replicates: their number is known well.
    for (const auto& [events, usable] : {std::pair{10, false}, {1000, true}}) {
        Film film = empty_film(50, 40, 8, 0, 64);
        fill_with_noise(film, 10, 0, random);
        for (int i = 0; i < events; ++i)
            film.sums[size_t(i % 8) * film_plane(film) + size_t(6 * i)] +=
                std::llround(8 * 1250 / film.scale.quantum);
        const auto spread = film_error_spread(film);
        ASSERT_TRUE(spread);
        EXPECT_NEAR(spread->once_share, 1, 1e-9);
        EXPECT_NEAR(spread->once_error, 1 / std::sqrt(events), 1e-6);
        EXPECT_EQ(spread->usable(), usable) << events;
    }
}

// Pictures that see rare bright events, from one to a hundred: the verdict must doubt the errors that are
// wrong by a fifth, unless no event was seen at all, which nothing in a picture can tell.
TEST(FilmError, TheVerdictDoubtsWrongErrorsAndBelievesManyEvents) {
    std::mt19937 random(10);
    constexpr double CHANCE = 1e-5, EVENT = 400; // a sample
    constexpr int PIXELS = 2000;
    int wrong = 0, wrong_believed = 0;
    for (int trial = 0; trial < 240; ++trial) {
        const std::uint64_t samples = std::uint64_t(64) << (3 * (trial % 3));
        Film film = empty_film(50, 40, 8, 0, samples);
        fill_with_noise(film, 10, 1, random);
        std::poisson_distribution<int> number(CHANCE * double(samples) * PIXELS / 8);
        std::uniform_int_distribution<size_t> where(0, PIXELS - 1);
        int seen = 0;
        for (size_t r = 0; r < 8; ++r)
            for (int left = number(random); left > 0; --left, ++seen)
                for (size_t c = 0, pixel = where(random); c < 3; ++c)
                    film.sums[r * film_plane(film) + 3 * pixel + c] +=
                        std::llround(EVENT / film.scale.quantum);
        if (seen == 0)
            continue;
        const auto squared = film_squared_error(film);
        const auto spread = film_error_spread(film);
        ASSERT_TRUE(squared && spread);
        const double ratio =
            std::sqrt(squared->mean_squared * double(samples) / (1 + CHANCE * EVENT * EVENT));
        const bool is_wrong = ratio > 1.2 || ratio < 1 / 1.2;
        wrong += is_wrong;
        wrong_believed += is_wrong && spread->usable();
        const bool has_many = samples == 4096; // 82 events on average
        EXPECT_TRUE(spread->usable() || !has_many) << seen;
    }
    std::printf("%d errors wrong by a fifth, %d of them believed\n", wrong, wrong_believed);
    EXPECT_GT(wrong, 20);
    EXPECT_LE(wrong_believed, wrong / 20);
}

TEST(FilmError, TheSameFilmGivesTheSameBits) {
    std::mt19937 random(9);
    Film film = empty_film(300, 200, 8, 0, 64);
    fill_with_noise(film, 10, 1, random);
    const auto first = film_squared_error(film);
    for (int run = 0; run < 5; ++run) {
        const auto again = film_squared_error(film);
        EXPECT_EQ(again->mean_squared, first->mean_squared);
        EXPECT_EQ(again->without, first->without);
    }
}

} // namespace clrt
