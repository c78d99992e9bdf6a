// SPDX-License-Identifier: Apache-2.0
// What a better picture costs, in samples and seconds, with an interval. A promise is made for a number of
// samples at which the picture is even (good_counts.h), and says what the error is there. It rests on how the
// error fell so far:
//
// The error after n samples a pixel is taken as that of the last doubling, n0, times (n / n0)^s. The slope s
// is the mean of two, each weighted by its inverse variance: the slope measured over the last four octaves of
// this render, and that of renders in general, -0.55 +- 0.13 (seven scenes with light of every kind; -0.5
// would be independent samples, Sobol points reach -0.9 where the light has no edges). What was measured is
// not what comes next: from one octave to the next the slopes of one scene differ by 0.08, which is added to
// the variance. So a short render is told what is usual, and a long one what it has shown.
//
// The interval holds FORECAST_CONFIDENCE of what comes: its ends are the good counts at which the error would
// have come down with a slope that is as far from s as its standard deviation makes likely, and by errors
// that are off by their own.
#pragma once

#include "film/film_error.h"

#include <optional>
#include <vector>

namespace clrt {

/// How the error of a render goes on.
struct ErrorForecast {
    std::uint64_t samples = 0; ///< a pixel, at the last doubling,
    double relative_rmse = 0;  ///< and the error there
    double slope = 0;
    bool measured = false;      ///< the slope, in part; otherwise it is the usual one
    double slope_deviation = 0; ///< standard deviation,
    double error_deviation = 0; ///< and that of the error's logarithm
};

/// Share of the intervals that are to hold the number of samples at which the error is reached.
constexpr double FORECAST_CONFIDENCE = 0.8;

/// From the errors of a render at its doublings, or, where none was measured, from the present error. None
/// where the picture is black or its error 0.
std::optional<ErrorForecast> forecast_error(const std::vector<SquaredError>& doublings,
                                            const SquaredError& present);

/// The relative error at a good count.
double error_at(const ErrorForecast& forecast, std::uint64_t samples, int replicates);

/// What a smaller error would cost.
struct ErrorPrice {
    std::uint64_t samples = 0;     ///< a pixel in all: a good count
    double relative_rmse = 0;      ///< with them: the error that is asked for, or less
    double factor = 0;             ///< times the present samples
    double seconds = 0;            ///< of rendering, beyond the present
    double slope = 0;              ///< of the forecast
    bool measured = false;         ///< the slope, in part
    std::uint64_t low_samples = 0; ///< ends of the interval: good counts,
    std::optional<std::uint64_t> high_samples = std::nullopt; ///< none: more than anybody can name
    double low_seconds = 0;
    std::optional<double> high_seconds = std::nullopt;
};

/// The smallest good count at which the error of a render is `target` or less, as forecast from `doublings`.
/// `seconds` is what the present samples took. None where the error is 0 or falls so slowly that no number of
/// samples can be named.
std::optional<ErrorPrice> price_of_error(double target, const std::vector<SquaredError>& doublings,
                                         const SquaredError& present, int replicates, double seconds);

/// The price of half the present error, or hardly more.
std::optional<ErrorPrice> price_of_half(const std::vector<SquaredError>& doublings,
                                        const SquaredError& present, int replicates, double seconds);

} // namespace clrt
