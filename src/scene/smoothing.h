// SPDX-License-Identifier: Apache-2.0
// Smoothing groups of faces without normals -> corner normals.
#pragma once

#include "scene/mesh.h"
#include "scene/notices.h"

#include <string>

namespace clrt {

/// Gives each triangle that has a smoothing group and no normals, normals at its corners: at a vertex, the
/// normals of all such triangles of the group, each weighted by its angle there, summed (Thuermer and
/// Wuethrich 1998, "Computing vertex normals from polygonal facets"); so the cut of polygons into triangles
/// does not matter. A triangle stays flat where the sum cancels, or where all three normals are its own.
/// Mesh::smoothing is released.
void smooth_by_groups(Mesh& mesh, const std::string& path, NoticeList& notices);

} // namespace clrt
