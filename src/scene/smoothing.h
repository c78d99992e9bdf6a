// SPDX-License-Identifier: Apache-2.0
// Smoothing groups (`s` statements) of faces without vn -> corner normals.
#pragma once

#include "scene/notices.h"
#include "scene/readers/obj_reader.h"

#include <string>

namespace clrt {

/// Gives each triangle that has a smoothing group and no vn normals at its corners: at a vertex, the normals
/// of all such triangles of the group, each weighted by its angle there, summed (Thuermer and Wuethrich 1998,
/// "Computing vertex normals from polygonal facets"); so the cut of polygons into triangles does not matter.
/// A triangle stays flat where the sum cancels, or where all three normals are its own. ObjMesh::smoothing is
/// released.
void smooth_by_groups(ObjMesh& mesh, const std::string& obj_path, NoticeList& notices);

} // namespace clrt
