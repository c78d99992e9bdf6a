// SPDX-License-Identifier: Apache-2.0
// Colours of vertices (`v x y z r g b`, as MeshLab, Blender and scanners write them). They are sRGB, as in
// Blender and three.js, and stand for the map_Kd of materials that have none: they multiply Kd, which is 1
// where it is not given.
#pragma once

#include "scene/notices.h"
#include "scene/readers/mtl_reader.h"
#include "scene/readers/obj_reader.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// Makes the mesh's colours linear; vertices without one become white. Whole numbers from 0 to 255 are bytes.
/// Numbers that are no colours (negative, infinite, larger than 255) take all colours with them, with a
/// notice.
void decode_vertex_colours(ObjMesh& mesh, const std::string& obj_path, NoticeList& notices);

/// For each material, whether a triangle with it has a coloured vertex. To be called before the colours are
/// decoded; empty if the mesh has none.
std::vector<bool> coloured_materials(const ObjMesh& mesh);

/// The material with the colours of the vertices as its map_Kd; unchanged, with a notice, if it has another.
MtlMaterial with_vertex_colours(MtlMaterial material, const SourcePlace& first_colour, NoticeList& notices);

/// Puts the colours where the kernels read them: behind the texels. Wants the final positions.
void store_vertex_colours(Scene& scene, const std::string& obj_path);

} // namespace clrt
