// SPDX-License-Identifier: Apache-2.0
#include "render/error_price.h"

#include "film/error_slope.h"
#include "render/good_counts.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

constexpr double USUAL_SLOPE = -0.55,
                 USUAL_SLOPE_SPREAD = 0.13;    ///< of renders in general, one standard deviation
constexpr double SLOPE_UNREST = 0.08;          ///< standard deviation from octave to octave
constexpr size_t ERRORS_FOR_SLOPE = 5;         ///< the last four octaves
constexpr double ERRORS_OF_INTERVAL = 2;       ///< half a 95 % interval is about two standard errors
constexpr double NEARLY_HALF = 1.05;           ///< of half the error: no promise is more exact
constexpr double LARGEST_FACTOR = 1 << 10;     ///< times the samples: beyond, nobody knows
constexpr double FORECAST_QUANTILE = 1.281552; ///< of a normal number: 80 % are nearer than that

/// Takes the slope of the last doublings, drawn towards the usual one as far as it is uncertain.
void weigh_slope(const ErrorSlope& measured, ErrorForecast& forecast) {
    const double standard_error = measured.reach / ERRORS_OF_INTERVAL;
    const double measured_variance = standard_error * standard_error + SLOPE_UNREST * SLOPE_UNREST;
    const double usual_variance = USUAL_SLOPE_SPREAD * USUAL_SLOPE_SPREAD;
    const double sum = usual_variance + measured_variance;
    forecast.slope = (measured.slope * usual_variance + USUAL_SLOPE * measured_variance) / sum;
    forecast.slope_deviation = std::sqrt(usual_variance * measured_variance / sum);
    forecast.measured = true;
}

/// Standard deviation of the logarithm of an estimated error (FilmError tells its distribution). An error
/// that rests on few bright samples falls when others come.
double error_deviation(const SquaredError& error) {
    if (!(error.degrees > 0))
        return 0;
    return std::sqrt(0.5 / (error.degrees * double(error.without.size() - 1)));
}

/// The smallest good count above `present` at which the error is `target` or less, if it comes out `off`
/// standard deviations above the forecast; none if there are too many.
std::optional<std::uint64_t> samples_for(double target, const ErrorForecast& forecast, std::uint64_t present,
                                         int replicates, double off) {
    const double most = LARGEST_FACTOR * double(present);
    for (std::uint64_t samples = next_good_count(present, replicates); double(samples) < most;
         samples = next_good_count(samples, replicates)) {
        const double by_slope =
            forecast.slope_deviation * std::log(double(samples) / double(forecast.samples));
        const double deviation = std::hypot(by_slope, forecast.error_deviation);
        if (error_at(forecast, samples, replicates) * std::exp(off * deviation) <= target)
            return samples;
    }
    return std::nullopt;
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
    ErrorForecast forecast{last.samples, error->relative_rmse, USUAL_SLOPE,
                           false,        USUAL_SLOPE_SPREAD,   error_deviation(last)};
    if (const std::optional<ErrorSlope> measured = recent_slope(doublings))
        weigh_slope(*measured, forecast);
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

std::optional<ErrorPrice> price_of_error(double target, const std::vector<SquaredError>& doublings,
                                         const SquaredError& present, int replicates, double seconds) {
    const std::optional<ErrorForecast> forecast = forecast_error(doublings, present);
    if (!forecast || present.samples == 0)
        return std::nullopt;
    const auto samples_if = [&](double off) {
        return samples_for(target, *forecast, present.samples, replicates, off);
    };
    const std::optional<std::uint64_t> samples = samples_if(0);
    if (!samples)
        return std::nullopt;
    const auto factor = [&](std::uint64_t count) { return double(count) / double(present.samples); };
    ErrorPrice price{*samples,         error_at(*forecast, *samples, replicates),
                     factor(*samples), seconds * (factor(*samples) - 1),
                     forecast->slope,  forecast->measured};
    price.low_samples = samples_if(-FORECAST_QUANTILE).value_or(*samples);
    price.low_seconds = seconds * (factor(price.low_samples) - 1);
    if ((price.high_samples = samples_if(FORECAST_QUANTILE)))
        price.high_seconds = seconds * (factor(*price.high_samples) - 1);
    return price;
}

std::optional<ErrorPrice> price_of_half(const std::vector<SquaredError>& doublings,
                                        const SquaredError& present, int replicates, double seconds) {
    const std::optional<FilmError> error = relative_error(present);
    if (!error)
        return std::nullopt;
    return price_of_error(NEARLY_HALF * error->relative_rmse / 2, doublings, present, replicates, seconds);
}

} // namespace clrt
