// SPDX-License-Identifier: Apache-2.0
// When a render ends: --spp, --time, --error, --denoised-error, a full film or a signal, whichever comes
// first. No OpenCL here.
#pragma once

#include "film/film_error.h"
#include "options/sampling_options.h"

#include <cstdint>
#include <optional>
#include <string>

namespace clrt {

enum class StopRule { SPP, TIME, ERROR, DENOISED_ERROR, FILM_FULL, SIGNAL };

/// Its name in the JSON: "spp", "time", "error", "denoised_error", "film", "signal".
const char* stop_rule_name(StopRule rule);

/// How far a render is.
struct RenderState {
    std::uint64_t samples = 0;       ///< a pixel, those of earlier runs included
    double seconds = 0;              ///< of this run's render stage
    double pass_seconds = 0;         ///< of one more pass; 0: not known yet
    std::optional<FilmError> error;  ///< as measured at `samples`; none between measurements
    bool is_denoised_enough = false; ///< --denoised-error is reached, as looked at at `samples`
    int signal = 0;                  ///< that came, or 0
};

/// How a render ended.
struct StopMoment {
    std::uint64_t samples = 0;  ///< a pixel, those of earlier runs included
    double seconds = 0;         ///< of this run's render stage
    double pass_seconds = 0;    ///< of one pass
    bool is_first_pass = false; ///< the picture has one pass
    double dropped_seconds = 0; ///< of a pass that was not finished
};

/// The first measurement that may end a render, or that anything is forecast from: two samples in every
/// replicate, so that the spread is not that of single samples.
constexpr std::uint64_t FEWEST_OF_A_REPLICATE = 2;

/// The rules of one render. --error is looked at where the samples are even (good_counts.h): looking after
/// every pass would end renders where the estimate happens to be low and so bias the printed error.
class StopRules {
public:
    /// `film_limit`: samples a pixel that the film can hold.
    StopRules(const SamplingOptions& options, std::uint64_t film_limit);

    /// The rule that ends the render now; none: go on. At least one pass is always completed.
    std::optional<StopRule> ended(const RenderState& state) const;

    /// Samples a pixel after which the render ends in any case.
    std::uint64_t last_samples() const { return last_samples_; }
    /// The next number of samples above `samples` at which an error may be measured: a doubling, with a
    /// target any good count.
    std::uint64_t next_check(std::uint64_t samples) const;
    /// Whether the error is measured at this number of samples for a target, `last` being the last
    /// measurement. Between doublings with --error only if it may have come down to the target since.
    bool is_check(std::uint64_t samples, const std::optional<SquaredError>& last) const;
    /// Whether this error satisfies --error.
    bool reached(const std::optional<FilmError>& error) const;

    /// Progress in [0, 1] by the limit that is nearest; --error is forecast to be reached at `expected`
    /// samples a pixel, if that is known.
    double fraction(double samples, double seconds, const std::optional<std::uint64_t>& expected) const;
    /// What ended the render, for the log and the report: "--spp 64 is complete".
    std::string describe(StopRule rule, const StopMoment& moment = {}) const;

private:
    std::string describe_time(const StopMoment& moment) const;

    const SamplingOptions& options_;
    std::uint64_t film_limit_, last_samples_;
};

} // namespace clrt
