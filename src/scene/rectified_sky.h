// SPDX-License-Identifier: Apache-2.0
// The sky as it is seen through portals, summed up for light sampling.
#pragma once

#include "scene/scene.h"

namespace clrt {

/// Makes the sums by which directions through portals are sampled (kernels/lights/rectified_sky.h): a map of
/// the light, luminance times solid angle, for each direction that portals face. Texels have whole units of
/// it, one at least, and less than 2^32 in all. Sets `portal_sums` and, of each portal, where its map begins
/// and the light of a unit; the map's factor is left out. A constant sky needs no sums, and has a unit of 1.
void rectify_sky(Environment& sky);

} // namespace clrt
