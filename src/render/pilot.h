// SPDX-License-Identifier: Apache-2.0
// A small picture by an integrator that has path's techniques and more: what its noise is, and what that of
// path would be (kernels/film/moments.h).
#pragma once

#include "film/film.h"
#include "film/render_progress.h"
#include "render/prepared_scene.h"

#include <array>
#include <cstdint>
#include <optional>

namespace clrt {

/// Size of a pilot's picture, and samples a pixel.
struct PilotSize {
    int width = 0, height = 0;
    std::uint32_t spp = 0;
    std::uint64_t samples() const { return std::uint64_t(width) * std::uint64_t(height) * spp; }
};

/// Squared errors of one sample a pixel, by ErrorMeasure: the mean over pixels and channels of the variance.
using SquaredErrors = std::array<double, 2>;

/// What a pilot has found out, a sample a pixel.
struct PilotResult {
    SquaredErrors own{}, path{}; ///< of the integrator, and of path
    double eye_rays = 0;         ///< of paths from the eye, and from them to lights: path has as many
    double light_rays = 0;       ///< of paths from the lights, and from them to the camera
    double inner_rays = 0;       ///< between both
    double light_paths = 0;
    bool is_black = false; ///< no light was found: there are no errors
};

/// Size of the pilots that compare ways to sample the sky; none for frames that are not worth one. Nets of
/// eight samples, and pixels that are not too large, whose own contents would count as noise of all ways.
std::optional<PilotSize> sky_pilot_size(const Options& options);

/// The relative squared error of one sample a pixel by path, which the scene is prepared for with its
/// programs, in a picture of the pilot's size; infinite where it finds no light. As independent of the rest
/// as run_pilot, and throws the same.
double path_pilot_error(const PreparedScene& prepared, const PilotSize& size);

/// Renders it with a program of its own; a signal stops it, and the result is then worth nothing. The scene
/// is prepared for path+light or bdpt, with or without programs. The same for every seed and range of samples
/// of the picture, and with any number of threads. Throws DeviceError and KernelBuildError.
PilotResult run_pilot(const PreparedScene& prepared, const PilotSize& size);

} // namespace clrt
