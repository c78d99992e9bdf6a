// SPDX-License-Identifier: Apache-2.0
// The loop of launches that fills the film.
#pragma once

#include "app/progress.h"
#include "render/film.h"
#include "render/kernels.h"
#include "render/scene_buffers.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace clrt {

/// Counts of a run (kernels/shared/render_types.h).
struct RenderCounts {
    std::uint64_t primary = 0, secondary = 0, shadow = 0; ///< rays
    std::uint32_t nan = 0, infinite = 0, negative = 0, overflow = 0;
    /// Addresses of the first bad samples: pixel (y width + x of the whole picture) and sample.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> bad_samples;
    std::uint32_t bad() const { return nan + infinite + negative + overflow; }
    std::uint64_t rays() const { return primary + secondary + shadow; }
};

/// Sums over the primary hits of a pixel (AOV_FLOATS in kernels/integrators/aov.cl), empty if not asked for.
using HitLayers = std::vector<float>;
constexpr int HIT_LAYER_FLOATS = 13;

/// What a render gives.
struct Render {
    Film film;
    RenderCounts counts;
    HitLayers layers;
    std::uint32_t layer_samples = 0;
    std::vector<Film> path_layers; ///< light of each layer NAME=EXPR in one replicate
    std::uint64_t passes = 0;        ///< samples a pixel in this run
    double first_launch_seconds = 0; ///< what the driver still compiles at the first launch
    double seconds = 0;              ///< of all launches, first_launch_seconds not included
    int stop_signal = 0;             ///< the signal that ended it early, or 0
};

/// Renders until the samples, the time or a signal end it; always ends at a whole pass (one sample a pixel).
/// Throws DeviceError, and UsageError for more samples than the film can hold.
Render render(const Device& device, const RenderPrograms& programs, const SceneBuffers& buffers, const Scene& scene,
              const Options& options, Progress& progress);

/// A render without a launch: the black picture of a scene in which no path is accepted.
Render render_nothing(const Scene& scene, const Options& options);

} // namespace clrt
