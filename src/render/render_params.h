// SPDX-License-Identifier: Apache-2.0
// Scene and options -> the constants of a launch.
#pragma once

#include "film/film.h"
#include "kernels/shared/render_types.h"
#include "options/options.h"
#include "paths/path_plan.h"
#include "scene/scene.h"

namespace clrt {

/// The window of pixels that the options ask for: the crop, or the whole picture.
Crop render_window(const FilmOptions& film);

/// Whether connections to light from outside go through slabs of glass (kernels/path/slab.h): the scene has
/// some, the integrator can, and neither --paths nor layers tell paths apart, whose letters they would skip.
bool crosses_slabs(const Scene& scene, const Options& options);

/// How many light samples a path takes at its first vertex (kernels/path/light_samples.h): one, whatever the
/// options say, where no tree chooses lights, and by other integrators than path.
int light_samples(const Scene& scene, const Options& options);

/// Everything but the samples and tiles of a single launch, which are 0.
RenderParams make_render_params(const Scene& scene, const Options& options, const FilmScale& scale);

/// Leaves lights that end no accepted path out of next-event estimation, and ends paths that are as long as
/// the longest that is accepted.
void restrict_to_paths(const PathPlan& paths, RenderParams& params);

} // namespace clrt
