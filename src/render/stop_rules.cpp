// SPDX-License-Identifier: Apache-2.0
#include "render/stop_rules.h"

#include "render/good_counts.h"
#include "render/pace.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

/// No integrand's error falls faster than samples to this power while pixels have edges in them.
constexpr double STEEPEST_SLOPE = -1;
/// What a render differs from --time is said from this part of it.
constexpr double WORTH_SAYING = 0.05;

/// Samples after which the options end the render, whatever the film holds.
std::uint64_t samples_of_options(const SamplingOptions& options) {
    if (options.spp)
        return *options.spp;
    if (options.has_target())
        return DEFAULT_SPP_WITH_ERROR;
    return options.time_seconds ? UINT64_MAX : DEFAULT_SPP;
}

} // namespace

const char* stop_rule_name(StopRule rule) {
    switch (rule) {
    case StopRule::SPP:
        return "spp";
    case StopRule::TIME:
        return "time";
    case StopRule::ERROR:
        return "error";
    case StopRule::DENOISED_ERROR:
        return "denoised_error";
    case StopRule::FILM_FULL:
        return "film";
    case StopRule::SIGNAL:
        break;
    }
    return "signal";
}

StopRules::StopRules(const SamplingOptions& options, std::uint64_t film_limit)
    : options_(options), film_limit_(film_limit),
      last_samples_(std::min(samples_of_options(options), film_limit)) {}

std::optional<StopRule> StopRules::ended(const RenderState& state) const {
    if (state.samples == 0)
        return std::nullopt;
    if (state.samples >= FEWEST_OF_A_REPLICATE * std::uint64_t(options_.replicates)) {
        if (reached(state.error))
            return StopRule::ERROR;
        if (state.is_denoised_enough)
            return StopRule::DENOISED_ERROR;
    }
    if (state.samples >= last_samples_)
        return last_samples_ == samples_of_options(options_) ? StopRule::SPP : StopRule::FILM_FULL;
    if (options_.time_seconds &&
        *options_.time_seconds - state.seconds < WORTH_BEGINNING * state.pass_seconds)
        return StopRule::TIME;
    if (state.signal)
        return StopRule::SIGNAL;
    return std::nullopt;
}

std::uint64_t StopRules::next_check(std::uint64_t samples) const {
    return options_.has_target() ? next_good_count(samples, options_.replicates)
                                 : next_doubling(samples, options_.replicates);
}

bool StopRules::is_check(std::uint64_t samples, const std::optional<SquaredError>& last) const {
    if (is_doubling(samples, options_.replicates))
        return true;
    if (!options_.has_target() || !is_good_count(samples, options_.replicates))
        return false;
    if (options_.denoised_error)
        return true;
    const std::optional<FilmError> error = last ? relative_error(*last) : std::nullopt;
    return !error ||
           error->relative_rmse * std::pow(double(samples) / double(last->samples), STEEPEST_SLOPE) <=
               *options_.error;
}

bool StopRules::reached(const std::optional<FilmError>& error) const {
    return options_.error && error && error->relative_rmse <= *options_.error;
}

double StopRules::fraction(double samples, double seconds,
                           const std::optional<std::uint64_t>& expected) const {
    double fraction = samples / double(last_samples_);
    if (options_.time_seconds)
        fraction = std::max(fraction, seconds / *options_.time_seconds);
    if (expected)
        fraction = std::max(fraction, samples / double(*expected));
    return std::min(fraction, 1.0);
}

std::string StopRules::describe_time(const StopMoment& moment) const {
    const double time = *options_.time_seconds, late = moment.seconds - time;
    if (moment.dropped_seconds == 0 && moment.pass_seconds > 0 && -late > WORTH_SAYING * time)
        return fmt::format("another pass takes {:.1f} s, more than --time {:g} s leaves", moment.pass_seconds,
                           time);
    std::string text = fmt::format("--time {:g} s is over", time);
    if (late > WORTH_SAYING * time)
        text += fmt::format(" by {:.1f} s: {}", late,
                            moment.is_first_pass && moment.dropped_seconds == 0
                                ? "the first pass is always finished"
                                : "a launch is never cut short");
    if (moment.dropped_seconds > 0)
        text += fmt::format("; an unfinished pass was dropped ({:.1f} s)", moment.dropped_seconds);
    return text;
}

std::string StopRules::describe(StopRule rule, const StopMoment& moment) const {
    switch (rule) {
    case StopRule::SPP:
        if (moment.samples > last_samples_) // only a resumed film has more
            return fmt::format("the film has {} spp already, more than {} {}: nothing was left to render",
                               moment.samples, options_.spp ? "--spp" : "the default of", last_samples_);
        if (options_.spp)
            return fmt::format("--spp {} is complete", *options_.spp);
        return fmt::format("the default of {} spp is complete", last_samples_);
    case StopRule::TIME:
        return describe_time(moment);
    case StopRule::ERROR:
        return fmt::format("--error {:g} % is reached", 100 * *options_.error);
    case StopRule::DENOISED_ERROR:
        return fmt::format("--denoised-error {:g} % is reached", 100 * *options_.denoised_error);
    case StopRule::FILM_FULL:
        return fmt::format("the film is full with {} samples a pixel; more --replicates hold more",
                           film_limit_);
    case StopRule::SIGNAL:
        break;
    }
    return "a signal came";
}

} // namespace clrt
