// SPDX-License-Identifier: Apache-2.0
// A file's geometry -> the scene's arrays in the normalised frame.
#pragma once

#include "scene/mesh.h"
#include "scene/normalise.h"
#include "scene/notices.h"
#include "scene/scene.h"

namespace clrt {

/// The box around the corners of all triangles, wherever they move, in world units; a point at 0 if there are
/// none.
Bounds bounds_of_triangles(const Mesh& mesh);

/// Fills positions, normals, uvs, triangles (in the file's order) and extent; `bounds` is the box of its
/// triangles. A triangle keeps its normals only if all three are there, finite and not zero, its uvs only if
/// all three are there and finite; what is dropped is counted in a notice, as are triangles of zero area,
/// which stay in the array. The mesh's arrays are released on the way.
void assemble_geometry(Mesh& mesh, const Bounds& bounds, const Normalisation& frame, const std::string& path,
                       Scene& scene, NoticeList& notices);

} // namespace clrt
