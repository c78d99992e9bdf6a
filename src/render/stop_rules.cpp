// SPDX-License-Identifier: Apache-2.0
#include "render/stop_rules.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

/// The first measurement that may end a render: two samples in every replicate, so that the spread is not
/// that of single samples.
constexpr std::uint64_t FEWEST_OF_A_REPLICATE = 2;

/// Samples after which the options end the render, whatever the film holds.
std::uint64_t samples_of_options(const Options& options) {
    if (options.spp)
        return *options.spp;
    if (options.error)
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
    case StopRule::FILM_FULL:
        return "film";
    case StopRule::SIGNAL:
        break;
    }
    return "signal";
}

StopRules::StopRules(const Options& options, std::uint64_t film_limit)
    : options_(options), film_limit_(film_limit),
      last_samples_(std::min(samples_of_options(options), film_limit)) {}

std::optional<StopRule> StopRules::ended(const RenderState& state) const {
    if (state.samples == 0)
        return std::nullopt;
    if (state.samples >= FEWEST_OF_A_REPLICATE * std::uint64_t(options_.replicates) && reached(state.error))
        return StopRule::ERROR;
    if (state.samples >= last_samples_)
        return last_samples_ == samples_of_options(options_) ? StopRule::SPP : StopRule::FILM_FULL;
    if (options_.time_seconds && *options_.time_seconds - state.seconds < 0.5 * state.pass_seconds)
        return StopRule::TIME;
    if (state.signal)
        return StopRule::SIGNAL;
    return std::nullopt;
}

std::uint64_t StopRules::next_check(std::uint64_t samples) const {
    std::uint64_t check = std::uint64_t(options_.replicates);
    while (check <= samples)
        check *= 2;
    return check;
}

bool StopRules::is_check(std::uint64_t samples) const {
    return samples > 0 && next_check(samples - 1) == samples;
}

bool StopRules::reached(const std::optional<FilmError>& error) const {
    return options_.error && error && error->relative_rmse <= *options_.error;
}

double StopRules::fraction(double samples, double seconds, const std::optional<SquaredError>& check) const {
    double fraction = samples / double(last_samples_);
    if (options_.time_seconds)
        fraction = std::max(fraction, seconds / *options_.time_seconds);
    // Independent samples would reach the target after this many, at the next doubling.
    const std::optional<FilmError> error = check ? relative_error(*check) : std::nullopt;
    if (options_.error && *options_.error > 0 && error) {
        const double doublings = std::ceil(2 * std::log2(error->relative_rmse / *options_.error));
        fraction =
            std::max(fraction, samples / (double(check->samples) * std::exp2(std::max(doublings, 1.0))));
    }
    return std::min(fraction, 1.0);
}

std::string StopRules::describe(StopRule rule, std::uint64_t samples) const {
    switch (rule) {
    case StopRule::SPP:
        if (samples > last_samples_) // only a resumed film has more
            return fmt::format("the film has {} spp already, more than {} {}: nothing was left to render",
                               samples, options_.spp ? "--spp" : "the default of", last_samples_);
        if (options_.spp)
            return fmt::format("--spp {} is complete", *options_.spp);
        return fmt::format("the default of {} spp is complete", last_samples_);
    case StopRule::TIME:
        return fmt::format("--time {:g} s is over", *options_.time_seconds);
    case StopRule::ERROR:
        return fmt::format("--error {:g} % is reached", 100 * *options_.error);
    case StopRule::FILM_FULL:
        return fmt::format("the film is full with {} samples a pixel; more --replicates hold more",
                           film_limit_);
    case StopRule::SIGNAL:
        break;
    }
    return "a signal came";
}

} // namespace clrt
