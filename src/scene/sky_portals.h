// SPDX-License-Identifier: Apache-2.0
// Windows, doors and skylights, found by the ways that paths take out of a scene. No OpenCL here.
#pragma once

#include "kernels/shared/escape_types.h"
#include "scene/scene.h"

#include <glm/mat3x3.hpp>
#include <vector>

namespace clrt {

/// Portals at most: every vertex weighs all of them.
constexpr size_t MOST_PORTALS = 12;

/// Axes that most of a scene's surfaces face along or against, as columns: those of the frame, turned about
/// the one that most of them face.
glm::dmat3 scene_axes(const Scene& scene);

/// Rectangles, each in a plane across one of `axes`, through which most of these paths have left the scene;
/// none where the sky is seen from nearly everywhere, or where too few paths have left it. In the frame of
/// the escapes.
///
/// Of planes at many places the one comes first through which many paths pass close together, and so on with
/// the paths that are left. In a plane, points with a wide gap between them belong to two rectangles.
std::vector<SkyPortal> find_portals(const std::vector<Escape>& escapes, const glm::dmat3& axes);

/// What portals let in, as the paths tell that have left the scene, or not, but for the sun, which few meet.
/// Ways from surfaces that see much of the sky do not count.
SkyThroughPortals light_through(const std::vector<SkyPortal>& portals, const std::vector<Escape>& escapes);

} // namespace clrt
