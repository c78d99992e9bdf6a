// SPDX-License-Identifier: Apache-2.0
// Everything a user can ask for, by subject. Filled by app/command_line.h; a stage takes the groups that it
// needs.
#pragma once

#include "options/bvh_options.h"
#include "options/camera_options.h"
#include "options/denoise_options.h"
#include "options/device_options.h"
#include "options/effect_options.h"
#include "options/film_file_options.h"
#include "options/film_options.h"
#include "options/light_options.h"
#include "options/output_options.h"
#include "options/run_options.h"
#include "options/sampling_options.h"
#include "options/scene_options.h"
#include "options/transport_options.h"
#include "options/view_options.h"

namespace clrt {

struct Options {
    RunOptions run;
    SceneOptions scene;
    CameraOptions camera;
    LightOptions light;
    EffectOptions effects;
    TransportOptions transport;
    SamplingOptions sampling;
    FilmOptions film;
    FilmFileOptions film_file;
    OutputOptions output;
    ViewOptions view;
    DenoiseOptions denoise;
    DeviceOptions device;
    BvhOptions bvh;
};

/// Whether tiles get samples of their own, as --adaptive asks. Light paths reach all tiles at once, so that an
/// integrator with them, which pilots may have chosen, takes samples evenly.
bool is_adaptive(const Options& options);

} // namespace clrt
