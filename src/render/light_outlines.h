// SPDX-License-Identifier: Apache-2.0
// The pixels in which the camera may see the outline of a light, by itself or in mirrors and smooth glass:
// where emission comes from camera rays of its own, if these find that it varies
// (kernels/integrators/emission_rays.h).
#pragma once

#include "kernels/shared/render_types.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace clrt {

/// EMISSION_* of the pixels of the window, row by row: EMISSION_OPEN within the rectangles around all
/// emissive triangles, which never move, as the camera projects them, whether or not something is in front of
/// them. EMISSION_SMALL besides where such a rectangle is small. Where few pixels may see smooth surfaces
/// that stand still, EMISSION_GOES_ON in these, too: images of lights in curved mirrors are small. Empty
/// where all emission comes from paths: without emissive triangles, for panoramic cameras and those that
/// move, and where `params` asks for one ray or none.
std::vector<std::uint8_t> find_light_outlines(const Scene& scene, const RenderParams& params);

} // namespace clrt
