// SPDX-License-Identifier: Apache-2.0
// Scenes far from the origin, as map coordinates make them: what cannot be precise there is said.
#pragma once

#include "options/options.h"
#include "scene/normalise.h"
#include "scene/notices.h"
#include "scene/readers/obj_reader.h"
#include "scene/scene.h"

#include <string>

namespace clrt {

/// Notes an axis along which digits end early: all coordinates are multiples of a step that is coarse beside
/// the scene and no finer than single precision there (the writer had floats, or wrote too few digits), or
/// that of doubles.
void note_coarse_digits(const ObjMesh& mesh, const Bounds& bounds, const std::string& obj_path,
                        NoticeList& notices);

/// Notes that layer P is relative to position_origin(), where it is and an EXR is asked for.
void note_relative_positions(const Normalisation& frame, const Options& options, NoticeList& notices);

/// Notes a camera in whose picture the scene covers less than a pixel or cannot lie, and point lights more
/// than FAR_LIGHT times the scene's radius away: options that were given in other coordinates than the
/// file's.
void note_far_options(const Camera& camera, const Bounds& bounds, const Options& options,
                      NoticeList& notices);

/// From here on a point light differs from a sun by less than a thousandth across the scene.
constexpr double FAR_LIGHT = 1000;

} // namespace clrt
