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

/// Samples a pixel when none of --spp, --time and --error is given.
constexpr std::uint32_t DEFAULT_SPP = 64;
/// Samples a pixel at most when --error is given without --spp.
constexpr std::uint32_t DEFAULT_SPP_WITH_ERROR = 65536;

/// How next-event estimation chooses among the lights (scene/light_tables.h, scene/light_tree.h).
enum class LightSampler { POWER, MIXTURE, TREE };

template <>
inline constexpr Named<LightSampler> NAMES<LightSampler>[] = {
    {LightSampler::POWER, "power"}, {LightSampler::MIXTURE, "mixture"}, {LightSampler::TREE, "tree"}};

struct SamplingOptions {
    std::optional<std::uint32_t> spp; ///< 64 if none of spp, time and error is given; 65536 with error alone
    std::optional<double> time_seconds; ///< bounds the render stage of this run
    std::optional<double> error;        ///< target of the relative error
    std::uint32_t seed = 0;
    std::uint32_t first_sample = 0;
    int replicates = 8;
    bool adaptive = false; ///< samples go where the picture is noisy
    SamplerChoice sampler = SamplerChoice::SOBOL;
    LightSampler light_sampler = LightSampler::TREE;
};

} // namespace clrt
