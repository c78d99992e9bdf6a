// SPDX-License-Identifier: Apache-2.0
// A small picture by an integrator that has path's techniques and more: what its noise is, and what that of
// path would be (kernels/film/moments.h). Where path is connected to lamps through slabs, the integrator's
// includes that of light which hits alone find there.
#pragma once

#include "film/film.h"
#include "film/render_progress.h"
#include "render/pilot_size.h"
#include "render/prepared_scene.h"

#include <array>
#include <cmath>

namespace clrt {

/// Squared errors of one sample a pixel, by ErrorMeasure: the mean over pixels and channels of the variance.
using SquaredErrors = std::array<double, 2>;

/// That by which pilots are compared: the relative one, or that which --error judges by or --adaptive names.
double deciding_error(const SquaredErrors& errors, const Options& options);

/// What a pilot of path has found out, a sample a pixel.
struct PathPilot {
    SquaredErrors errors{}; ///< infinite: no light was found
    double rays = 0;
    double trimmed = HUGE_VAL; ///< the relative one without the noisiest pixels (trimmed_sample_error)
    double mean = 0;           ///< radiance, over the pixels that show the scene; 0: not known
};

/// What a pilot has found out, a sample a pixel.
struct PilotResult {
    SquaredErrors own{}, path{}; ///< of the integrator, and of path
    double eye_rays = 0;         ///< of paths from the eye, and from them to lights: path has as many
    double light_rays = 0;       ///< of paths from the lights, and from them to the camera
    double inner_rays = 0;       ///< between both
    double light_paths = 0;
    double trimmed = 0;    ///< relative squared error of the integrator without its noisiest pixels
    double mean = 0;       ///< radiance, likewise
    bool is_black = false; ///< no light was found: there are no errors
};

/// The same of path, or of path+light where the scene is prepared for that, with its programs. As independent
/// of the rest as run_pilot, and throws the same. `reuses_paths`: the programs do so if they can; else none
/// does, whatever the plan says.
PathPilot run_path_pilot(const PreparedScene& prepared, const PilotSize& size, bool reuses_paths = false);

/// What a guide has learnt, and what its samples tell of it (render/guiding.h), by a pilot that is guided as
/// the picture is to be; `error` is that of unguided samples. The picture begins with it. As independent of
/// the rest as run_pilot, and throws the same.
GuideProgress run_guide_pilot(const PreparedScene& prepared, const PilotSize& size, double error);

/// The relative squared error of a sample of path alone.
double path_pilot_error(const PreparedScene& prepared, const PilotSize& size);

/// Renders it with a program of its own; a signal stops it, and the result is then worth nothing. The scene
/// is prepared for path+light or bdpt, with or without programs. The same for every seed and range of samples
/// of the picture, and with any number of threads. Throws DeviceError and KernelBuildError.
PilotResult run_pilot(const PreparedScene& prepared, const PilotSize& size);

} // namespace clrt
