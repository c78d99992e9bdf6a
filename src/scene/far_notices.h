// SPDX-License-Identifier: Apache-2.0
// Scenes far from the origin, as map coordinates make them: what cannot be precise there is said.
#pragma once

#include "options/light_options.h"
#include "scene/mesh.h"
#include "scene/normalise.h"
#include "scene/notices.h"
#include "scene/scene.h"

#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace clrt {

/// Notes an axis along which digits end early: all coordinates are multiples of a step that is coarse beside
/// the scene and no finer than single precision there (the writer had floats, or wrote too few digits), or
/// that of doubles.
void note_coarse_digits(const Mesh& mesh, const Bounds& bounds, const std::string& path, NoticeList& notices);

/// Notes that layer P is relative to position_origin(), where it is.
void note_relative_positions(const Normalisation& frame, NoticeList& notices);

/// Notes a camera in whose picture the scene covers less than a pixel or cannot lie, and point lights more
/// than FAR_LIGHT times the scene's radius away: options that were given in other coordinates than the
/// file's.
void note_far_options(const Camera& camera, glm::ivec2 size, const std::vector<PointOptions>& points,
                      const Bounds& bounds, NoticeList& notices);

/// From here on a point light differs from a sun by less than a thousandth across the scene.
constexpr double FAR_LIGHT = 1000;

} // namespace clrt
