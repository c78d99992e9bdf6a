// SPDX-License-Identifier: Apache-2.0
// What the errors of a render so far let expect of --error.
#pragma once

#include "console/progress.h"
#include "options/sampling_options.h"
#include "render/measurements.h"

#include <cstdint>
#include <optional>

namespace clrt {

/// Keeps the error that was just measured, `samples` a pixel and `seconds` after the start, in the history of
/// the render where it belongs there, and forecasts.
void note_error(Measurements& measurements, Render& render, const SamplingOptions& sampling,
                std::uint64_t samples, double seconds);

/// The samples a pixel at which --error is forecast to be reached; none: not known, or no target.
std::optional<std::uint64_t> expected_samples(const Measurements& measurements);

/// When a render at `samples` a pixel, `of_run` of them taken in `seconds` of this run, will have come to
/// --error at this pace.
std::optional<ProgressTarget> progress_target(const Measurements& measurements,
                                              const SamplingOptions& sampling, double samples, double of_run,
                                              double seconds);

} // namespace clrt
