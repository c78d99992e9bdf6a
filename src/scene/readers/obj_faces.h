// SPDX-License-Identifier: Apache-2.0
// The faces of parsed pieces -> triangles with indices into the mesh.
#pragma once

#include "scene/readers/obj_pieces.h"

#include <string>
#include <vector>

namespace clrt {

/// Turns the indices of all faces into indices of the mesh, whose elements are joined; faces with a
/// non-finite position lose their corners. Throws SceneError for a position index that is out of range.
void resolve_faces(const std::string& path, ObjPieces& pieces, const ObjMesh& mesh);

/// Gives each piece its place in the mesh's triangles. Throws SceneError where there are none.
void place_triangles(const std::string& path, ObjPieces& pieces, ObjMesh& mesh);

/// Writes all triangles to their places, and the mesh's smoothing groups where faces have any;
/// `smoothing_names` are those of s statements by number.
void triangulate_faces(ObjPieces& pieces, const std::vector<std::string>& smoothing_names, ObjMesh& mesh);

} // namespace clrt
