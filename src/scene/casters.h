// SPDX-License-Identifier: Apache-2.0
// Surfaces at which emission is aimed (kernels/lights/emission_aim.h): those that may scatter by a delta
// lobe, or reflect almost as sharply, where caustics begin.
#pragma once

#include "scene/scene.h"

#include <vector>

namespace clrt {

/// True if the material scatters by a delta lobe at some point.
bool is_smooth(const Material& material);

/// True if the material scatters by a delta lobe at some point, or reflects by an alpha of at most
/// CASTER_LARGEST_ALPHA everywhere. Light is not aimed at what a map makes sharp here and there.
bool is_caster(const Material& material);

/// Whether the scene has any: as good as whether find_casters finds spheres, at once.
bool has_casters(const Scene& scene);

/// Spheres in the normalised frame that hold all triangles of such materials wherever they move, at most
/// LARGEST_CASTER_COUNT: more than one where together they are so much smaller that emission that is aimed at
/// them hits more. x, y, z: centre; w: radius (CASTER_RADIUS).
std::vector<vec4> find_casters(const Scene& scene);

/// Each light path looks at all of them.
constexpr int LARGEST_CASTER_COUNT = 32;

/// Sum of the squared radii: parallel rays are aimed at pi times this area.
double caster_squares(const std::vector<vec4>& casters);

/// Solid angles of the spheres as seen from a point, summed; each at most `largest`.
double caster_solid_angle(const std::vector<vec4>& casters, const glm::dvec3& point, double largest);

} // namespace clrt
