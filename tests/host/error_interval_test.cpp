// SPDX-License-Identifier: Apache-2.0
// Whether the interval holds the picture's own error: films of known distributions, many seeds each.
#include "film/film_error.h"

#include "probes/statistics.h"
#include "support/noise_film.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace clrt {

namespace {

constexpr int WIDTH = 12, HEIGHT = 10, TRIALS = 1000;
constexpr double MEAN = 10; ///< of every pixel and channel

/// How far a replicate's mean of one pixel is off; its mean over the random numbers is 0.
using Noise = std::function<glm::dvec3(std::mt19937&, size_t pixel)>;

/// A film in which each replicate has one sample.
Film noisy_film(int replicates, const Noise& noise, std::mt19937& random) {
    Film film = empty_film(WIDTH, HEIGHT, replicates, 0, std::uint64_t(replicates));
    for (size_t r = 0; r < size_t(replicates); ++r)
        for (size_t pixel = 0; pixel < film_plane(film) / 3; ++pixel) {
            const glm::dvec3 off = noise(random, pixel);
            for (int c = 0; c < 3; ++c)
                film.sums[r * film_plane(film) + 3 * pixel + size_t(c)] =
                    std::llround((MEAN + off[c]) / film.scale.quantum);
        }
    return film;
}

/// A film whose paths splat the same to `reach` x `reach` pixels: to those of a fixed lattice where reach is
/// 2, else around any pixel, beyond the border too.
Film splatted_film(int replicates, int reach, std::mt19937& random) {
    Film film = empty_film(WIDTH, HEIGHT, replicates, 0, std::uint64_t(replicates));
    const int step = reach == 2 ? 2 : 1, first = reach == 2 ? 0 : 1 - reach;
    for (size_t r = 0; r < size_t(replicates); ++r) {
        std::vector<double> values(film_plane(film) / 3, MEAN);
        for (int top = first; top < HEIGHT; top += step)
            for (int left = first; left < WIDTH; left += step) {
                const double splat = std::normal_distribution<double>()(random);
                for (int y = std::max(top, 0); y < std::min(top + reach, HEIGHT); ++y)
                    for (int x = std::max(left, 0); x < std::min(left + reach, WIDTH); ++x)
                        values[size_t(y) * WIDTH + size_t(x)] += splat;
            }
        for (size_t i = 0; i < film_plane(film); ++i)
            film.sums[r * film_plane(film) + i] = std::llround(values[i / 3] / film.scale.quantum);
    }
    return film;
}

/// The error that the picture has.
double own_error(const Film& film) {
    double squared = 0, mean = 0;
    for (const float value : film_mean(film)) {
        squared += (double(value) - MEAN) * (double(value) - MEAN) / double(film_plane(film));
        mean += double(value) / double(film_plane(film));
    }
    return std::sqrt(squared) / mean;
}

/// What many seeds give.
struct Coverage {
    double held = 0;     ///< share of the intervals that hold the own error
    double estimate = 0; ///< mean squared estimate over mean squared error
};

Coverage coverage_of(int replicates, const Noise& noise) {
    std::mt19937 random(11);
    Coverage result;
    double estimated = 0, realised = 0;
    int held = 0;
    for (int trial = 0; trial < TRIALS; ++trial) {
        const Film film = noisy_film(replicates, noise, random);
        const auto error = film_error(film);
        if (!error || !error->low || !error->high)
            return {};
        const double own = own_error(film);
        held += *error->low <= own && own <= *error->high;
        estimated += error->relative_rmse * error->relative_rmse;
        realised += own * own;
    }
    result.held = double(held) / TRIALS;
    result.estimate = estimated / realised;
    return result;
}

double normal(std::mt19937& random) {
    return std::normal_distribution<double>()(random);
}

/// Scale of a pixel's noise: a quarter of the pixels has ten times that of the others.
double scale_of(size_t pixel) {
    return pixel % 4 == 0 ? 1 : 0.1;
}

struct Case {
    std::string name;
    Noise noise;
    double least, most; ///< share of the intervals that hold the error
};

/// Of 1000 intervals of 95 %, 950 hold the error on average, with a standard deviation of 7.
const Case CASES[] = {
    {"independent channels",
     [](std::mt19937& random, size_t pixel) {
         return scale_of(pixel) * glm::dvec3(normal(random), normal(random), normal(random));
     },
     0.93, 0.97},
    {"channels that go together",
     [](std::mt19937& random, size_t pixel) {
         return scale_of(pixel) * normal(random) * glm::dvec3(1, 0.8, 0.5);
     },
     0.93, 0.97},
    {"five pixels at the edge of a lamp",
     [](std::mt19937& random, size_t pixel) { return glm::dvec3((pixel < 5 ? 4 : 0.02) * normal(random)); },
     0.93, 0.97},
    // What few replicates tell of a single pixel, and of noise that ends at hard bounds, is a little too
    // sure.
    {"one pixel",
     [](std::mt19937& random, size_t pixel) { return glm::dvec3(pixel == 7 ? 4 * normal(random) : 0); }, 0.9,
     0.97},
    {"bounded",
     [](std::mt19937& random, size_t pixel) {
         return glm::dvec3(scale_of(pixel) * std::uniform_real_distribution<double>(-1, 1)(random));
     },
     0.9, 0.97},
    // Rare bright samples: what only pairs of replicates could tell is not known well, the interval is wider.
    {"lognormal",
     [](std::mt19937& random, size_t) {
         return glm::dvec3(0.5 * (std::exp(1.2 * normal(random)) - std::exp(0.72)));
     },
     0.93, 1.0},
    {"events in every twentieth replicate",
     [](std::mt19937& random, size_t) {
         return glm::dvec3(4 * (std::poisson_distribution<int>(0.05)(random) - 0.05));
     },
     0.93, 1.0},
    // Few pixels decide, and which ones differs from seed to seed.
    {"an event a replicate, half as bright in each further pixel",
     [](std::mt19937& random, size_t pixel) {
         return glm::dvec3(std::ldexp(4.0, -int(pixel)) * (std::poisson_distribution<int>(1)(random) - 1));
     },
     0.93, 0.97},
};

struct OwnError : testing::TestWithParam<int> {};

} // namespace

