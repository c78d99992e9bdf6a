// SPDX-License-Identifier: Apache-2.0
#include "render/outlook.h"

#include "render/good_counts.h"

#include <algorithm>

namespace clrt {

void note_error(Measurements& measurements, Render& render, const SamplingOptions& sampling,
                std::uint64_t samples, double seconds) {
    if (!measurements.error())
        return;
    const bool is_even = is_doubling(samples, sampling.replicates);
    if (is_even && (render.history.empty() || render.history.back().samples < samples))
        render.history.push_back(*measurements.error());
    measurements.forecast(render.history, sampling.replicates, sampling.error);
    const std::optional<ErrorPrice>& price = measurements.price();
    if (!price || !is_even || render.passes == 0)
        return;
    const double pace = seconds / double(render.passes);
    render.forecasts.push_back({samples, seconds, *price});
    ErrorPrice& noted = render.forecasts.back().price;
    noted.seconds *= pace;
    noted.low_seconds *= pace;
    if (noted.high_seconds)
        *noted.high_seconds *= pace;
}

std::optional<std::uint64_t> expected_samples(const Measurements& measurements) {
    return measurements.price() ? std::optional(measurements.price()->samples) : std::nullopt;
}

std::optional<ProgressTarget> progress_target(const Measurements& measurements,
                                              const SamplingOptions& sampling, double samples, double of_run,
                                              double seconds) {
    const std::optional<ErrorPrice>& price = measurements.price();
    if (!price || !(of_run > 0))
        return std::nullopt;
    const auto seconds_to = [&](std::uint64_t count) {
        return std::max(double(count) - samples, 0.0) * seconds / of_run;
    };
    return ProgressTarget{*sampling.error, seconds_to(price->samples),
                          seconds_to(price->low_samples) / PACE_SPREAD,
                          price->high_samples ? seconds_to(*price->high_samples) * PACE_SPREAD : -1};
}

} // namespace clrt
