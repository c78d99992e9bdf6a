// SPDX-License-Identifier: Apache-2.0
#include "render/error_price.h"

#include "film/error_slope.h"
#include "render/good_counts.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

constexpr double USUAL_SLOPE = -0.55,
                 USUAL_SLOPE_SPREAD = 0.13; ///< of renders in general, one standard deviation
constexpr double SLOPE_UNREST = 0.08;       ///< standard deviation from octave to octave
constexpr size_t ERRORS_FOR_SLOPE = 5;      ///< the last four octaves
constexpr double ERRORS_OF_INTERVAL = 2;    ///< half a 95 % interval is about two standard errors
constexpr double NEARLY_HALF = 1.05;        ///< of half the error: no promise is more exact
constexpr double LARGEST_FACTOR = 1 << 10;  ///< times the samples: beyond, nobody knows

/// The slope of the last doublings, drawn towards the usual one as far as it is uncertain.
double weighted_slope(const ErrorSlope& measured) {
    const double standard_error = measured.reach / ERRORS_OF_INTERVAL;
    const double measured_variance = standard_error * standard_error + SLOPE_UNREST * SLOPE_UNREST;
    const double usual_variance = USUAL_SLOPE_SPREAD * USUAL_SLOPE_SPREAD;
    return (measured.slope * usual_variance + USUAL_SLOPE * measured_variance) /
           (usual_variance + measured_variance);
}

std::optional<ErrorSlope> recent_slope(const std::vector<SquaredError>& doublings) {
    const size_t count = std::min(doublings.size(), ERRORS_FOR_SLOPE);
    return fit_error_slope({doublings.end() - std::ptrdiff_t(count), doublings.end()});
}

} // namespace

std::optional<ErrorForecast> forecast_error(const std::vector<SquaredError>& doublings,
                                            const SquaredError& present) {
    const SquaredError& last = doublings.empty() ? present : doublings.back();
    const std::optional<FilmError> error = relative_error(last);
    if (!error || !(error->relative_rmse > 0))
        return std::nullopt;
    ErrorForecast forecast{last.samples, error->relative_rmse, USUAL_SLOPE, false};
    if (const std::optional<ErrorSlope> measured = recent_slope(doublings)) {
        forecast.slope = weighted_slope(*measured);
        forecast.measured = true;
    }
    return forecast;
}

double error_at(const ErrorForecast& forecast, std::uint64_t samples, int replicates) {
    const double law =
        forecast.relative_rmse * std::pow(double(samples) / double(forecast.samples), forecast.slope);
    if (is_doubling(samples, replicates))
        return law;
    // Two thirds of 3/2 2^k samples are even among themselves, and so is the third, but not both together. If
    // they were independent, the squared error would be that of their weighted mean; it is halfway between
    // that and the law.
    const double doubling = double(samples) / 1.5;
    const double even =
        forecast.relative_rmse * std::pow(doubling / double(forecast.samples), forecast.slope);
    const double independent = even * std::sqrt(4 + std::exp2(-2 * forecast.slope)) / 3;
    return std::sqrt(law * independent);
}

std::optional<ErrorPrice> price_of_half(const std::vector<SquaredError>& doublings,
                                        const SquaredError& present, int replicates, double seconds) {
    const std::optional<ErrorForecast> forecast = forecast_error(doublings, present);
    const std::optional<FilmError> error = relative_error(present);
    if (!forecast || !error || present.samples == 0)
        return std::nullopt;
    const double most = LARGEST_FACTOR * double(present.samples);
    std::uint64_t samples = present.samples;
    do
        samples = next_good_count(samples, replicates);
    while (error_at(*forecast, samples, replicates) > NEARLY_HALF * error->relative_rmse / 2 &&
           double(samples) < most);
    if (!(double(samples) < most))
        return std::nullopt;
    const double factor = double(samples) / double(present.samples);
    return ErrorPrice{samples,         error_at(*forecast, samples, replicates),
                      factor,          seconds * (factor - 1),
                      forecast->slope, forecast->measured};
}

} // namespace clrt