TEST_P(OwnError, IsInTheIntervalAsOftenAsItSays) {
    double held = 0;
    for (const Case& made : CASES) {
        const Coverage coverage = coverage_of(GetParam(), made.noise);
        std::printf("%2d replicates, %-44s held %.3f, estimated over true %.3f\n", GetParam(),
                    made.name.c_str(), coverage.held, std::sqrt(coverage.estimate));
        EXPECT_GE(coverage.held, made.least) << made.name;
        EXPECT_LE(coverage.held, made.most) << made.name;
        EXPECT_NEAR(std::sqrt(coverage.estimate), 1, 0.05) << made.name;
        held += coverage.held / double(std::size(CASES));
    }
    EXPECT_GE(held, 0.93);
    EXPECT_LE(held, 0.97);
}

TEST(OwnErrorOfSplats, IsInTheIntervalThatTakesBlocksOfPixels) {
    // Each path splats the same to four pixels; then to three by three around any.
    for (const int reach : {2, 3}) {
        std::mt19937 random(5);
        int held = 0, held_by_pixels = 0;
        for (int trial = 0; trial < TRIALS; ++trial) {
            const Film film = splatted_film(8, reach, random);
            const double own = own_error(film);
            const auto holds = [&](int block) {
                const auto error = relative_error(*film_squared_error(film, ErrorPixels::ALL, block));
                return error->low <= own && own <= error->high;
            };
            held += holds(reach == 2 ? 2 : 12);
            held_by_pixels += holds(1);
        }
        std::printf("splats of %d x %d pixels: held %.3f by blocks, %.3f by pixels\n", reach, reach,
                    double(held) / TRIALS, double(held_by_pixels) / TRIALS);
        EXPECT_GE(held, 0.92 * TRIALS) << reach; // few independent blocks: a little too sure
        EXPECT_LE(held, 0.97 * TRIALS) << reach;
        EXPECT_LE(held_by_pixels, 0.85 * TRIALS) << reach << ": too sure";
    }
}

TEST(OwnErrorOfSplats, BlocksOfOnePixelAreThePixels) {
    std::mt19937 random(3);
    const Film film = splatted_film(8, 3, random);
    const double pixels = film_squared_error(film)->degrees;
    const double blocks = film_squared_error(film, ErrorPixels::SCENE, 2)->degrees;
    EXPECT_LT(blocks, 0.7 * pixels);
    Film apart = film; // every other pixel shows nothing: no two are neighbours
    apart.shown.assign(film_plane(film) / 3, 0);
    for (int y = 0; y < HEIGHT; y += 2)
        for (int x = 0; x < WIDTH; x += 2)
            apart.shown[size_t(y) * WIDTH + size_t(x)] = 1;
    EXPECT_NEAR(film_squared_error(apart, ErrorPixels::SCENE, 2)->degrees /
                    film_squared_error(apart)->degrees,
                1, 1e-9);
}

TEST(OwnErrorOfSplats, TakesTheBlocksOfItsFilm) {
    std::mt19937 random(5);
    Film film = splatted_film(8, 3, random);
    const double pixels = film_squared_error(film)->degrees;
    film.block = 6;
    const double blocks = film_squared_error(film)->degrees;
    EXPECT_LT(blocks, 0.6 * pixels);
    EXPECT_EQ(blocks, film_squared_error(film, ErrorPixels::SCENE, 6)->degrees);
    EXPECT_EQ(error_block(Integrator::MLT, false), 8);
    EXPECT_EQ(error_block(Integrator::BDPT, false), 1);
    EXPECT_EQ(error_block(Integrator::PATH, true), 8);
}

INSTANTIATE_TEST_SUITE_P(Replicates, OwnError, testing::Values(4, 8, 32),
                         [](const auto& test) { return std::to_string(test.param); });

} // namespace clrt
