// SPDX-License-Identifier: Apache-2.0
// Which samples are taken, and what ends a render.
#pragma once

#include "options/names.h"

#include <cstdint>
#include <optional>

namespace clrt {

enum class SamplerChoice { SOBOL, INDEPENDENT };

template <>
inline constexpr Named<SamplerChoice> NAMES<SamplerChoice>[] = {{SamplerChoice::SOBOL, "sobol"},
                                                                {SamplerChoice::INDEPENDENT, "independent"}};

/// What a picture's squared error is divided by (film/error_measure.h).
enum class ErrorMeasure {
    MSE,     ///< the picture's mean, squared: bright pixels decide
    RELATIVE ///< what shines there, squared: dark ones count as much
};

template <>
inline constexpr Named<ErrorMeasure> NAMES<ErrorMeasure>[] = {{ErrorMeasure::MSE, "mse"},
                                                              {ErrorMeasure::RELATIVE, "relative"}};

inline ErrorMeasure other_measure(ErrorMeasure measure) {
    return measure == ErrorMeasure::MSE ? ErrorMeasure::RELATIVE : ErrorMeasure::MSE;
}

/// Samples a pixel when none of --spp, --time, --error and --denoised-error is given.
constexpr std::uint32_t DEFAULT_SPP = 64;
/// Samples a pixel at most when --error or --denoised-error is given without --spp.
constexpr std::uint32_t DEFAULT_SPP_WITH_ERROR = 65536;

/// How next-event estimation chooses among the lights (scene/light_tables.h, scene/light_tree.h).
enum class LightSampler { POWER, MIXTURE, TREE };

template <>
inline constexpr Named<LightSampler> NAMES<LightSampler>[] = {
    {LightSampler::POWER, "power"}, {LightSampler::MIXTURE, "mixture"}, {LightSampler::TREE, "tree"}};

struct SamplingOptions {
    std::optional<std::uint32_t> spp;     ///< else 64 without a time or a target, 65536 with a target alone
    std::optional<double> time_seconds;   ///< bounds the render stage of this run
    std::optional<double> error;          ///< target of the error, by measure()
    std::optional<double> denoised_error; ///< target of the denoised picture's; not both
    std::uint32_t seed = 0;
    std::uint32_t first_sample = 0;
    int replicates = 4;
    std::optional<ErrorMeasure> adaptive; ///< samples are to make this error least (is_adaptive)
    SamplerChoice sampler = SamplerChoice::SOBOL;
    LightSampler light_sampler = LightSampler::TREE;
    /// The error that reports name first and --error judges by.
    ErrorMeasure measure() const { return adaptive.value_or(ErrorMeasure::MSE); }
    bool has_target() const { return error || denoised_error; }
};

} // namespace clrt
