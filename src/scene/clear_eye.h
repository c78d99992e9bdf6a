// SPDX-License-Identifier: Apache-2.0
// An eye that does not lie on a surface.
#pragma once

#include "scene/notices.h"
#include "scene/scene.h"

namespace clrt {

/// Moves the scene's eye off the triangles that it lies on, with a notice: rays that start in a triangle's
/// plane meet it or not by how they happen to round, so the picture would be speckled with it. The eye gets
/// as far from their planes as rays that leave them start (surface_offset_bound), on the side where it was as
/// far as its rounding tells, else on the one to which it looks; on floors that the view runs along, above
/// them. A camera that moves stays, as does one that is nowhere on a triangle. Of the scene's own triangles,
/// not those of instances.
void clear_eye(Scene& scene, NoticeList& notices);

} // namespace clrt
