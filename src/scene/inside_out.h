// SPDX-License-Identifier: Apache-2.0
// Glass whose inside is outside.
#pragma once

#include "scene/notices.h"
#include "scene/scene.h"

namespace clrt {

/// Notes closed surfaces of glass whose fronts are inside: they are bubbles of air in endless glass. One that
/// lies in the box of other closed glass is a bubble indeed, and not noted. By object and material, once for
/// each material. Of a mesh that instances share, the first instance stands for all; a mirrored one has its
/// fronts where its mesh has them. To be called when the instances are placed (place_instances.h).
void note_inside_out_glass(const Scene& scene, NoticeList& notices);

} // namespace clrt
