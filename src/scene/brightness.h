// SPDX-License-Identifier: Apache-2.0
// How bright a scene can be at most: what bounds the light that a render leaves out.
#pragma once

#include "scene/scene.h"

#include <optional>

namespace clrt {

/// The largest share of arriving light that a used material scatters, over its maps, channels and directions;
/// 1 for dielectrics and wherever Fresnel's or Schlick's reflectance goes to 1 at grazing angles.
double largest_albedo(const Scene& scene);

/// The largest radiance component that a ray can meet where it ends: of emissive triangles, or of the sky
/// with the discs of all suns before it; of the kinds of light (KIND_*) alone.
double largest_radiance(const Scene& scene, unsigned kinds);

/// The largest irradiance component by lights that no ray can meet, at normal incidence: suns without a disc,
/// and points over the squared distance to the nearest triangle. None where a point lies on one.
std::optional<double> largest_delta_irradiance(const Scene& scene, unsigned kinds);

} // namespace clrt
