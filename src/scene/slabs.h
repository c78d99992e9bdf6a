// SPDX-License-Identifier: Apache-2.0
// Glass that connections cross to light from outside (kernels/path/slab.h) and to lamps (slab_bend.h).
#pragma once

#include "scene/scene.h"

namespace clrt {

/// Marks the materials whose facets make plane-parallel slabs (MATERIAL_SLAB), such as panes that have a
/// thickness: smooth glass and nothing else, on flat triangles of few directions, most of whose area faces
/// another part of it back to back. Other materials lose the mark.
void mark_slabs(Scene& scene);

/// Whether some of the lights are suns.
bool has_suns(const Scene& scene);

/// Whether connections to light at infinity are to look for slabs: there are some, and such light, and no
/// solids lie within each other, which only the whole path before can tell apart.
bool has_slabs_before_the_sky(const Scene& scene);

/// The same of connections to lamps (kernels/path/slab_bend.h), whose emission depends on no direction.
bool has_slabs_before_lamps(const Scene& scene);

} // namespace clrt
