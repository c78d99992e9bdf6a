// SPDX-License-Identifier: Apache-2.0
// What light paths alone do not find on coarse meshes with corner normals. Paths from the eye shade such
// facets as the curved surface that they stand for (kernels/geometry/surface.h): they are lit from below
// their planes, up to where the curved surface turns away. A light path meets another facet there.
#pragma once

#include "options/integrators.h"
#include "paths/blind_spots.h"
#include "scene/scene.h"

#include <optional>

namespace clrt {

/// That light, where the integrator has nothing but light paths and some facet is rounded. Pure.
std::optional<BlindSpot> find_rounded_facets(const Scene& scene, Integrator integrator);

} // namespace clrt
