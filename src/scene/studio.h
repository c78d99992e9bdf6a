// SPDX-License-Identifier: Apache-2.0
// The light of scenes that bring none, as a photographer would set it: a soft key light from above one side
// of the camera, an even sky that fills its shadows, and a grey backdrop that runs into a matte ground. All
// of it are options that could have been given, with these very values: the same picture follows to the last
// bit.
#pragma once

#include "options/light_options.h"
#include "scene/notices.h"
#include "scene/scene.h"

namespace clrt {

/// The options' light with the studio's parts wherever they name no ground and no background of their own.
///
/// Around a thing: key, sky, ground and backdrop. There is no ground under a transparent background, below a
/// camera that looks from under it, and where there is no triangle. The backdrop is the radiance that the
/// ground has where nothing shades it, albedo (E cos / pi + L): so they meet without a horizon.
///
/// In a room, which is one by its walls (box_cover.h) or because the camera sees surfaces all around, walls
/// would block the key: a white sky shines in where it is open, and a camera inside has a point light in the
/// middle of what it sees, as bright as the free way around that asks for. It has no ground and no backdrop.
///
/// `scene` has its geometry, normalisation and camera; `up` is its up, of any length but 0. A notice says
/// what is set up, as flags to copy.
LightOptions studio_light(const LightOptions& given, const Scene& scene, const glm::dvec3& up,
                          NoticeList& notices);

} // namespace clrt
